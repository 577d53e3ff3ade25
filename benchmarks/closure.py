"""Positions, velocities and accelerations from the closing equations alone, without the kernel.

The tests hold the true values of `mechkin bench` against them. Rows are closed again in 64 bits of
mantissa: Newton's method from the rows' own states, whose matrix, the velocities and the drift of
the accelerations come from jets of the closing equations. A `Jet` is a number with two derivatives
by one parameter, f + f' t + f'' t^2/2, truncated.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mechkin_cli.bench.chain import EQUATIONS, BodyTree, CommonFrame, Entries, Placing, Turned
from mechkin_cli.bench.methods import RowByRow, coordinates_of
from mechkin_cli.bench.scene import BenchScene, Values
from mechkin_cli.tape import eliminate

STEPS = 4
"""Newton's method starts from doubles: two steps pass 64 bits."""

Exact = Any
"""An array of numpy's widest floating-point numbers."""


class Jet:
    """A value with its first and second derivative."""

    __array_ufunc__ = None
    """Arrays leave their operators to the jet."""

    def __init__(self, value: Any, first: Any = 0.0, second: Any = 0.0) -> None:
        self.value, self.first, self.second = value, first, second

    def __add__(self, other: Any) -> Jet:
        o = jet(other)
        return Jet(self.value + o.value, self.first + o.first, self.second + o.second)

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.first, -self.second)

    def __sub__(self, other: Any) -> Jet:
        return self + -jet(other)

    def __rsub__(self, other: Any) -> Jet:
        return jet(other) - self

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.value * other, self.first * other, self.second * other)
        crossed = self.first * other.first
        return Jet(
            self.value * other.value,
            self.first * other.value + self.value * other.first,
            self.second * other.value + crossed + crossed + self.value * other.second,
        )

    __radd__ = __add__
    __rmul__ = __mul__

    def outer(self, value: Any, slope: Any, bend: Any) -> Jet:
        """f(self), with f, f' and f'' at its value."""
        return Jet(value, slope * self.first, slope * self.second + bend * self.first * self.first)


def jet(value: Any) -> Jet:
    """A number as a jet, a constant if it is none."""
    return value if isinstance(value, Jet) else Jet(value)


class State(NamedTuple):
    """Coordinates (coordinates, rows) with two time derivatives, and the orientations that balls
    count from."""

    values: Exact
    rates: Exact
    accelerations: Exact
    turned: Turned


def true_values(scene: BenchScene) -> Values:
    """All positions, velocities and accelerations that are asked of a scene, at its places.

    Arrays (1, rows) and (3, rows) of the widest numbers, SI.
    """
    return named_values(scene.chain, true_states(scene))


def true_states(scene: BenchScene) -> State:
    """The closed coordinates at the places of a scene."""
    chain, at = scene.chain, slice(None)
    inputs, real = scene.session.inputs, scene.places
    values, turned = coordinates_of(scene, at)
    q, (rates, accelerations) = _wide(values), (np.zeros_like(_wide(values)) for _ in range(2))
    for k, number in enumerate(chain.inputs):
        unit = _wide(chain.length if number in chain.lengths else 1.0)
        q[number] = _wide(inputs.reduced[k, real]) * unit
        rates[number] = _wide(inputs.rates[k, real]) * unit
        accelerations[number] = _wide(inputs.accelerations[k, real]) * unit
    closure = Closure(chain, turned)
    q = closure.closed(q)
    solve = closure.solver(q)
    rates = rates + solve(-closure.along(q, rates)[0])
    accelerations = accelerations + solve(-closure.along(q, rates, accelerations)[1])
    return State(q, rates, accelerations, turned)


