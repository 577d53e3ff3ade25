"""Values that no argument of the Python interface means, or only some do."""

from __future__ import annotations

import random
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np


class Strange:
    """An object whose repr fails, as half-made objects have it."""

    def __repr__(self) -> str:
        raise RuntimeError("no repr")


def endless():
    """An iterable without an end."""
    while True:
        yield "O4.theta"


SINGLE: list[Any] = [
    None,
    True,
    False,
    0,
    1,
    -1,
    3,
    7,
    -(10**30),
    10**400,
    0.0,
    2.5,
    float("nan"),
    float("inf"),
    -float("inf"),
    1e308,
    1j,
    Decimal("NaN"),
    Decimal("0.5"),
    Fraction(1, 3),
    "",
    " ",
    "nothing",
    "O1.theta",
    "O4.theta ",
    "O1.thetta",
    "O4",
    "A",
    "a",
    "Z",
    "ground",
    "time",
    "row.status",
    "row.mode",
    "row.nothing",
    "O3.force",
    "O3.force.x",
    "O3.force.w",
    "O4.theta +",
    "O4.theta + O2.s",
    "(" * 5000,
    "-" * 20000 + "1",
    "1/0",
    "sqrt(-1)",
    "1e999",
    "nan",
    "\0",
    "\ud800",
    "é\u202e",
    "x" * 100000,
    "../..",
    "0.5 parsec",
    "0.5 rad",
    b"O4.theta",
    b"\xff",
    Path("nowhere.yaml"),
    Path("."),
    Path("\0"),
    np.float64("nan"),
    np.int64(2),
    np.zeros(3),
    np.array("O4.theta"),
    np.array(2.0),
    np.array(["O4.theta", "nothing"]),
    np.zeros((0,)),
    object(),
    Strange(),
    len,
    int,
    ...,
    slice(None),
    slice(0, 3),
]


def bad_value(chance: random.Random, depth: int = 0) -> Any:
    """A value out of `SINGLE`, or a container of such."""
    kind = chance.randrange(9) if depth < 2 else 0
    if kind < 5:
        return chance.choice(SINGLE)
    inner = [bad_value(chance, depth + 1) for _ in range(chance.randrange(4))]
    if kind == 5:
        return inner
    if kind == 6:
        return tuple(inner)
    if kind == 7:
        return iter(inner)
    keys = ["P1", "P9", "O1.theta", "O4.theta", "", 3, None, "alpha1", ("P1",), "\ud800"]
    return {chance.choice(keys): value for value in inner}


def shown(value: Any) -> str:
    """The value in the message of a test that fails."""
    try:
        return repr(value)[:200]
    except Exception:
        return f"<{type(value).__name__}>"
