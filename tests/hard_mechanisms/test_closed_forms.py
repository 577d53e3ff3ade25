"""What the families say is true, against the oracle: the closure of their files as written, solved
at 60 digits from the drawing on, with the rates of its Taylor series."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import Any

import numpy as np
import pytest
from oracle import assemble, mp, newton_euler, read
from oracle.numerics import mpmath_context

from benchmarks.stress.block import drawn
from benchmarks.stress.draws import scaled
from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.linkages.writing import ACCELERATION, RATE
from benchmarks.stress.numbers.double_double import DoubleDouble

AGREED = 1e-22
"""In parts of the largest of its kind: the oracle's own Newton stops at 1e-48, double-double has 31
digits, of which accelerations lose some."""
CASES = [
    ("sizes", 0, 7.0),
    ("sizes", 1, -5.0),
    ("sizes", 2, 3.0),
    ("sizes", 3, 4.0),
    ("link ratios", 0, 1e-5),
    ("link ratios", 1, 1e-5),
    ("dead centres", 0, 3.0),
    ("change points", 1, 6.0),
    ("leads", 0, None),
    ("many turns", 0, -8.0),
    ("long sweeps", 0, 5.0),
    ("forces", 0, None),
    ("forces", 1, None),
    ("forces", 2, None),
    ("forces", 3, None),
    ("spatial loops", 0, None),
    ("spatial loops", 1, None),
]


def as_doubles(text: str) -> str:
    """A file whose numbers are doubles to the last digit, as the package reads them."""
    return re.sub(r"-?\d+\.\d+(e[-+]?\d+)?", lambda m: f"{Decimal(float(m[0])):f}", text)


def value(rows: DoubleDouble) -> Any:
    return mp.mpf(float(rows.high[0, 0])) + mp.mpf(float(rows.low[0, 0]))


@pytest.mark.parametrize(("name", "number", "degrees"), CASES)
def test_closed_forms_are_those_of_the_files(name: str, number: int, degrees: float | None) -> None:
    block = drawn(FAMILIES[name], 5, [number])
    # spindles turn as far as their leads ask for, others to a dead centre or as far as is clear
    place = float(block.places[0, 1]) * 1e-3 if degrees is None else degrees
    truth = block.truth(np.array([[place]]))
    assert truth.exists.all()
    mechanism = read(as_doubles(block.texts[0]))
    angle = mp.radians(mp.mpf(place))
    found = assemble(mechanism, {"A.theta": (angle, mp.mpf(RATE), mp.mpf(ACCELERATION))})
    size = float(truth.size[0, 0])
    for quantity in truth.quantities:
        scale = size if quantity.kind == "length" else 1.0
        for key, rows in zip(quantity.keys, quantity.levels, strict=True):
            right = found[key]
            largest = max(abs(right), scale)
            assert abs(value(rows) - right) <= AGREED * largest, key
    if truth.forces:
        reactions = newton_euler(mechanism, found)
        for force in truth.forces:
            joint = force.name.partition(".")[0]
            right = (
                reactions.effort["A.theta"]
                if force.component is None
                else reactions.force[joint][force.component]
            )
            largest = float(truth.heaviest[0, 0]) * (size if force.is_moment else 1.0)
            assert abs(value(force.value) - right) <= AGREED * largest, force.key


def test_a_platform_closes_where_the_oracle_does() -> None:
    """Its tool, its first head and their rates, beside the doubles that the legs are given."""
    block = drawn(FAMILIES["spatial loops"], 5, [2])
    place = float(block.places[0, 1]) * 1e-3
    truth = block.truth(np.array([[place]]))
    mechanism = read(as_doubles(block.texts[0]))
    written = re.findall(r"(L\d\.s): .*?rate: ([^,]*),", block.texts[0])
    strokes = {leg: float(rate) for leg, rate in written}
    assert len(strokes) == 6
    driven = {
        leg: (mp.mpf(stroke * place), mp.mpf(stroke) * RATE, mp.mpf(stroke) * ACCELERATION)
        for leg, stroke in strokes.items()
    }
    found = assemble(mechanism, driven)
    size = float(truth.size[0, 0])
    for quantity in truth.quantities:
        assert quantity.component is not None
        levels = found.point(quantity.name)
        for rows, level, key in zip(quantity.levels, levels, quantity.keys, strict=False):
            right = level[quantity.component]
            assert abs(value(rows) - right) <= AGREED * max(abs(right), size), key


def test_oscillators_are_exponentials_of_matrices() -> None:
    block = drawn(FAMILIES["stiff responses"], 5, [0])
    moment = 0.375
    truth = block.truth(np.array([[moment]]))
    masses, loads, starts = _written(as_doubles(block.texts[0]))
    for quantity, mass, (stiff, damp), start in zip(
        truth.quantities, masses, loads, starts, strict=True
    ):
        matrix = mpmath_context.matrix([[0, 1], [-stiff / mass, -damp / mass]])
        right = (mpmath_context.expm(matrix * moment) * mpmath_context.matrix([start, 0]))[0]
        assert abs(value(quantity.value) - mp.mpf(right)) <= 1e-25


def _written(text: str) -> tuple[list[Any], list[tuple[Any, Any]], list[Any]]:
    """Masses, stiffness with damping, and starts of a file."""
    import yaml

    data = yaml.load(text, Loader=yaml.BaseLoader)
    number = mpmath_context.mpf
    masses = [number(link["mass"]) for link in data["links"].values()]
    loads = data["loads"]
    springs = [number(load["stiffness"]) for load in loads if load["type"] == "spring"]
    dampers = [number(load["damping"]) for load in loads if load["type"] == "damper"]
    starts = [number(x) for x in data["responses"]["let_go"]["start"].values()]
    return masses, list(zip(springs, dampers, strict=True)), starts


@pytest.mark.parametrize("number", [1.5, -9.999999999998899e-05, 3e-7, 0.0])
def test_powers_of_ten_are_taken_of_the_decimals(number: float) -> None:
    assert scaled(number, 3) == float(Decimal(repr(number)) * 1000)
    assert scaled(number, 0) == number
