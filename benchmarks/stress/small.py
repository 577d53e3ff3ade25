"""The small set of hard mechanisms that `mechkin bench --stress` carries: one of each family.

The package has its true places as data, so that it needs neither closed forms nor double-double.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.stress.block import drawn
from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.family import Family
from benchmarks.stress.numbers.double_double import DEGREE, DoubleDouble
from benchmarks.stress.quantity import Quantity, Truth
from mechkin_cli.tables.json import json_text

SEED = 1
TRIED = 8
"""Mechanisms of a family of which the first whose rows are all decided is taken, or the most."""

MOST_PLACES = 6
"""Coordinates of a mechanism; of more, as of forty loops, the first and the last."""


def small_set() -> str:
    """The file of the set."""
    families = [family for family in FAMILIES.values() if not family.lengths]
    with np.errstate(all="ignore"):
        return json_text({"seed": SEED, "mechanisms": [_known(family) for family in families]})


def _known(family: Family) -> dict[str, Any]:
    number, truth = 0, _truth(family, 0)
    for k in range(1, TRIED):
        if truth.decided.all():
            break
        another = _truth(family, k)
        if another.decided.sum() > truth.decided.sum():
            number, truth = k, another
    quantities = truth.quantities
    if len(quantities) > MOST_PLACES:
        quantities = quantities[0], quantities[-1]
    return {
        "family": family.name,
        "number": number,
        "response": family.response,
        "size": float(truth.size[0, 0]),
        "exists": truth.exists[0].astype(int).tolist(),
        "decided": truth.decided[0].astype(int).tolist(),
        "places": [_place(quantity, truth.exists.shape) for quantity in quantities],
        "text": drawn(family, SEED, [number]).texts[0],
    }


def _truth(family: Family, number: int) -> Truth:
    block = drawn(family, SEED, [number])
    return block.truth(block.places)


def _place(quantity: Quantity, shape: tuple[int, ...]) -> dict[str, Any]:
    assert quantity.component is None
    other = quantity.other
    return {
        "name": quantity.name,
        "kind": quantity.kind,
        "value": _in_file_units(quantity, quantity.levels[0], shape),
        "other": None if other is None else _in_file_units(quantity, other, shape),
    }


def _in_file_units(
    quantity: Quantity, value: DoubleDouble, shape: tuple[int, ...]
) -> list[float | None]:
    """The first mechanism's rows in deg or m, rounded to doubles; None where there are none."""
    given = value if quantity.kind == "length" else value / DEGREE
    rows = np.broadcast_to(given.high, shape)[0].tolist()
    return [x if np.isfinite(x) else None for x in rows]
