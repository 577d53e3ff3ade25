"""Inputs that follow others: `with:` an expression of their coordinates.

Rates, accelerations and jerks follow by the chain rule from those of the inputs in the expression;
inputs may follow inputs that follow, in any order.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.building.coordinates import dimension_of
from mechkin_cli.building.fields import AlreadyRefused, Fields, Path
from mechkin_cli.expressions import (
    Expression,
    ExpressionError,
    Quantity,
    UnknownName,
    literal,
    parse,
)
from mechkin_cli.expressions.derivatives import derivatives
from mechkin_cli.expressions.fields import scalar
from mechkin_cli.expressions.jets import Jet, constant
from mechkin_cli.mechanism.motion import Moments
from mechkin_cli.schema.motion import FollowingInput
from mechkin_cli.units import TIME


class Following:
    """Evaluates the inputs that follow, one after another.

    `orders` holds value, rate, acceleration and jerk (4, rows) in the file's units of the inputs
    that are known, by name, and `path` leads to their section; `expressions` gets those of inputs
    that follow, in the order in which they are evaluated; `tied` are those that the motors of
    others move.
    """

    def __init__(
        self,
        fields: Fields,
        orders: dict[str, Floats],
        rows: int,
        time: Moments | None,
        path: Path,
    ) -> None:
        self.fields = fields
        self.orders = orders
        self.rows = rows
        self.time = time
        self.path = path
        self.expressions: dict[str, Expression] = {}
        self.tied: set[str] = set()

    def add_all(self, sections: Mapping[str, FollowingInput], coordinates: frozenset[str]) -> None:
        """Adds all inputs of some sections to `orders`; errors are noted in `fields`.

        `coordinates` are the names of all joint coordinates, for messages.
        """
        waiting: dict[str, Expression] = {}
        for name, section in sections.items():
            if section.drive == "tie":
                self.tied.add(name)
            if literal(section.value) is not None:
                self._hold(name, section.value)
                continue
            try:
                waiting[name] = self._parsed(name, section.value, sections, coordinates)
            except ExpressionError as error:
                self._refuse(name, error)
        while waiting:
            ready = [name for name in waiting if not waiting[name].names & waiting.keys()]
            if not ready:
                self._note_cycle(waiting)
                return
            for name in ready:
                self._follow(name, waiting.pop(name))

    def tie_rates(self) -> dict[tuple[str, str], Floats]:
        """Rates (rows,) in SI of each tied input by each input that is not tied and that it
        follows, through others or not; what follows none is noted in `fields`."""
        found: dict[str, dict[str, Floats]] = {}
        for name, expression in self.expressions.items():
            if name not in self.tied:
                continue
            own = found[name] = {}
            for used in sorted(expression.names & self.orders.keys()):
                rate = self._partial(expression, used)
                leaders = found.get(used) or {used: np.ones(self.rows)}
                for leader, through in leaders.items():
                    own[leader] = own.get(leader, np.zeros(self.rows)) + rate * through
        for name in sorted(self.tied - {name for name, own in found.items() if own}):
            text = f"{name} follows no input whose motor could move it"
            self.fields.error(
                "tied-to-nothing", (*self.path, name, "drive"), text, "remove drive: tie"
            )
        return {(name, leader): r for name, own in found.items() for leader, r in own.items()}

    def _partial(self, expression: Expression, name: str) -> Floats:
        """Rate (rows,) of an expression by one of its inputs, in SI."""
        jets = {}
        for used in expression.names:
            jet = np.zeros_like(np.broadcast_to(self._jet(used), (4, self.rows)))
            jet[0] = self._jet(used)[0]
            jet[1] = 1.0 if used == name else 0.0
            jets[used] = jet
        found: Floats = np.broadcast_to(derivatives(expression, jets), (4, self.rows))[1].copy()
        return found

    def _hold(self, name: str, text: str) -> None:
        value = self.fields.written(self._path(name), text, dimension_of(name.rpartition(".")[2]))
        self.orders[name] = np.zeros((4, self.rows))
        self.orders[name][0] = value

    def _parsed(
        self,
        name: str,
        text: str,
        sections: Mapping[str, FollowingInput],
        coordinates: frozenset[str],
    ) -> Expression:
        expression = parse(text).taking_whole(coordinates)
        for used in sorted(expression.names, key=expression.offset_of):
            if used == name:
                message, hint = f"{name} follows itself", "name the inputs that it follows"
            elif used in coordinates - self.orders.keys() - sections.keys():
                message, hint = f"{used} is no input", f"inputs are {', '.join(self.orders)}"
            else:
                continue
            if not self.fields.is_refused(used):
                raise ExpressionError(message, expression.offset_of(used), hint)
        return expression

    def _refuse(self, name: str, error: ExpressionError) -> None:
        self.fields.expression_error(self._path(name), error)
        self.fields.refused.add(name)

    def _note_cycle(self, waiting: Mapping[str, Expression]) -> None:
        """Notes one circle among inputs of which each waits for another."""
        chain = [next(iter(waiting))]
        while True:
            need = min(waiting[chain[-1]].names & waiting.keys())
            if need in chain:
                break
            chain.append(need)
        circle = chain[chain.index(need) :]
        error = ExpressionError(
            f"inputs follow each other in a circle: {' -> '.join([*circle, need])}",
            waiting[circle[-1]].offset_of(need),
            "give one of them values of its own",
        )
        self._refuse(circle[-1], error)

    def _follow(self, name: str, expression: Expression) -> None:
        coordinate = name.rpartition(".")[2]
        units = self.fields.units
        try:
            value = scalar(expression, dimension_of(coordinate), units, self._quantity)
        except ExpressionError as error:
            self._refuse(name, error)
            return
        jet = derivatives(expression, {used: self._jet(used) for used in expression.names})
        in_si = np.broadcast_to(jet, (4, self.rows)).copy()
        in_si[0] = value
        rows = np.flatnonzero(~np.isfinite(in_si).all(axis=0))
        if rows.size:
            self._note_undefined(name, expression, in_si, int(rows[0]))
            return
        self.orders[name] = np.stack(
            [units.from_si(in_si[k], dimension_of(coordinate, k)) for k in range(4)]
        )
        self.expressions[name] = expression

    def _note_undefined(self, name: str, expression: Expression, in_si: Floats, row: int) -> None:
        words = ("value", "rate", "second rate", "third rate")
        order = int(np.argmax(~np.isfinite(in_si[:, row])))
        self.fields.error(
            "undefined-rate" if order else "undefined-value",
            self._path(name),
            f"{name} has no finite {words[order]} in row {row + 1}",
            "write an expression that is smooth over all rows, or move the rows",
            measured=", ".join(self._place(used, row) for used in sorted(expression.names)),
        )
        self.fields.refused.add(name)

    def _place(self, name: str, row: int) -> str:
        """`O1.theta = 90 deg`: a quantity of the expression in one row."""
        quantity = self._quantity(name)
        value = np.broadcast_to(np.asarray(quantity.value, dtype=float), (self.rows,))[row]
        in_file = self.fields.units.from_si(float(value), quantity.dimension)
        return f"{name} = {in_file:.12g} {self.fields.units.label(quantity.dimension)}".rstrip()

    def _rows_of(self, name: str) -> Floats:
        return np.broadcast_to(self.orders[name], (4, self.rows))

    def _jet(self, name: str) -> Jet:
        """A name's own value and derivatives over time, in SI."""
        if name in self.fields.parameters:
            return constant(float(self.fields.parameters[name].value))  # type: ignore[arg-type]
        if name == "time" and self.time is not None:
            t = self.time.values
            return np.stack([t, np.ones_like(t), np.zeros_like(t), np.zeros_like(t)])
        to_si, coordinate = self.fields.units.to_si, name.rpartition(".")[2]
        orders = self._rows_of(name)
        return np.stack([to_si(orders[k], dimension_of(coordinate, k)) for k in range(4)])

    def _quantity(self, name: str) -> Quantity:
        if name in self.orders:
            return Quantity(self._jet(name)[0], dimension_of(name.rpartition(".")[2]))
        if name == "time" and self.time is not None:
            return Quantity(self.time.values, TIME)
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        if name in self.fields.parameters:
            return self.fields.resolve(name)
        raise UnknownName(name, [*self.fields.parameters, *self.orders])

    def _path(self, name: str) -> Path:
        return (*self.path, name, "with")
