"""`balances:` - sums over a cycle of the sweep: works, harmonics and flywheels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building.tables import ColumnSample
from mechkin_cli.expressions import ExpressionError, Vector
from mechkin_cli.mechanism import AnyBalance, Cycle, Flywheel, Harmonics, LoadWork
from mechkin_cli.schema import tables as written
from mechkin_cli.session import turn_of
from mechkin_cli.tolerances import EQUAL_STEPS
from mechkin_cli.units import ANGULAR_RATE, DIMENSIONLESS, Dimension
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields, Path
    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import DrivenInput, Problem, Wanted
    from mechkin_cli.show import Floats


LEAST_ROWS = 4
"""Rows of a cycle."""
TIME = "time"


def build_balances(
    fields: Fields, sections: Sequence[written.AnyBalance], problem: Problem
) -> tuple[AnyBalance, ...]:
    """The balances of a file; errors are noted in `fields`."""
    builder = _BalanceBuilder(fields, problem)
    balances = [builder.balance(("balances", i), section) for i, section in enumerate(sections)]
    return tuple(balance for balance in balances if balance is not None)


class _BalanceBuilder:
    def __init__(self, fields: Fields, problem: Problem) -> None:
        self.fields = fields
        self.problem = problem
        self.known: Mapping[str, Wanted] = problem.quantities()

    def balance(self, path: Path, section: written.AnyBalance) -> AnyBalance | None:
        cycle = self._cycle(path, section)
        place, title = self.fields.document.place(path), section.title or section.name
        if isinstance(section, written.HarmonicsBalance):
            of = self._expressions((*path, "of"), section.of)
            orders = self._orders((*path, "orders"), section.orders, cycle)
            if cycle is None:
                return None
            return Harmonics(section.name, title, place, cycle, of, orders)
        if isinstance(section, written.FlywheelBalance):
            unevenness = self._unevenness((*path, "unevenness"), section.unevenness)
            rate = self._rate(path, section, cycle)
            if cycle is None or rate is None:
                return None
            return Flywheel(section.name, title, place, cycle, unevenness, rate)
        return None if cycle is None else LoadWork(section.name, title, place, cycle)

    def _cycle(self, path: Path, section: written.AnyBalance) -> Cycle | None:
        motion = self.problem.motion
        at: Path = path if section.cycle is None else (*path, "cycle")
        name = section.cycle or self._default_cycle(section)
        if name == TIME:
            return self._cycle_in_time(at)
        inputs = {item.name: number for number, item in enumerate(motion.inputs)}
        if name is None or name not in inputs:
            text = "nothing moves in the sweep" if name is None else f"{name} is not an input"
            hint = f"inputs are {', '.join(inputs)}" if inputs else "add motion: inputs:"
            self.fields.error("not-driven", at, text, hint)
            return None
        item = motion.inputs[inputs[name]]
        turn = turn_of(self.problem, item)
        if turn is None:
            hint = "name an input that turns, or with time: and laws that come back, cycle: time"
            self.fields.error("no-cycle", at, f"{name} is not an angle that goes round", hint)
            return None
        if not self._are_equal(at, name, item.written):
            return None
        turns = float(item.written[-1] - item.written[0]) / float(turn)
        count = round(abs(turns))
        if count == 0 or abs(abs(turns) - count) > EQUAL_STEPS * count:
            self._not_closed(at, item, float(turn))
            return None
        step = float(item.values[-1] - item.values[0]) / (item.values.size - 1)
        return Cycle(name, inputs[name], count, step, float(item.values[0]))

    def _default_cycle(self, section: written.AnyBalance) -> str | None:
        motion = self.problem.motion
        if motion.time is not None and not isinstance(section, written.FlywheelBalance):
            return TIME
        moving = motion.leading
        return None if moving is None or not np.ptp(moving.values) else moving.name

    def _cycle_in_time(self, at: Path) -> Cycle | None:
        motion = self.problem.motion
        if motion.time is None:
            hint = "name the input that turns, or give the sweep a time:"
            self.fields.error("no-cycle", at, "the sweep has no time", hint)
            return None
        if not self._are_equal(at, TIME, motion.time.written):
            return None
        for item in motion.inputs:
            turn = turn_of(self.problem, item)
            for k, (name, (_, values)) in enumerate(list(item.orders.items())[:3]):
                gap = float(values[-1] - values[0])
                if k == 0 and turn is not None:
                    gap -= round(gap / float(turn)) * float(turn)
                if abs(gap) > EQUAL_STEPS * max(float(np.max(np.abs(values))), 1.0):
                    unit = self.problem.units.label(self.known[name].dimension)
                    text = f"{name} is not back at the last row: {gap:.6g} {unit} is missing"
                    hint = "let time: go over a whole period of the laws"
                    self.fields.error("cycle-not-closed", at, text, hint)
                    return None
        moments = motion.time.values
        step = float(moments[-1] - moments[0]) / (moments.size - 1)
        return Cycle(TIME, None, 1, step, float(moments[0]))

    def _are_equal(self, at: Path, name: str, values: Floats) -> bool:
        steps = np.diff(values)
        if steps.size < LEAST_ROWS:
            text = f"{values.size} row{'s' * (values.size != 1)} are too few for a cycle"
            hint = f"give at least {LEAST_ROWS + 1}, the last as the first"
            self.fields.error("too-few-rows", at, text, hint)
            return False
        mean = float(values[-1] - values[0]) / steps.size
        off = np.abs(steps - mean)
        # differences of large values round by those
        slack = EQUAL_STEPS * abs(mean) + 4.0 * np.finfo(float).eps * float(np.max(np.abs(values)))
        wrong = np.flatnonzero(~(off <= slack))
        if mean != 0.0 and not wrong.size:
            return True
        row = int(wrong[0]) if wrong.size else 0
        text = f"the rows are not at equal distances of {name}"
        measured = f"{steps[row]:.6g} from row {row + 1} to row {row + 2}, {mean:.6g} on average"
        hint = "sweep it with from, to and step, or count"
        self.fields.error("unequal-rows", at, text, hint, measured=measured)
        return False

    def _not_closed(self, at: Path, item: DrivenInput, turn: float) -> None:
        first, last = float(item.written[0]), float(item.written[-1])
        unit = self.problem.units.label(self.known[item.name].dimension)
        whole = np.ceil(abs(last - first) / turn) * turn
        end = first + float(np.copysign(whole, last - first))
        missing = abs(end - last)
        text = f"{item.name} goes from {first:.12g} to {last:.12g} {unit}: {missing:.6g} {unit} "
        text += "are missing to a full turn"
        step = abs(last - first) / (item.written.size - 1)
        is_next = abs(missing - step) < EQUAL_STEPS * step
        repeat = "the last row repeats the first: " if is_next else ""
        self.fields.error("cycle-not-closed", at, text, f"{repeat}write to: {end:.12g}")

    def _expressions(self, path: Path, texts: Sequence[str]) -> tuple[tuple[str, Expression], ...]:
        named: list[tuple[str, Expression]] = []
        dimension: Dimension | None = None
        parse = self.fields.definitions.parse
        for i, text in enumerate(texts):
            try:
                expression = parse(text)
                quantity = expression.evaluate(ColumnSample(self.fields, self.known, SWEEP))
                if dimension is not None and not quantity.dimension.compatible(dimension):
                    phrases = f"this is {quantity.dimension.phrase}, the first {dimension.phrase}"
                    message = f"one table holds one dimension; {phrases}"
                    raise ExpressionError(message, 0, "make it a balance of its own")
                dimension = dimension or quantity.dimension
                stem = text.strip()
                if isinstance(quantity.value, Vector):
                    if not stem.replace(".", "").replace("_", "").isalnum():
                        stem = f"({stem})"
                    named += [(f"{stem}.{axis}", parse(f"{stem}.{axis}")) for axis in "xyz"]
                else:
                    named.append((stem, expression))
            except ExpressionError as error:
                self.fields.expression_error((*path, i), error)
        return tuple(named)

    def _orders(self, path: Path, texts: Sequence[str], cycle: Cycle | None) -> tuple[float, ...]:
        orders = []
        for i, text in enumerate(texts):
            order = self.fields.number((*path, i), text, DIMENSIONLESS)
            if cycle is None:
                continue
            whole = order * cycle.turns
            rows = self.problem.motion.rows - 1
            at: Path = (*path, i) if self.fields.document.node((*path, i)) else path[:-1]
            if order < 0.0 or abs(whole - round(whole)) > EQUAL_STEPS * max(whole, 1.0):
                steps = "1" if cycle.turns == 1 else f"1/{cycle.turns}"
                text = f"{order:g} is not an order of a cycle of {cycle.turns} turns"
                self.fields.error("no-order", at, text, f"orders are multiples of {steps}")
            elif 2 * round(whole) >= rows:
                most = (rows - 1) // 2 / cycle.turns
                text = f"order {order:g} cannot be computed from {rows} rows a cycle"
                hint = f"give more rows; these suffice for orders up to {most:g}"
                self.fields.error("no-order", at, text, hint)
            else:
                orders.append(order)
        return tuple(orders)

    def _unevenness(self, path: Path, text: str) -> float:
        value = self.fields.number(path, text, DIMENSIONLESS)
        if not 0.0 < value < 2.0:
            text = f"an unevenness of {value:g} is not possible"
            hint = "(largest - least rate) / their mean lies between 0 and 2, such as 0.01"
            self.fields.error("bad-unevenness", path, text, hint)
            return 1.0
        return value

    def _rate(
        self, path: Path, section: written.FlywheelBalance, cycle: Cycle | None
    ) -> float | None:
        if cycle is not None and cycle.number is None:
            text = "a flywheel sits on an input that turns"
            self.fields.error("no-cycle", (*path, "cycle"), text, "name that input")
            return None
        if section.rate is not None:
            rate = abs(self.fields.number((*path, "rate"), section.rate, ANGULAR_RATE))
            if rate == 0.0:
                text = "the mean rate is zero"
                self.fields.error("no-rate", (*path, "rate"), text, "give the rate at work")
                return None
            return rate
        if cycle is None or cycle.number is None:
            return None
        rates = self.problem.motion.inputs[cycle.number].rates
        if rates[0] == 0.0 or np.ptp(rates) > EQUAL_STEPS * abs(rates[0]):
            text = f"{cycle.name} has no constant rate in the sweep"
            hint = "give rate: to the balance, or to the input"
            self.fields.error("no-rate", path, text, hint)
            return None
        return abs(float(rates[0]))
