"""What is recorded of a run for its page: the plan with the tape of its constants, programs of
cells, and what arrows and drawing follow from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import HOME, NEAR
from mechkin_cli.expressions import ExpressionError, Quantity, UnknownName
from mechkin_cli.kernel.plan_text import record_lines, tape_text
from mechkin_cli.live.cables import cable_coordinates, cable_verdicts
from mechkin_cli.live.cells import MEASURES, CellRecorder, scalar_of
from mechkin_cli.live.drawing import arrows_of, drawing_of, pose_records
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
from mechkin_cli.search import has_one_assembly
from mechkin_cli.session import input_rest
from mechkin_cli.sweep import first_assembly, has_turns, limited, slack_quantities
from mechkin_cli.tables import (
    ROW_EVENT,
    ROW_PROOF,
    ROW_TEXTS,
    Words,
    row_texts,
    size_kinds,
    size_of_rate,
)
from mechkin_cli.tape import Recorded, TraceLost, is_traced, tape_values
from mechkin_cli.units import LENGTH
from mechkin_cli.verdict import (
    CLEAR_CONDITION,
    CONDITION_LIMITS,
    SWEEP,
    Status,
    has_forces,
)
from mechkin_cli.view import Lengths, packed

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.mechanism import Problem, Wanted
    from mechkin_cli.show import Floats
    from mechkin_cli.structure import SolverGraph
    from mechkin_cli.tables import ColumnLayout, Columns
    from mechkin_cli.units import Conversion
    from mechkin_cli.variants import SessionVariation

    Plain = dict[str, Any]

REST = " within a turn"
"""Suffix of the names of angles without whole turns."""

MOST_LIVE_NUMBERS = 400_000
"""Rows by outputs of the kernel's run that a page computes at every change."""


def factor_of(conversion: Conversion) -> list[float]:
    """What numbers in the file's units are times, or over, in SI."""
    return [float(conversion.multiplier), float(conversion.divisor)]


NOT_UNIQUE = "redundant constraints may leave it open"
"""Why a reaction is not computed in a page; the powers of its row are, as the command has them."""

IN_INTERVALS = "it is proven in intervals"

ANY_LETTER = "only a search of all assembly modes tells the letter of one"
"""Why the letter of the mode is not written beside changed dimensions: others may come or go, or
change places with it."""


class LeftOut(Exception):
    """A quantity that a page does not compute; the message says why."""


