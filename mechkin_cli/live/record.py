"""The record from which a page computes a sweep with other parameters.

Parameters that are numbers in the file vary; what they lead to in plan, tables, arrows and drawing
is recorded once. Not everything can be: what rests on several runs (coefficients, screws), on
reactions that redundant constraints leave open, or on a parameter by which the file is computed in
another way. That is listed with its reason.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.expressions import ExpressionError, Quantity, UnknownName, parse
from mechkin_cli.kernel.plan_text import tape_text
from mechkin_cli.live.cells import MEASURES, CellRecorder, scalar_of
from mechkin_cli.live.drawing import arrows_of, drawing_of, pose_records
from mechkin_cli.live.numbers import with_numbers
from mechkin_cli.mechanism import (
    BEARING_KINDS,
    DERIVED_KINDS,
    bearing_load,
    dimension_of,
    friction_states,
    is_angle,
    read_for,
)
from mechkin_cli.plan import REACTION_KINDS, Demand, demand_of
from mechkin_cli.reading import value_spans
from mechkin_cli.session import input_rest
from mechkin_cli.sweep import has_turns, limited, slack_quantities
from mechkin_cli.tables import ROW_TEXTS, Words, row_texts, table_sizes
from mechkin_cli.tape import Recorded, TraceLost, Verdict, is_traced, tape_values
from mechkin_cli.units import LENGTH, UnitSystem
from mechkin_cli.variants import VariedDesign, base_of
from mechkin_cli.verdict import (
    CLEAR_CONDITION,
    CONDITION_LIMITS,
    SWEEP,
    Status,
    has_forces,
)
from mechkin_cli.view import packed

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis, Design, Solvable
    from mechkin_cli.building import FileNumber
    from mechkin_cli.mechanism import Problem, Wanted
    from mechkin_cli.reading import Document, KeyPath
    from mechkin_cli.tables import ColumnLayout, Columns
    from mechkin_cli.variants import SessionVariation

    Plain = dict[str, Any]

REST = " within a turn"
"""Suffix of the names of angles without whole turns."""

MOST_LIVE_NUMBERS = 400_000
"""Rows by outputs of the kernel's run that a page computes at every change."""

MOST_PARAMETERS = 60
"""Parameters that a page has sliders for."""

OF_SIZE = 0.1
"""How far a slider moves a place to either side, in parts of the mechanism's size."""

NUMBERS = "Points, masses and springs"
"""What the numbers of a file without parameters are called."""


class LeftOut(Exception):
    """A quantity that a page does not compute; the message says why."""


def live_record(analysis: Analysis, data: Mapping[str, Any]) -> Plain | None:
    """What the page of a sweep computes by itself; None where it can compute nothing.

    Args:
        analysis: the sweep in the file's own mode, whose page it is.
        data: of the page without this record.
    """
    design = analysis.model.design
    if (
        analysis.run != SWEEP
        or isinstance(design, VariedDesign)
        or not analysis.result.solved.all()
    ):
        return None
    numbers = with_numbers(design, MOST_PARAMETERS)
    varied, fixed = _variation(design if numbers is None else numbers.design)
    if varied is not None and numbers is not None:
        varied = _changeable(numbers.design, varied)
    if varied is None:
        return None
    names = list(varied.recorder.inputs)
    try:
        recording = Recording(analysis, data, varied)
        record = recording.record()
    except (LeftOut, TraceLost, ValueError, TypeError):
        return None
    if record is None:
        return None
    file = analysis.model.built.document
    if numbers is None:
        paths: dict[str, KeyPath] = {name: ("parameters", name) for name in names}
        parameters = [_parameter(analysis.model, name, file.data) for name in names]
    else:
        chosen = {name: numbers.numbers[name] for name in names}
        paths = {one.name: one.path for one in chosen.values()}
        reach = OF_SIZE * data["size"]
        parameters = [
            _file_number(numbers.design.problem, name, one, reach) for name, one in chosen.items()
        ]
        fixed = {}
        record["left"] = [one | {"command": None} for one in record["left"]]
    return {
        "run": SWEEP,
        "parameters": parameters,
        "folded": None if numbers is None else NUMBERS,
        "fixed": [
            {
                "name": name,
                "why": why,
                "command": f"mechkin analyze {data['file']} --set {name}=...",
            }
            for name, why in fixed.items()
        ],
        **record,
        "file": None if file.is_data else {"text": file.text, "spans": _spans(file, paths)},
    }


