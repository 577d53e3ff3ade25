"""Hand-written results of a small analysis, in inches and degrees."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import pytest

from mechkin_cli.expressions.expression import parse
from mechkin_cli.expressions.quantity import Quantity, UnknownName, Vector
from mechkin_cli.tables.layout import ColumnLayout, TableLayout
from mechkin_cli.units.dimension import ANGLE, FORCE, LENGTH
from mechkin_cli.units.units import UnitSystem
from mechkin_cli.verdict import Status

INCH = 0.0254
NAN = float("nan")


@dataclass
class HandWritten:
    """Four rows; the last one lies beyond the dead centre."""

    units: UnitSystem
    quantities: Mapping[str, Quantity]
    rows: int = 4
    mode: str = "A"
    letter: str = "A"
    coordinates: tuple[str, ...] = ("O1.theta", "O2.s")
    inputs: dict = field(default_factory=lambda: {"O1.theta": np.array([190.0, 191, 192, 193])})
    input_rates: dict = field(default_factory=dict)
    status: np.ndarray = field(default_factory=lambda: np.array([0, 0, 1, 2], dtype=np.int8))
    residual: np.ndarray = field(default_factory=lambda: np.array([0.0, 1e-16, 2e-16, NAN]))
    condition: np.ndarray = field(default_factory=lambda: np.array([2.0, 2.5, 1e7, NAN]))
    power_error: np.ndarray = field(default_factory=lambda: np.array([NAN, NAN, NAN, NAN]))
    alternatives: tuple = ()
    is_certified: bool = False
    disturbed: tuple = ()
    length: float = 8.0 * INCH

    def quantity(self, name: str) -> Quantity:
        if name not in self.quantities:
            raise UnknownName(name, self.quantities)
        return self.quantities[name]


def quantities() -> dict[str, Quantity]:
    slide = np.array([1.0, 2.0, -4.0, 99.0]) * INCH
    zero = np.zeros(4)
    return {
        # not the input values: a column that is an input must not come from here
        "O1.theta": Quantity(np.array([1.0, 2.0, 3.0, 4.0]), ANGLE),
        "O2.s": Quantity(slide, LENGTH),
        "O2.force": Quantity(Vector(np.array([3.0, 0.0, 6.0, 1.0]), zero, zero), FORCE),
        "P1": Quantity(0.5 * INCH, LENGTH),
    }


@pytest.fixture
def source() -> HandWritten:
    units = UnitSystem.from_mapping({"length": "in", "angle": "deg"})
    return HandWritten(units, quantities())


@pytest.fixture
def layout() -> Callable[..., TableLayout]:
    """A table layout from label -> expression text, or (expression text, decimals)."""

    def make(columns: Mapping[str, str | tuple[str, int]], title: str = "") -> TableLayout:
        made = []
        for label, column in columns.items():
            text, decimals = (column, None) if isinstance(column, str) else column
            made.append(ColumnLayout(label, parse(text), decimals))
        return TableLayout("table", title, tuple(made))

    return make


@pytest.fixture
def all_ok(source: HandWritten) -> HandWritten:
    source.status = np.full(4, Status.ok, dtype=np.int8)
    return source
