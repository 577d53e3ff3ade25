"""True errors of a mechanism written otherwise: the same true values, and errors that are what its
own cells are off by from those."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from idle_parts import CRANKS, Crank, with_idle_link, with_idle_loop
from mpmath import mp
from oracle import (
    beside_itself,
    document,
    in_other_units,
    moved,
    renamed,
    reordered,
    rotation_matrix,
    to_text,
)
from oracle.document import Document
from properties.answers import kind
from references import FILE_OF
from response.test_true_errors import true_values

import mechkin_cli as mk

NAMES = ("rcsr", "rssr", "sevenr", "slider_crank")

DIGITS = 50
KNOWN = 1e-28
"""What two repetitions may differ by in parts of the column's largest: a hundred times the worst of
these mechanisms."""

SAME = 1e-12
"""What a told error may be off by in parts of itself beside that: it is told as a double."""

SI = {
    "m": Fraction(1),
    "mm": Fraction(1, 1000),
    "in": Fraction(254, 10000),
    "N": Fraction(1),
    "lbm*in/s^2": Fraction(45359237, 10**8) * Fraction(254, 10000),
}


def written(name: str) -> Document:
    """The file without what it names of other files."""
    data = document(FILE_OF[name])
    for table in data["tables"]:
        table.pop("published", None)
    return {key: value for key, value in data.items() if key != "follow"}


def analysis(data: Document) -> mk.Analysis:
    return mk.loads(to_text(data)).analyze(errors=True)


@cache
def known(name: str) -> mk.Analysis:
    return analysis(written(name))


def scalars(r: mk.Analysis) -> list[str]:
    """Coordinates with their rates, and the efforts of the inputs."""
    places = [c + rate for c in r.result.coordinates for rate in ("", "_dot", "_ddot")]
    known = r.result.problem.quantities()
    return [n for n in (*places, *(f"{i}.effort" for i in r.result.inputs)) if n in known]


def unit(r: mk.Analysis, name: str) -> Any:
    """What 1 in the file is in SI."""
    its, words = kind(name), r.result.units
    if name.endswith((".theta", ".theta1", ".theta2")):
        return mp.pi / 180
    size = SI[str(words.length)] ** its.lengths
    if its.order is None:
        size *= SI[str(words.force)]
    return mp.mpf(size.numerator) / size.denominator


def check(found: mk.Analysis, name: str, true: list[Any]) -> None:
    """The true values once more, and the errors told of the cells that are there."""
    size = max((abs(x) for x in true), default=0)
    is_angle = name.endswith((".theta", ".theta1", ".theta2"))
    one = unit(found, name)
    again, told = true_values(found, name), found.errors[name]
    assert len(again) == len(told) == len(true)
    for cell, error, x, y in zip(found[name], told, true, again, strict=True):
        turns = 2 * mp.pi * mp.nint((y - x) / (2 * mp.pi)) if is_angle else 0
        assert abs(x + turns - y) <= KNOWN * size, name
        off = abs(mp.mpf(float(cell)) - (x + turns) / one)
        assert abs(mp.mpf(float(error)) - off) <= SAME * off + KNOWN * size / one, name


def state(r: mk.Analysis) -> list[tuple[Any, ...]]:
    """Which columns have errors, and how many of their cells have none."""
    return [(c.table, c.label, c.why, c.lost) for c in r.errors.columns]


def check_columns(found: mk.Analysis, alone: mk.Analysis, way: int = 1) -> None:
    """In the same units, two errors of a cell differ by no more than the cells do: not at all where
    no bit of these has changed."""
    for one, other in zip(found.errors.columns, alone.errors.columns, strict=True):
        if one.why:
            continue
        apart = np.abs(one.values - other.values[::way])
        off = np.abs(one.error - other.error[::way])
        known = np.isfinite(one.error)
        assert np.array_equal(known, np.isfinite(other.error[::way])), one.label
        allowed = apart + SAME * one.error + KNOWN * one.largest
        assert np.all(off[known] <= allowed[known]), one.label


def turned(data: Document) -> Document:
    shift = [mp.mpf(2), mp.mpf(-1), mp.mpf("0.5")]
    return moved(data, rotation_matrix(3, -1, 2, 1), shift)


def backwards(data: Document) -> Document:
    data = document(data)
    for values in data["motion"]["inputs"].values():
        values["from"], values["to"] = values["to"], values["from"]
    return data


def units(length: str) -> Callable[[Document], Document]:
    return lambda data: in_other_units(
        data, {"length": length, "angle": "deg", "mass": "kg", "force": "N"}
    )


OTHERWISE: dict[str, Callable[[Document], Document]] = {
    "turned": turned,
    "reordered": lambda data: reordered(data, seed=3),
    "in mm": units("mm"),
    "in inches": units("in"),
    "backwards": backwards,
}


def more(name: str, what: str) -> Document:
    data = written(name)
    if what == "beside itself":
        return beside_itself(data)
    return (with_idle_loop if what == "with an idle loop" else with_idle_link)(data, CRANKS[name])


@pytest.mark.parametrize("otherwise", OTHERWISE)
@pytest.mark.parametrize("name", NAMES)
def test_written_otherwise(name: str, otherwise: str) -> None:
    alone, found = known(name), analysis(OTHERWISE[otherwise](written(name)))
    assert state(found) == state(alone)
    way = -1 if otherwise == "backwards" else 1
    if otherwise in ("reordered", "backwards"):
        check_columns(found, alone, way)
    with mp.workdps(DIGITS):
        for quantity in scalars(alone):
            check(found, quantity, true_values(alone, quantity)[::way])


@pytest.mark.parametrize("what", ["beside itself", "with an idle loop", "with an idle link"])
@pytest.mark.parametrize("name", NAMES)
def test_with_more(name: str, what: str) -> None:
    alone, found = known(name), analysis(more(name, what))
    assert state(found) == state(alone)
    check_columns(found, alone)
    for mark in ("", "_again") if what == "beside itself" else ("",):
        with mp.workdps(DIGITS):
            for quantity in scalars(alone):
                joint, _, rest = quantity.partition(".")
                check(found, f"{joint}{mark}.{rest}", true_values(alone, quantity))


def with_other_names(data: Document, _: Crank) -> Document:
    old = (*data["links"], *data["joints"], *data.get("points", ()), *data.get("parameters", ()))
    return renamed(data, {name: f"z_{name}" for name in old})


@pytest.mark.parametrize("rewritten", [with_other_names, with_idle_link])
@pytest.mark.parametrize("name", NAMES)
def test_not_a_bit_changes(name: str, rewritten: Callable[[Document, Crank], Document]) -> None:
    alone, found = known(name), analysis(rewritten(written(name), CRANKS[name]))
    assert state(found) == state(alone)
    for one, other in zip(found.errors.columns, alone.errors.columns, strict=True):
        assert np.array_equal(one.error, other.error, equal_nan=True), one.label
        assert np.array_equal(one.digits, other.digits), one.label