def _parameter(model: Solvable, name: str, data: Mapping[str, Any]) -> Plain:
    problem = model.design.problem
    quantity, units = problem.parameters[name], problem.units
    value = float(units.from_si(float(quantity.value), quantity.dimension))  # type: ignore[arg-type]
    text = str(data.get("parameters", {}).get(name, ""))
    written = parse(text).number
    if written is not None and text.strip().removeprefix(written.text).strip() in (
        "",
        units.label(quantity.dimension),
    ):
        value = float(
            written.value
        )  # as it was written, without the rounding of a way to SI and back
    ends = model.view_settings.parameters.get(name, _about(value))
    return _slider(quantity, units, {"name": name, "value": value, "text": text}, ends)


def _file_number(problem: Problem, parameter: str, number: FileNumber, reach: float) -> Plain:
    """A number of the file; a place is moved by up to `reach`, in the file's unit."""
    value = number.value
    ends = (value - reach, value + reach) if number.is_place else _about(value)
    told = {"name": number.name, "value": value, "text": number.text}
    return _slider(problem.parameters[parameter], problem.units, told, ends)


def _about(value: float) -> tuple[float, float]:
    """From half to twice a value."""
    return (min(0.5 * value, 2.0 * value), max(0.5 * value, 2.0 * value)) if value else (-1.0, 1.0)


def _slider(quantity: Quantity, units: UnitSystem, told: Plain, ends: tuple[float, float]) -> Plain:
    conversion = units.conversion(quantity.dimension)
    return {
        **told,
        "unit": units.label(quantity.dimension),
        "low": ends[0],
        "high": ends[1],
        "si": float(quantity.value),  # type: ignore[arg-type]
        "factor": [float(conversion.multiplier), float(conversion.divisor)],
    }


def _spans(file: Document, paths: Mapping[str, KeyPath]) -> dict[str, list[int]]:
    """Where values stand in the file's text, characters from 0, their quotes among them."""
    spans = value_spans(file.text)
    return {
        name: [spans[path].start, spans[path].end]
        for name, path in paths.items()
        if path in spans and name not in file.overrides
    }


def _variation(design: Design) -> tuple[SessionVariation | None, dict[str, str]]:
    """How the design depends on all parameters that a recording holds, and why others are fixed."""
    problem, fixed = design.problem, {}
    document = design.built.document
    free: list[str] = []
    for name in problem.parameters:
        try:
            expression = parse(str(document.data["parameters"][name]))  # type: ignore[index, call-overload]
        except (ExpressionError, KeyError, TypeError):
            continue
        if expression.names:
            fixed[name] = f"follows from {', '.join(sorted(expression.names))}"
        elif len(free) == MOST_PARAMETERS:
            fixed[name] = f"the page has sliders for {MOST_PARAMETERS} parameters"
        else:
            free.append(name)
    base = base_of(design)
    held = _recordable(base, free)
    for name in free:
        if name not in held:
            fixed[name] = "with another value the file is computed in another way"
    return (base.variation(held) if held else None), fixed


def _changeable(design: Design, varied: SessionVariation) -> SessionVariation | None:
    """The recording of those parameters that may become a little larger or smaller by themselves:
    others, such as a place on a line about which a rod spins, make the file another."""
    own = varied.values
    largest = np.abs(own).max()
    step = np.diag(tolerances.TRIED_DIMENSION * np.where(own == 0.0, largest, np.abs(own)))
    verdicts = varied.verdicts(np.hstack([own[:, None] + step, own[:, None] - step]))
    other = (verdicts == Verdict.OTHER_WAY).reshape(2, own.size).all(axis=0)
    names = [name for name, no in zip(varied.recorder.inputs, other, strict=True) if not no]
    return base_of(design).variation(names) if names else None


def _recordable(base: Any, names: Sequence[str]) -> list[str]:
    if not names:
        return []
    if base.variation(tuple(names)) is not None:
        return list(names)
    if len(names) == 1:
        return []
    half = len(names) // 2
    held = [*_recordable(base, names[:half]), *_recordable(base, names[half:])]
    return held if len(held) == len(names) or base.variation(tuple(held)) is not None else held[:1]