class Recording:
    """Everything that is recorded of one sweep for its page."""

    measures: tuple[str, ...] = MEASURES

    def __init__(
        self, analysis: Analysis, data: Mapping[str, Any], variation: SessionVariation
    ) -> None:
        self.analysis, self.data, self.variation = analysis, data, variation
        self.shown = next(run for run in data["runs"] if run["name"] == analysis.run)
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
        self.judges_forces = False
        self.beside = Demand.POSITION  # of columns that are left out, and of the power error

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
            return IN_INTERVALS
        if session.is_redundant and wanted.kind in REACTION_KINDS:
            return NOT_UNIQUE
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
            if name in self.measures or name in self.prescribed or wanted.owner == "row":
                if name not in self.measures and name not in self.prescribed:
                    raise LeftOut("it is a verdict")
                if name != "row.power_error":
                    continue
            why = self.refusal(wanted)
            if why == NOT_UNIQUE:
                self.beside |= demand_of(self.problem.mechanism, [wanted])
            if why is not None:
                raise LeftOut(why)
            if name == "row.power_error":
                self.beside |= demand_of(self.problem.mechanism, [wanted])
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
        if name in self.measures:
            at = self.measures.index(name)
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

    @property
    def _rows_name(self) -> str:
        """The table of verdicts."""
        return "rows"

    @cached_property
    def _keeps_letter(self) -> bool:
        """Whether there is one assembly whatever the dimensions, and the file's run has its
        letter."""
        named = self.analysis.result.mode not in (HOME, NEAR)
        return named and has_one_assembly(self._first_graph)

    @property
    def _first_graph(self) -> SolverGraph:
        """The structure in which the first assembly is found."""
        return self.variation.base.graph

    def _columns(self) -> Iterator[tuple[Columns, ColumnLayout, int]]:
        for table, layout in zip(self.analysis.tables, self.analysis.layouts, strict=True):
            for at, column in enumerate(layout.columns):
                yield table, column, at

    def _leave(self, table: str, layout: ColumnLayout, why: str) -> None:
        self.left.append({"table": table, "label": layout.label, "why": why})

    def _needs(self) -> None:
        words = {} if self._keeps_letter else {"row.mode": ANY_LETTER}
        if self.analysis.run == SWEEP and self.analysis.result.is_certified:
            words[ROW_PROOF] = IN_INTERVALS
        for name, why in words.items():
            label = name.removeprefix("row.")
            self.left.append({"table": self._rows_name, "label": label, "why": why})
        for table, layout, _ in self._columns():
            text = layout.expression.text.strip()
            if text in words:
                self._leave(table.name, layout, words[text])
            if text in row_texts(self.analysis.run):
                continue
            try:
                self.need(self.read_by(layout))
            except LeftOut as why:
                self._leave(table.name, layout, str(why))
        for wanted in limited(self.problem):
            self.need([wanted.name])
        if self.analysis.run == SWEEP:
            self.wanted |= {q.name: q for q in cable_coordinates(self.problem.mechanism)}

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
        if text in (*ROW_TEXTS, ROW_EVENT):
            return {"words": text}
        if text in row_texts(self.analysis.run):
            return None
        if text in self.prescribed:
            given = self.column(f"{text} as written", self.prescribed[text][1])
            return {"given": given, "every_row": text in self.analysis.result.inputs}
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
        # forces are judged where the command computes some, not where arrows alone ask for them
        judged = [friction_states(self.problem.mechanism), slack_quantities(self.problem)]
        frictions, strands = ([q.name for q in one if self.judges_forces] for one in judged)
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
            "cables": cable_verdicts(self) if self.analysis.run == SWEEP else [],
            "slack": [float(tolerances.UNIQUE_CELL), int(Status.slack)],
            "limits": limits,
            "beyond": int(Status.beyond_limit),
            "forces": [bool(each) for each in has_forces(np.arange(len(Status), dtype=np.int8))],
            "loops": bool(self.variation.base.graph.blocks),
        }

    def why_left(self) -> str | None:
        """Why the page leaves the whole run to the command; None where it does not."""
        return None if self._is_base() else "its rows are not those of the file's own assembly"

    def _plan(self, demand: Demand) -> Plain:
        """The text of the plan, and what it ends with for the other modes that are shown."""
        return {
            "plan": self.reading.text(demand),
            "modes": {
                name: record_lines(self.reading.start_records(demand, first))
                for name, first in self._other_modes()
            },
        }

    def _other_modes(self) -> Iterator[tuple[str, tuple[Floats, int, float]]]:
        """The file's assemblies in the other modes, by their letters."""
        own = self.analysis.model.design.session
        for branch in self.shown["branches"][1:]:
            session, start = first_assembly(own.in_mode(branch["name"].removeprefix("mode ")))
            if start.state is not None and session.size is not None:
                yield branch["name"], (start.state, start.row, session.size)

    def _run_record(self) -> Plain:
        """What only a sweep has."""
        return {"sizes": self._sizes()}

    def _rates(self) -> Iterator[tuple[str, Plain]]:
        """The rates by which tables measure rounding: names, and columns where they stand."""
        for name in self.analysis.result.input_rates:
            yield name, {"given": self.column(f"{name} as written", self.prescribed[name][1])}

    def _sizes(self) -> Plain:
        """The sizes that tables measure rounding by, which go with the largest rate of an input."""
        result = self.analysis.result
        rates = []
        for name, column in self._rates():
            per = size_of_rate(self.known[name].dimension, result)
            if per is not None:
                rates.append(column | {"per": per})
        kinds = [
            [size, [[label, *factor_of(conversion)] for label, conversion in orders]]
            for size, orders in size_kinds(result)
        ]
        return {"rates": rates, "kinds": kinds}

    def record(self) -> Plain:
        """The record, without what is said of parameters and file.

        Raises:
            LeftOut: the page leaves the whole run to the command.
        """
        problem, variation = self.problem, self.variation
        why = self.why_left()
        if why is not None:
            raise LeftOut(why)
        self._needs()
        # arrows ask for forces that the command does not compute: no power error is told by them
        asked = demand_of(problem.mechanism, self.wanted.values()) | self.beside
        has_power = bool(asked & Demand.FORCES and asked & Demand.VELOCITY)
        self.judges_forces = bool(asked & Demand.FORCES)
        poses = pose_records(self, self.data)
        arrows = arrows_of(self, self.data)
        demand = demand_of(problem.mechanism, self.wanted.values()) | asked
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
            raise LeftOut("it has more numbers than a page computes at every change")
        plan = self._plan(demand)
        tables = self._table_records()
        if not any(column for table in tables for column in table["columns"]):
            raise LeftOut("a page computes none of the columns of its tables")
        verdict = self._verdict() | {"power": has_power}
        arrow_records = arrows()
        pose_data = poses()
        axis = self.shown["x"]["label"]
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
        of_run = self._run_record()
        tape, sources = self.recorder.program(self.outputs)
        drawing = drawing_of(self, self.data)
        numbers = variation.recorded_tape(self.numbers or [0.0])
        length = problem.units.conversion(LENGTH)
        return {
            **plan,
            "cells": tape_text(tape_values(tape)),
            "sources": [[source.kind, source.at] for source in sources],
            "numbers": tape_text(tape_values(numbers)),
            "given": self.given,
            "rows": problem.motion.rows,
            "ends_early": not bool(self.analysis.result.solved.all()),
            "axis": at,
            "tables": tables,
            "row_inputs": row_inputs,
            **of_run,
            "zero": float(tolerances.ZERO_CELL),
            "verdict": verdict,
            "arrows": arrow_records,
            "poses": pose_data,
            "home": Lengths(problem.units).vector(problem.mechanism.datum),
            "length": factor_of(length),
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
        branch = self.shown["branches"][0]
        return {"all_rows": branch["rows"] == self.problem.motion.rows}

    def _is_base(self) -> bool:
        """Whether the rows that are shown are those of the base that was recorded."""
        rows = self.analysis.result.row_states
        own = rows.states[:, self.variation.row]
        return own.shape == self.variation.state.shape and bool(
            np.abs(own - self.variation.state).max(initial=0.0) <= tolerances.SAME_MODE
        )
