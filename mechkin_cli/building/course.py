"""The course of the inputs between the rows, recorded from their laws and ties.

The parameter is the time where there is one, else the one input that the others follow, else the
number of the row. Laws and expressions are written down on a tape as they stand in the file; where
they bend, jump or rest is found on that tape (`solver.cells`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.building.coordinates import dimension_of
from mechkin_cli.building.fields import Fields
from mechkin_cli.building.law_pieces import LawPieces, law_pieces
from mechkin_cli.expressions import Expression, Quantity
from mechkin_cli.expressions.fields import scalar
from mechkin_cli.mechanism.course import Course, Parameter
from mechkin_cli.mechanism.motion import DrivenInput, Moments
from mechkin_cli.schema.motion import (
    FollowingInput,
    HeldInput,
    ListedInput,
    SweptInput,
)
from mechkin_cli.schema.responses import HeldCoordinate
from mechkin_cli.solver.cells import Formula, cells_of
from mechkin_cli.solver.places import places_of
from mechkin_cli.tape.recorder import Recorder
from mechkin_cli.tape.rows import is_traced
from mechkin_cli.tape.tape import Tape
from mechkin_cli.tape.traced import Traced, TraceLost, register
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.building.motion import Written

_NO_LAWS = (SweptInput, ListedInput, HeldInput, FollowingInput, HeldCoordinate)


def build_course(
    fields: Fields,
    written: Written,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
) -> Course | None:
    """The course of inputs without errors; None where they only run straight from row to row.

    Args:
        fields: knows units and parameters.
        written: the inputs as written, and the moments of the rows.
        inputs: with their values in all rows, in the order of the file.
        expressions: of the inputs that follow, in an order in which they can be evaluated.

    Raises:
        TraceLost: the inputs depend on a parameter that is recorded.
    """
    rows = inputs[0].values.size if inputs else 0
    if rows < 2 or not (expressions or written.time is not None):
        return None
    if any(is_traced(item.values) for item in inputs):
        raise TraceLost("the course of inputs depends on a varied parameter")
    sources = _sources(fields, written, inputs, expressions)
    if sources is None:
        return None
    formula = _recorded(fields, inputs, expressions, sources)
    cells = cells_of(formula, sources.at)
    values = np.stack([item.values for item in inputs])
    return places_of(formula, cells, sources.parameter, sources.at, values)


class _Sources(NamedTuple):
    """The parameter, its values in the rows, and the inputs that are functions of it alone."""

    parameter: Parameter
    at: Floats
    pieces: Mapping[str, LawPieces]


def _sources(
    fields: Fields,
    written: Written,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
) -> _Sources | None:
    time, clock = written.time, written.clock
    if time is not None and clock is not None:
        laws = {
            name: law_pieces(fields, (*written.path, name), item, name.rpartition(".")[2], clock)
            for name, item in written.inputs.items()
            if not isinstance(item, _NO_LAWS)
        }
        return _Sources(Parameter("time", TIME), time.written, laws)
    moving = [i for i in inputs if i.name not in expressions and (i.written != i.written[0]).any()]
    if not moving or not any(
        (i.values != i.values[0]).any() for i in inputs if i.name in expressions
    ):
        return None
    if len(moving) == 1:
        name = moving[0].name
        itself = LawPieces([], lambda _: [], lambda value, _: value)
        dimension = dimension_of(moving[0].coordinate)
        return _Sources(Parameter(name, dimension), moving[0].written, {name: itself})
    numbers = np.arange(moving[0].written.size, dtype=np.float64)
    chords = {
        i.name: _chords(i.written, isinstance(written.inputs[i.name], SweptInput)) for i in moving
    }
    return _Sources(Parameter("row"), numbers, chords)


def _chords(written: Floats, even: bool) -> LawPieces:
    """Straight from row to row, in one piece where they are evenly spaced."""
    last = written.size - 1
    rise = np.full(last, (written[-1] - written[0]) / last) if even else np.diff(written)

    def constants(row: float) -> list[float]:
        k = int(min(max(row, 0.0), last - 1.0)) if not even else 0
        return [float(k), float(written[k]), float(rise[k])]

    edges = [] if even else list(map(float, range(1, last)))
    return LawPieces(edges, constants, lambda row, c: c[1] + (row - c[0]) * c[2])


def _recorded(
    fields: Fields,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    sources: _Sources,
) -> Formula:
    """The tape from the parameter and the constants of all pieces to the inputs in SI."""
    first = float(sources.at[0])
    counts = {name: len(pieces.constants(first)) for name, pieces in sources.pieces.items()}
    given = [first, *(c for pieces in sources.pieces.values() for c in pieces.constants(first))]
    recorder = Recorder([f"c{k}" for k in range(len(given))], given)
    registers = [Traced(recorder, number) for number in range(len(given))]
    known: dict[str, Quantity] = {}
    if sources.parameter.name == "time":
        moment: Any = registers[0]
        known["time"] = Quantity(fields.units.to_si(moment, TIME), TIME)
    used = 1
    for name, pieces in sources.pieces.items():
        dimension = dimension_of(name.rpartition(".")[2])
        written: Any = pieces.value(registers[0], registers[used : used + counts[name]])
        known[name] = Quantity(fields.units.to_si(written, dimension), dimension)
        used += counts[name]
    tape = _tape(fields, inputs, expressions, known, recorder)

    def constants(parameter: float) -> list[float]:
        return [c for pieces in sources.pieces.values() for c in pieces.constants(parameter)]

    edges = [edge for pieces in sources.pieces.values() for edge in pieces.edges]
    return Formula(tape, edges, constants)


def build_ties(
    fields: Fields,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    time: Moments | None,
) -> tuple[tuple[str, Tape], ...]:
    """Each input that others follow, and all inputs as a function of it in SI.

    The further inputs of a tape are those that follow none, in the order of the file, and the time
    where there is one.
    """
    own = [item for item in inputs if item.name not in expressions]
    values = [float(item.values[0]) for item in own]
    moment = [] if time is None else [float(time.values[0])]
    ties = []
    for leader in own:
        if leader.name not in _leaders(expressions):
            continue
        given = [float(leader.values[0]), *values, *moment]
        recorder = Recorder([f"c{k}" for k in range(len(given))], given)
        registers: list[Any] = [Traced(recorder, number) for number in range(len(given))]
        known = {
            item.name: Quantity(
                registers[0 if item is leader else k], dimension_of(item.coordinate)
            )
            for k, item in enumerate(own, start=1)
        }
        if time is not None:
            known["time"] = Quantity(registers[-1], TIME)
        ties.append((leader.name, _tape(fields, inputs, expressions, known, recorder)))
    return tuple(ties)


def _leaders(expressions: Mapping[str, Expression]) -> set[str]:
    return {name for expression in expressions.values() for name in expression.names}


def _tape(
    fields: Fields,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    known: dict[str, Quantity],
    recorder: Recorder,
) -> Tape:
    """The tape to all inputs in SI, from those `known`; evaluates the others."""
    for item in inputs:
        if item.name not in known and item.name not in expressions:
            known[item.name] = Quantity(float(item.values[0]), dimension_of(item.coordinate))
    for name, expression in expressions.items():
        dimension = dimension_of(name.rpartition(".")[2])
        value = scalar(expression, dimension, fields.units, _lookup(fields, known))
        known[name] = Quantity(value, dimension)
    outputs = [register(recorder, known[item.name].value) for item in inputs]
    return recorder.tape(outputs, guarded=False)


def _lookup(fields: Fields, known: Mapping[str, Quantity]) -> Callable[[str], Quantity]:
    def find(name: str) -> Quantity:
        return known[name] if name in known else fields.resolve(name)

    return find