class Recording:
    """Everything that is recorded of one sweep for its page."""

    def __init__(
        self, analysis: Analysis, data: Mapping[str, Any], variation: SessionVariation
    ) -> None:
        self.analysis, self.data, self.variation = analysis, data, variation
        self.problem: Problem = variation.base.problem
        self.known = self.problem.quantities()
        self.recorded = variation.recorded
        self.numbers: list[Any] = []
        self._places: dict[int, int] = {}
        self.given: list[Plain] = []
        self._given: dict[str, int] = {}
        self.recorder = CellRecorder(self.number)
        self.outputs: list[int] = []
        self.left: list[Plain] = []
        self.wanted: dict[str, Wanted] = {}
        self.power = Demand.POSITION

    # Numbers that hang on parameters alone, and columns that are given.

    def number(self, value: Any) -> int:
        """The place of a number that is the same in all rows."""
        if id(value) not in self._places:
            self._places[id(value)] = len(self.numbers)
            self.numbers.append(value)
        return self._places[id(value)]

    def column(self, name: str, values: Any) -> int:
        """The place of a column that does not come from the kernel."""
        if name not in self._given:
            self._given[name] = len(self.given)
            if is_traced(values):
                first = len(self.numbers)
                self.numbers += list(values)
                self.given.append({"first": first})
            else:
                self.given.append({"values": packed("f64", values)})
        return self._given[name]

    def _inputs(self) -> Iterator[tuple[str, Any, Any]]:
        """Time, inputs and their rates: names, SI, as written."""
        motion = self.recorded.motion
        if motion.time is not None:
            yield "time", motion.time.values, motion.time.written
        for driven in motion.inputs:
            for name, (in_si, written) in driven.orders.items():
                yield name, in_si, written

    @cached_property
    def prescribed(self) -> dict[str, tuple[Any, Any]]:
        """The same by name."""
        return {name: (in_si, written) for name, in_si, written in self._inputs()}

    # What columns read.

    def refusal(self, wanted: Wanted) -> str | None:
        """Why a quantity is not computed in a page; None where it is."""
        problem, session = self.problem, self.variation.base
        forces = demand_of(problem.mechanism, [wanted]) & Demand.FORCES
        if wanted.kind in DERIVED_KINDS and wanted.kind not in BEARING_KINDS:
            return "it is found by more than one run"
        if wanted.kind == "error_bound":
            return "it is proven in intervals"
        if session.is_redundant and wanted.kind in REACTION_KINDS:
            return "redundant constraints may leave it open"
        frictions = problem.mechanism.frictions
        if forces and (
            problem.stopped or (frictions and (session.is_redundant or problem.has_idle))
        ):
            return "its forces are judged beside the run"
        if forces and problem.motion.constraints:
            return "its forces go by the rates of inputs that others lead"
        return None

    def need(self, names: Sequence[str]) -> None:
        """Quantities that the kernel's run writes.

        Raises:
            LeftOut: it cannot write one of them.
        """
        found = {}
        for name in read_for([n for n in names if n in self.known], self.known):
            wanted = self.known[name]
            if name in MEASURES or name in self.prescribed or wanted.owner == "row":
                if name not in MEASURES and name not in self.prescribed:
                    raise LeftOut("it is a verdict")
                if name != "row.power_error":
                    continue
            why = self.refusal(wanted)
            if why is not None:
                raise LeftOut(why)
            if name == "row.power_error":
                self.power = demand_of(self.problem.mechanism, [wanted])
                continue
            found[name] = wanted
            if has_turns(wanted):
                found[name + REST] = wanted._replace(name=name + REST)
        self.wanted |= found

    def read_by(self, layout: ColumnLayout) -> list[str]:
        """The quantities that a column reads, without components."""
        names = []
        for name in sorted(layout.expression.names):
            whole = name if name in self.known else name.rpartition(".")[0]
            if whole in self.known:
                names.append(whole)
        return names

    def resolve(self, name: str) -> Quantity:
        """A quantity by its name, on the tape of cells."""
        if name in self.recorded.parameters:
            return self.recorded.parameters[name]
        if name in MEASURES:
            at = MEASURES.index(name)
            return Quantity(self.recorder.of("measure", at), self.known[name].dimension)
        if name not in self.known:
            raise UnknownName(name, list(self.known), self.problem.why_not(name))
        wanted = self.known[name]
        if wanted.kind in BEARING_KINDS:
            return bearing_load(wanted, self.resolve)
        if name in self.prescribed:
            value = self.recorder.of("given", self.column(name, self.prescribed[name][0]))
            rest = input_rest(self.variation.base, name)
            within = None
            if rest is not None and not self.variation.moving_inputs:
                within = self.recorder.of("given", self.column(name + REST, rest))
            return Quantity(value, wanted.dimension, within)
        slot = self.reading.slots[name]
        numbers = [self.recorder.of("slot", at) for at in range(slot.start, slot.stop)]
        if wanted.vector:
            return Quantity(wanted.value(numbers), wanted.dimension)
        place = self.reading.slots.get(name + REST)
        within = None if place is None else self.recorder.of("slot", place.start)
        return Quantity(numbers[0], wanted.dimension, within)

    def cell(self, value: Any) -> int:
        """The place of a cell among the outputs of the tape."""
        self.outputs.append(self.recorder.lifted(value))
        return len(self.outputs) - 1

    # Tables.

    def _columns(self) -> Iterator[tuple[Columns, ColumnLayout, int]]:
        for table, layout in zip(self.analysis.tables, self.analysis.layouts, strict=True):
            for at, column in enumerate(layout.columns):
                yield table, column, at

    def _leave(self, table: str, layout: ColumnLayout, why: str) -> None:
        self.left.append({"table": table, "label": layout.label, "why": why})

    def _needs(self) -> None:
        for table, layout, _ in self._columns():
            if layout.expression.text.strip() in row_texts(SWEEP):
                continue
            try:
                self.need(self.read_by(layout))
            except LeftOut as why:
                self._leave(table.name, layout, str(why))
        for wanted in limited(self.problem):
            self.need([wanted.name])

    def _table_records(self) -> list[Plain]:
        result = self.analysis.result
        left = {(one["table"], one["label"]) for one in self.left}
        found = []
        for table, layout in zip(self.analysis.tables, self.analysis.layouts, strict=True):
            columns = []
            for column, evaluated in zip(layout.columns, table.columns, strict=True):
                record = None
                if (table.name, column.label) not in left:
                    record = self._column_record(table.name, column)
                if record is not None:
                    text = column.expression.text.strip()
                    measured = any(n.startswith("row.") for n in column.expression.names)
                    record["label"], record["unit"] = column.label, evaluated.unit
                    record["decimals"] = column.decimals
                    record["rounded"] = text not in result.inputs and not (
                        measured and evaluated.unit == ""
                    )
                columns.append(record)
            found.append(
                {"name": table.name, "columns": columns, "sizes": self._left_sizes(table, columns)}
            )
        return found

    def _left_sizes(self, table: Columns, columns: Sequence[Plain | None]) -> dict[str, float]:
        """By unit, the largest numbers of columns that the page does not compute: as the file has
        them, they tell how large rounding is for others."""
        sizes: dict[str, float] = {}
        for record, column in zip(columns, table.columns, strict=True):
            if record is None and not isinstance(column.values, Words) and column.unit:
                finite = np.isfinite(column.values)
                largest = float(np.abs(column.values).max(initial=0.0, where=finite))
                sizes[column.unit] = max(largest, sizes.get(column.unit, 0.0))
        return sizes

    def _column_record(self, table: str, layout: ColumnLayout) -> Plain | None:
        text = layout.expression.text.strip()
        if text in ROW_TEXTS:
            return {"words": text}
        if text in row_texts(SWEEP):
            return None
        if text in self.prescribed:
            return {"given": self.column(f"{text} as written", self.prescribed[text][1])}
        try:
            quantity = layout.expression.evaluate(self.resolve)
            value = self.problem.units.from_si(scalar_of(quantity), quantity.dimension)
            return {"cell": self.cell(value)}
        except (LeftOut, TraceLost, TypeError, ValueError, ZeroDivisionError) as why:
            self._leave(table, layout, str(why))
        except ExpressionError as why:
            self._leave(table, layout, why.message)
        return None

    def _verdict(self) -> Plain:
        slots = self.reading.slots
        frictions = [q.name for q in friction_states(self.problem.mechanism)]
        strands = [q.name for q in slack_quantities(self.problem)]
        limits = []
        length = self.variation.layout.length
        recorded = {limit.name: limit for limit in self.recorded.limits}
        for wanted in limited(self.problem):
            limit = recorded[wanted.name]
            value = scalar_of(self.resolve(wanted.name))
            ends = [
                None if not isinstance(end, Recorded) and not isfinite(end) else self.number(end)
                for end in (limit.low, limit.high)
            ]
            slack = tolerances.AT_LIMIT * (1.0 if is_angle(limit.coordinate) else length)
            limits.append({"cell": self.cell(value), "ends": ends, "slack": slack})
        return {
            "words": [status.label for status in Status],
            "condition": [[float(limit), int(code)] for code, limit in CONDITION_LIMITS.items()],
            "clear": CLEAR_CONDITION,
            "friction": [slots[name].start for name in frictions if name in slots],
            "undecided": int(Status.friction_undecided),
            "strands": [slots[name].start for name in strands if name in slots],
            "slack": [float(tolerances.UNIQUE_CELL), int(Status.slack)],
            "limits": limits,
            "beyond": int(Status.beyond_limit),
            "forces": [bool(each) for each in has_forces(np.arange(len(Status), dtype=np.int8))],
            "loops": bool(self.variation.base.graph.blocks),
        }

    def record(self) -> Plain | None:
        """The record, without what is said of parameters and file."""
        problem, variation = self.problem, self.variation
        if problem.mechanism.has_arcs or not self._is_base():
            return None
        self._needs()
        # arrows ask for forces that the command does not compute: no power error is told by them
        asked = demand_of(problem.mechanism, self.wanted.values()) | self.power
        has_power = bool(asked & Demand.FORCES and asked & Demand.VELOCITY)
        poses = pose_records(self, self.data)
        arrows = arrows_of(self, self.data)
        demand = demand_of(problem.mechanism, self.wanted.values()) | self.power
        if demand & Demand.FORCES:
            beside = (*friction_states(problem.mechanism), *slack_quantities(problem))
            self.wanted |= {q.name: q for q in beside}
            demand |= demand_of(problem.mechanism, self.wanted.values())
        if variation.base.graph.blocks:
            demand |= Demand.CONDITION
        if demand & Demand.FORCES and demand & Demand.VELOCITY:
            demand |= Demand.POWER
        self.demand = demand
        self.reading = variation.reading(self.wanted.values())
        width = sum(slot.stop - slot.start for slot in self.reading.slots.values())
        if width * problem.motion.rows > MOST_LIVE_NUMBERS:
            return None
        plan = self.reading.text(demand)
        tables = self._table_records()
        if not any(column for table in tables for column in table["columns"]):
            return None
        verdict = self._verdict() | {"power": has_power}
        arrow_records = arrows()
        pose_data = poses()
        axis = self.data["runs"][0]["x"]["label"]
        at = None
        if axis in self.prescribed:
            at = self.column(f"{axis} as written", self.prescribed[axis][1])
        inputs = [
            {"name": driven.name, "unit": problem.units.label(dimension_of(driven.coordinate))}
            | self._unit(dimension_of(driven.coordinate), driven.joint, driven.coordinate)
            for driven in problem.motion.inputs
        ]
        row_inputs = [
            [name, self.column(f"{name} as written", self.prescribed[name][1])]
            for name in self.analysis.result.inputs
        ]
        tape, sources = self.recorder.program(self.outputs)
        drawing = drawing_of(self, self.data)
        numbers = variation.recorded_tape(self.numbers or [0.0])
        length = problem.units.conversion(LENGTH)
        return {
            "plan": plan,
            "cells": tape_text(tape_values(tape)),
            "sources": [[source.kind, source.at] for source in sources],
            "numbers": tape_text(tape_values(numbers)),
            "given": self.given,
            "rows": problem.motion.rows,
            "axis": at,
            "tables": tables,
            "row_inputs": row_inputs,
            "sizes": table_sizes(self.analysis.result),
            "zero": float(tolerances.ZERO_CELL),
            "verdict": verdict,
            "arrows": arrow_records,
            "poses": pose_data,
            "length": [float(length.multiplier), float(length.divisor)],
            "drawing": drawing,
            "inputs": inputs,
            "left": [one | {"command": self._command()} for one in self.left],
            **self._shown(),
        }

    def _unit(self, dimension: Any, joint: str, coordinate: str) -> Plain:
        own = self.problem.mechanism.joints[joint]
        unit = own.unit_of(coordinate, self.variation.layout.length)
        return {"kernel": float(self.problem.units.from_si(float(unit), dimension))}

    def _command(self) -> str:
        return f"mechkin analyze {self.data['file']} --set NAME=VALUE"

    def _shown(self) -> Plain:
        """Which rows the page shows, and which of them have a pose, as in its data."""
        branch = self.data["runs"][0]["branches"][0]
        return {"all_rows": branch["rows"] == self.problem.motion.rows}

    def _is_base(self) -> bool:
        """Whether the rows that are shown are those of the base that was recorded."""
        rows = self.analysis.result.row_states
        own = rows.states[:, self.variation.row]
        return own.shape == self.variation.state.shape and bool(
            np.abs(own - self.variation.state).max(initial=0.0) <= tolerances.SAME_MODE
        )
