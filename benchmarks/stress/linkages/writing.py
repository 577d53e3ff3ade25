"""Texts of mechanism files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

import numpy as np

from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.quantity import Rows

RATE = 1.0
ACCELERATION = 0.25
"""Of the input, rad/s or m/s and their rates."""


def number(value: float) -> str:
    """The shortest text that is read as the same double."""
    return repr(float(value))


def decimals(values: Rows) -> DoubleDouble:
    """The numbers that a file says where it has the texts of doubles."""
    low = [float(Fraction(repr(x)) - Fraction(x)) for x in values.ravel().tolist()]
    return DoubleDouble(values, np.array(low).reshape(values.shape))


def place(values: Iterable[float]) -> str:
    """A vector in flow style."""
    return "[" + ", ".join(number(v) for v in values) + "]"


def joint(kind: str, links: Sequence[str], *, point: Iterable[float], axis: object = None) -> str:
    """One joint in flow style; `axis` is a vector, or text that follows the point."""
    more = "" if axis is None else axis if isinstance(axis, str) else f", axis: {place(axis)}"  # type: ignore[arg-type]
    return f"{{type: {kind}, links: [{', '.join(links)}], point: {place(point)}{more}}}"


def document(
    name: str, links: Iterable[str] | Mapping[str, str], joints: Mapping[str, str], *sections: str
) -> str:
    """A whole file in m, degrees, kg and N; links have no mass where their texts are not given."""
    texts = links if isinstance(links, Mapping) else dict.fromkeys(links, "{}")
    lines = [
        "format: 1",
        f"name: {name}",
        "units: {length: m, angle: deg, mass: kg, force: N}",
        "links: {" + ", ".join(f"{link}: {text}" for link, text in texts.items()) + "}",
        "joints:",
        *(f"  {key}: {text}" for key, text in joints.items()),
        *sections,
    ]
    return "\n".join(lines) + "\n"


def swept(coordinate: str, values: Rows) -> str:
    """The motion through listed values of one input, at the rates of all families."""
    listed = ", ".join(number(v) for v in values)
    law = f"values: [{listed}], rate: {number(RATE)}, acceleration: {number(ACCELERATION)}"
    return f"motion: {{inputs: {{{coordinate}: {{{law}}}}}}}"