class Closure:
    """The closing equations of a chain over many rows, and systems of their unknowns."""

    def __init__(self, chain: BodyTree, turned: Turned) -> None:
        self.chain, self.turned = chain, turned
        self.placing = Placing(chain, JETS)

    def along(self, q: Any, rates: Any, accelerations: Any = None) -> tuple[Any, Any]:
        """First and second derivative of the equations (equations, rows) along a motion."""
        second = np.zeros_like(q) if accelerations is None else accelerations
        found = self._gaps([Jet(*entry) for entry in zip(q, rates, second, strict=True)])
        first = np.array([_filled(g.first, q) for g in found])
        return first, np.array([_filled(g.second, q) for g in found])

    def gap(self, q: Any) -> Any:
        """The equations (equations, rows)."""
        return np.array([_filled(g.value, q) for g in self._gaps([Jet(x) for x in q])])

    def closed(self, q: Any) -> Any:
        """Newton's method in the unknowns; balls without a state need a guess of zero."""
        for _ in range(STEPS):
            q = q - self.solver(q)(self.gap(q))
        return q

    def solver(self, q: Any) -> Any:
        """Takes right sides (equations, rows) to coordinates (coordinates, rows)."""
        columns = []
        for unknown in self.chain.unknowns:
            direction = np.zeros_like(q)
            direction[unknown] = 1
            columns.append(self.along(q, direction)[0])
        scale = self._scales()
        matrix = np.array(columns).transpose(2, 1, 0) * scale[None, :, None]
        unknowns = list(self.chain.unknowns)

        def solve(right: Any) -> Any:
            found = np.zeros_like(q)
            found[unknowns] = solved(matrix, (right * scale[:, None]).T).T
            return found

        return solve

    def _scales(self) -> Any:
        """Factors that give turns and lengths one size."""
        lengths = [1.0 / self.chain.size] * self.chain.equations
        row = 0
        for closing in self.chain.closings:
            count = EQUATIONS[type(closing)]
            if isinstance(closing, CommonFrame):
                lengths[row : row + 3] = [1.0] * 3
            row += count
        return _wide(lengths)

    def _gaps(self, q: list[Jet]) -> list[Jet]:
        places = self.placing.places(q, self.turned)
        return [jet(g) for g in self.placing.gaps(places, q, self.turned)]


def named_values(chain: BodyTree, state: State) -> Values:
    """Coordinates and points by name, with their derivatives."""
    q = [Jet(*entry) for entry in zip(state.values, state.rates, state.accelerations, strict=True)]
    found: Values = {}
    for name, entry in zip(chain.coordinates, q, strict=True):
        if name:
            for end, value in zip(("", "_dot", "_ddot"), _orders(entry), strict=True):
                found[name + end] = _filled(value, state.values)[None, :]
    placing = Placing(chain, JETS)
    places = placing.places(q, state.turned)
    for name, body, at in chain.points:
        moved = [_orders(jet(x)) for x in placing.image(places, body, at)]
        for end, values in zip(
            ("position", "velocity", "acceleration"), zip(*moved, strict=True), strict=True
        ):
            found[f"{name}.{end}"] = np.array([_filled(x, state.values) for x in values])
    return found


def solved(matrix: Any, right: Any) -> Any:
    """Solutions (rows, n) of systems (rows, m, n), of more equations the least squares."""
    if matrix.shape[1] != matrix.shape[2]:
        right = np.einsum("rij,ri->rj", matrix, right)
        matrix = np.einsum("rij,rik->rjk", matrix, matrix)
    return eliminate(matrix, right)


def _orders(entry: Jet) -> tuple[Any, Any, Any]:
    return entry.value, entry.first, entry.second


def _filled(value: Any, like: Any) -> Any:
    """One number for every row."""
    return np.zeros(like.shape[1], like.dtype) + value


def _wide(values: Any) -> Any:
    return np.array(values, dtype=np.longdouble)


def _cos(angle: Any) -> Jet:
    x = jet(angle)
    c, s = np.cos(x.value), np.sin(x.value)
    return x.outer(c, -s, -c)


def _sin(angle: Any) -> Jet:
    x = jet(angle)
    c, s = np.cos(x.value), np.sin(x.value)
    return x.outer(s, c, -s)


JETS = Entries(_cos, _sin, np.longdouble)


def named_motion(
    rows: RowByRow,
    q: Any,
    orientations: list[dict[int, Any]],
    rates: Any,
    accelerations: Any,
) -> Values:
    """Positions, velocities and accelerations by name; arrays (coordinates, rows)."""
    state = State(q, rates, accelerations, rows.orientations(orientations))
    found = named_values(rows.chain, state)
    return {name: found[name] for name in rows.scene.names("motion")}
