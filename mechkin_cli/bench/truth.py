"""What is right: the rows of a scene repeated in double-double from the text of its file.

About 32 digits, of which as many are kept as numpy's widest numbers have (`exact_values`). Beside
it stands a closure of another formula, without the kernel (`true_values`); the tests hold one
against the other, and it takes the place of the first where a text cannot be followed. Its rows are
closed anew in 64 bits of mantissa: Newton's method from the rows' own states, whose matrix, the
velocities and the drift of the accelerations come from jets of the closing equations. The mechanism
is that of the doubles that the kernel was given.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mechkin_cli.bench.chain import EQUATIONS, BodyTree, CommonFrame
from mechkin_cli.bench.closure import Entries, Jet, Placing, Turned, jet
from mechkin_cli.bench.scene import BenchScene, Values
from mechkin_cli.errors import NotRepeated, wide_run
from mechkin_cli.plan import demand_of
from mechkin_cli.tape import eliminate

STEPS = 4
"""Newton's method starts from doubles: two steps pass 64 bits."""

BALL = range(3)
"""The turns of a ball."""

Exact = Any
"""An array of numpy's widest floating-point numbers."""


class State(NamedTuple):
    """Coordinates (coordinates, rows) with two time derivatives, and the orientations that balls
    count from."""

    values: Exact
    rates: Exact
    accelerations: Exact
    turned: Turned


def width() -> str:
    """The numbers that are used, in words."""
    return f"numpy longdouble, rounding {float(np.finfo(np.longdouble).eps):.0e}"


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
        unit = _wide(chain.length if chain.coordinates[number].is_length else 1.0)
        q[number] = _wide(inputs.reduced[k, real]) * unit
        rates[number] = _wide(inputs.rates[k, real]) * unit
        accelerations[number] = _wide(inputs.accelerations[k, real]) * unit
    closure = Closure(chain, turned)
    q = closure.closed(q)
    solve = closure.solver(q)
    rates = rates + solve(-closure.along(q, rates)[0])
    accelerations = accelerations + solve(-closure.along(q, rates, accelerations)[1])
    return State(q, rates, accelerations, turned)


def coordinates_of(scene: BenchScene, rows: Any) -> tuple[Any, Turned]:
    """Closed coordinates (coordinates, rows) of a scene in SI as the kernel has them, and what
    balls count from; a ball that closes a loop has none."""
    chain, states = scene.chain, scene.states[:, rows]
    values = np.zeros((len(chain.coordinates), states.shape[1]))
    turned = {}
    for k, (coordinate, place) in enumerate(zip(chain.coordinates, chain.states, strict=True)):
        if place is None:
            if coordinate.name in scene.closing_values:
                values[k] = scene.closing_values[coordinate.name][0, rows]
        elif not any(0 <= k - ball < len(BALL) for ball in chain.balls):
            values[k] = states[place] * (chain.length if coordinate.is_length else 1.0)
    for ball in chain.balls:
        place = chain.states[ball]
        if place is not None:
            turned[ball] = rotation(_wide(states[place : place + 4]))
    return values, turned


def rotation(quaternion: Any) -> list[list[Any]]:
    """The matrix of a quaternion (4, ...), scalar first, of any length."""
    a, x, y, z = quaternion
    n = a * a + x * x + y * y + z * z
    return [
        [(a * a + x * x - y * y - z * z) / n, 2 * (x * y - a * z) / n, 2 * (x * z + a * y) / n],
        [2 * (x * y + a * z) / n, (a * a - x * x + y * y - z * z) / n, 2 * (y * z - a * x) / n],
        [2 * (x * z - a * y) / n, 2 * (y * z + a * x) / n, (a * a - x * x - y * y + z * z) / n],
    ]


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
    for coordinate, entry in zip(chain.coordinates, q, strict=True):
        if coordinate.name:
            for end, value in zip(("", "_dot", "_ddot"), _orders(entry), strict=True):
                found[coordinate.name + end] = _filled(value, state.values)[None, :]
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


TEXT = "double-double, from the numbers of the file's text"


def exact_values(scene: BenchScene) -> tuple[Values, str]:
    """Everything that is asked of a scene, at its places (width, places), and what it is by.

    Where the text cannot be followed in double-double, positions and motion are those of the
    closure.
    """
    wanted = scene.wanted(scene.asked.level("everything"))
    try:
        wide = wide_run(scene.result)
    except NotRepeated as reason:
        said = f"the closure of another formula, {width()}, as the text is not followed ({reason})"
        return true_values(scene), said
    demand = demand_of(scene.problem.mechanism, wanted)
    found = wide.run(wanted, scene.session, wide.inputs, demand)
    values: dict[str, Any] = {
        name: np.asarray(parts.high, np.longdouble)[:, scene.places]
        + np.asarray(parts.low, np.longdouble)[:, scene.places]
        for name, parts in found.items()
    }
    return values, TEXT
