"""The methods: mechkin's kernel and sweep at all settings, the dense systems of the sources, and
solvers of one row after the other.

A dense system has all reactions and efforts of a position at once: six equations for every link and
the conditions of the pairs (24, 34, 40, 50 unknowns in the dissertation on successive screws;
`balances/newton_euler.py`). Only its solution by LAPACK is timed, not the motion that it needs nor
its making.

Rows one after the other are what a script solves: each starts from the row before, the first from
its own closed coordinates. scipy's root finders are run over their tolerances, with differences for
rates. Explicit stepping, as programs of the literature have it, integrates rates from row to row:
Euler's method moves each step by the rates at its start (a successive screw displacement), the
classical Runge-Kutta method takes four rates a step. No step closes the loops again, so that errors
grow along the sweep.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from functools import partial
from math import cos, sin
from typing import Any

import numpy as np

from mechkin_cli.balances import DenseSystem, dense_system, row_motion
from mechkin_cli.bench.chain import Entries, Placing, Turned
from mechkin_cli.bench.measurement import Method, Unable
from mechkin_cli.bench.scene import ALONE, BATCH, LEVELS, ORDERS, BenchScene, Values
from mechkin_cli.kernel.functions import widths
from mechkin_cli.session import Batch, Packing, follow, step_limits
from mechkin_cli.show import Floats
from mechkin_cli.sweep import Result, analyze

FAMILY = "mechkin"
UNIT = "kernel, guesses as followed"
"""The curve that others are measured by."""

FOLLOWED = "sweep, followed and closed"
ANALYZED = "sweep, verdicts"

TOLERANCES = tuple(10.0**-k for k in (1, 2, 4, 6, 8, 10, 12, 14))
STEPS = (1, 2, 3, 4)
SPACINGS = tuple(2.0**-k for k in range(1, 7))
"""Longest steps of the skeleton (rad, length units); the first is that of every sweep."""


def kernel_methods(scene: BenchScene) -> Iterator[Method]:
    """Newton's tolerance and steps, levels, widths, the sweep with its skeleton, verdicts."""
    for level in LEVELS:
        yield _kernel(scene, UNIT, level, level, scene.followed)
    for limit in TOLERANCES:
        name, tests = "kernel, by tolerance", (limit, np.sqrt(limit), limit)
        yield _kernel(scene, name, f"{limit:.0e}", "position", scene.from_before, tests=tests)
    for steps in STEPS:
        start, name = scene.from_before, "kernel, by Newton steps"
        yield _kernel(scene, name, str(steps), "position", start, iterations=steps)
    for lanes in widths():
        name, packing = "kernel, by width", Packing(lanes, 1)
        yield _kernel(scene, name, f"{lanes} lanes", "everything", scene.followed, packing=packing)
    yield from _sweeps(scene)


def _kernel(
    scene: BenchScene, curve: str, setting: str, level: str, guess: Floats, **options: Any
) -> Method:
    make = partial(scene.kernel, level, guess, **options)
    call, once = make(count=BATCH), make()
    return Method(FAMILY, curve, setting, level, call, BATCH, lambda: scene.found(level, once()))


def _sweeps(scene: BenchScene) -> Iterator[Method]:
    rows, session = scene.result.rows, scene.model.session.packed(ALONE)
    if scene.session.route is None and scene.is_whole:
        for spacing in SPACINGS:
            call, read = followed_by(scene, "position", spacing)
            curve = "sweep, by skeleton spacing"
            yield Method(FAMILY, curve, f"{spacing:g}", "position", call, rows, read)
        for level in LEVELS:
            call, read = followed_by(scene, level, SPACINGS[0])
            yield Method(FAMILY, FOLLOWED, level, level, call, rows, read)
    for level in LEVELS:
        for verdicts, curve in ((True, ANALYZED), (False, "sweep, no verdicts")):
            call = partial(analyze, session, scene.names(level), verdicts=verdicts)
            read = partial(_values, scene, level, call)
            yield Method(FAMILY, curve, level, level, call, rows, read)


def _values(scene: BenchScene, level: str, call: Callable[[], Result]) -> Values:
    columns = call().columns
    names = scene.names(level)
    return {name: columns[name][:, scene.places] for name in names if name in columns}


def followed_by(
    scene: BenchScene, level: str, spacing: float
) -> tuple[Callable[[], object], Callable[[], Values]]:
    """Following all rows with steps up to `spacing`, and closing them: call, and what it finds."""
    session, inputs = scene.session, scene.session.inputs
    limits = step_limits(longest_step=spacing, straight=scene.problem.assembly.straight)
    start = np.ascontiguousarray(scene.result.row_states.states[:, scene.result.start.row])
    path, whole = inputs.reduced, inputs.whole
    close = scene.closing(level, np.arange(path.shape[1]))

    def call() -> Batch:
        followed = follow(session.plan, path, start, turns=True, whole=whole, limits=limits)
        return close(followed.guess)

    def read() -> Values:
        found = scene.found(level, call())
        return {name: columns[:, scene.places] for name, columns in found.items()}

    return call, read


DENSE = "dense"
EFFORT = 4
"""The rank of efforts among the unknowns."""


def dense_methods(scene: BenchScene) -> Iterator[Method]:
    """The solution of all places in one call."""
    if scene.problem.mechanism.spins:
        raise Unable("links between two balls spin freely, so that its system is singular")
    systems = [dense_system(scene.result, int(row)) for row in scene.places]
    first = systems[0]
    equations, unknowns = len(first.equations), len(first.unknowns)
    if equations != unknowns:
        raise Unable(f"its system is not square: {equations} equations in {unknowns} unknowns")
    matrix = np.array([system.coefficients for system in systems])
    right = np.array([system.right for system in systems])[:, :, None]
    try:
        solution = np.linalg.solve(matrix, right)[:, :, 0]
    except np.linalg.LinAlgError:
        raise Unable(f"its system of {unknowns} unknowns is singular") from None
    yield Method(
        DENSE,
        "reactions by LAPACK, solution alone",
        f"{unknowns} unknowns",
        "everything",
        partial(np.linalg.solve, matrix, right),
        scene.rows,
        partial(loads, scene, systems, solution),
    )


def loads(scene: BenchScene, systems: list[DenseSystem], solution: Floats) -> Values:
    """Efforts (1, rows) and wrenches (3, rows) about the joints' points, by name."""
    names = scene.asked["loads"]
    found: Values = {n: np.zeros((1 if n.endswith(".effort") else 3, scene.rows)) for n in names}
    for k, (system, values) in enumerate(zip(systems, solution, strict=True)):
        motion = row_motion(scene.result, int(scene.places[k]))
        for unknown, value in zip(system.unknowns, values, strict=True):
            force, moment = (np.array(part) * value for part in unknown.wrench)
            joint = unknown.joint
            if unknown.rank == EFFORT:
                if f"{joint}.effort" in found:
                    found[f"{joint}.effort"][0, k] = value
            elif f"{joint}.force" in found:
                found[f"{joint}.force"][:, k] += force
                place = motion.point(scene.problem.mechanism.joints[joint].point)
                found[f"{joint}.moment"][:, k] += moment - np.cross(place, force)
    return found


MANY_UNKNOWNS = 12
"""Beyond, differences of the whole closure in Python take tens of milliseconds a row."""

BALL = range(3)
"""The turns of a ball."""

Gap = Callable[[Floats], Floats]
Solve = Callable[[Gap, Floats], Floats]
"""From the gap as a function of the unknowns, and a start, to the unknowns. They are counted so
that the start is 1: solvers take their differences in parts of the unknowns."""


class RowByRow:
    """A scene for solvers of one row at a time."""

    def __init__(self, scene: BenchScene) -> None:
        self.scene, self.chain = scene, scene.chain
        self.placing = Placing(self.chain, Entries(cos, sin))
        self.unknowns = list(self.chain.unknowns)
        self.driven = list(self.chain.inputs)
        lengths = [k in self.chain.lengths for k in self.driven]
        units = np.where(lengths, self.chain.length, 1.0)[:, None]
        inputs = scene.session.inputs
        self.inputs: Floats = inputs.values[:, scene.places] * units
        self.rates: Floats = inputs.rates[:, scene.places] * units
        self.accelerations: Floats = inputs.accelerations[:, scene.places] * units
        values, turned = coordinates_of(scene, slice(0, 1))
        self.start: Floats = values[:, 0]
        self.turned = {
            ball: [[float(x[0]) for x in row] for row in matrix] for ball, matrix in turned.items()
        }

    @property
    def is_long(self) -> bool:
        """Whether a sweep takes so long that few settings have to do."""
        return len(self.unknowns) > MANY_UNKNOWNS

    @property
    def is_square(self) -> bool:
        """Whether there are as many equations as unknowns."""
        return self.chain.equations == len(self.unknowns)

    def gap(self, q: Floats, turned: dict[int, Any]) -> Floats:
        """All closing equations (equations,) at coordinates (coordinates,)."""
        entries = q.tolist()
        places = self.placing.places(entries, turned)
        return np.array(self.placing.gaps(places, entries, turned))

    def values(self, solve: Solve, inputs: Floats) -> Values:
        """Coordinates and points by name, of rows whose inputs (inputs, rows) are given."""
        return self.named(*self.rows(solve, inputs))

    def rows(self, solve: Solve, inputs: Floats) -> tuple[Floats, list[dict[int, Any]]]:
        """Coordinates (coordinates, rows) and the orientations that balls count from."""
        q, turned = self.start.copy(), dict(self.turned)
        found, orientations = np.empty((q.size, inputs.shape[1])), []
        for row in range(inputs.shape[1]):
            q[self.driven] = inputs[:, row]

            start = q[self.unknowns] - 1.0

            def gap(
                x: Floats, q: Floats = q, turned: dict[int, Any] = turned, start: Floats = start
            ) -> Floats:
                at = q.copy()
                at[self.unknowns] = start + x
                return self.gap(at, turned)

            q[self.unknowns] = start + solve(gap, np.ones(start.size))
            found[:, row] = q
            orientations.append(turned)
            q, turned = self.rebased(q, turned)
        return found, orientations

    def rebased(self, q: Floats, turned: dict[int, Any]) -> tuple[Floats, dict[int, Any]]:
        """The same place with the turns of balls counted from where they are."""
        if not turned:
            return q, turned
        algebra, q, found = self.placing.algebra, q.copy(), {}
        for ball, matrix in turned.items():
            frame = [[*row, 0.0] for row in matrix]
            for about in BALL:
                frame = algebra.turned(frame, about, float(q[ball + about]))
                q[ball + about] = 0.0
            found[ball] = [row[:3] for row in frame]
        return q, found

    def named(self, q: Floats, orientations: list[dict[int, Any]]) -> Values:
        """Coordinates (1, rows) and points (3, rows) by name."""
        turned = self.orientations(orientations)
        placing = Placing(self.chain, Entries(np.cos, np.sin))
        places = placing.places(q, turned)
        found: Values = {
            name: values[None, :] for name, values in zip(self.chain.coordinates, q, strict=True)
        }
        for name, body, at in self.chain.points:
            found[f"{name}.position"] = np.array(
                [np.zeros(q.shape[1]) + x for x in placing.image(places, body, at)]
            )
        return {name: found[name] for name in self.scene.asked["position"]}

    def orientations(self, rows: list[dict[int, Any]]) -> dict[int, Any]:
        """What balls count from, (3, 3, rows) by ball."""
        return {
            ball: np.array([row[ball] for row in rows]).transpose(1, 2, 0) for ball in self.turned
        }


def coordinates_of(scene: BenchScene, rows: Any) -> tuple[Any, Turned]:
    """Closed coordinates (coordinates, rows) of a scene in SI as the kernel has them, and what
    balls count from; a ball that closes a loop has none."""
    chain, states = scene.chain, scene.states[:, rows]
    values = np.zeros((len(chain.coordinates), states.shape[1]))
    turned = {}
    for k, (name, place) in enumerate(zip(chain.coordinates, chain.states, strict=True)):
        if place is None:
            if name in scene.closing_values:
                values[k] = scene.closing_values[name][0, rows]
        elif not any(0 <= k - ball < len(BALL) for ball in chain.balls):
            values[k] = states[place] * (chain.length if k in chain.lengths else 1.0)
    for ball in chain.balls:
        place = chain.states[ball]
        if place is not None:
            turned[ball] = rotation(np.asarray(states[place : place + 4], np.longdouble))
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


SCIPY = "scipy"
SCIPY_TOLERANCES = tuple(10.0**-k for k in (2, 5, 8, 14))
DIFFERENCES = tuple(10.0**-k for k in (2, 3, 4, 5))
"""Of the differences: how far inputs move between two positions (rad, m)."""


def scipy_methods(scene: BenchScene) -> Iterator[Method]:
    """`fsolve` (`least_squares` where equations are more than unknowns), and differences."""
    from scipy.optimize import fsolve, least_squares

    rows = RowByRow(scene)

    def by_fsolve(tolerance: float, gap: Gap, start: Floats) -> Floats:
        with warnings.catch_warnings():  # that a tolerance is not met is seen in the error
            warnings.simplefilter("ignore", RuntimeWarning)
            found: Floats = fsolve(gap, start, xtol=tolerance)
        return found

    def by_least_squares(tolerance: float, gap: Gap, start: Floats) -> Floats:
        at = max(tolerance, float(np.finfo(float).eps))
        found: Floats = least_squares(gap, start, method="lm", xtol=at, ftol=at, gtol=at).x
        return found

    solvers = {"least_squares": by_least_squares}
    if rows.is_square:
        solvers = {"fsolve": by_fsolve, **solvers}
    for name, solver in solvers.items():
        for tolerance in SCIPY_TOLERANCES[:: 3 if rows.is_long else 1]:
            call = partial(rows.values, partial(solver, tolerance), rows.inputs)
            yield _by_scipy(name, f"{tolerance:.0e}", "position", call, rows)
    best = solvers["fsolve" if rows.is_square else "least_squares"]
    if rows.rates.any() and not rows.is_long:
        for step in DIFFERENCES:
            call = partial(differences, rows, partial(best, SCIPY_TOLERANCES[-1]), step)
            yield _by_scipy(
                f"{next(iter(solvers))}, differences", f"{step:.0e}", "motion", call, rows
            )


def differences(rows: RowByRow, solve: Solve, step: float) -> Values:
    """Velocities and accelerations from three positions a row, whose inputs are `step` apart."""
    time = step / float(np.max(np.abs(rows.rates)))
    before, here, after = (
        rows.values(solve, rows.inputs + t * rows.rates + 0.5 * t * t * rows.accelerations)
        for t in (-time, 0.0, time)
    )
    asked, found = rows.scene.asked, dict(here)
    orders = (asked[order] for order in ORDERS)
    for name, first, second in zip(*orders, strict=True):
        found[first] = (after[name] - before[name]) / (2.0 * time)
        found[second] = (after[name] - 2.0 * here[name] + before[name]) / (time * time)
    return found


def _by_scipy(
    curve: str, setting: str, level: str, call: Callable[[], Values], rows: RowByRow
) -> Method:
    return Method(SCIPY, curve, setting, level, call, rows.scene.rows, call, slow=True)


STEPPING = "stepping"
EULER_STEPS = (1, 4)
RUNGE_KUTTA_STEPS = (1, 2)
"""Steps between two rows."""

DIFFERENCE = 2.0**-18
"""Of the columns (rad, m): central differences leave its square, far below what steps leave."""


def stepping_methods(scene: BenchScene) -> Iterator[Method]:
    """Both methods over their steps."""
    rows = RowByRow(scene)
    if rows.is_long:
        raise Unable(f"{len(rows.unknowns)} unknowns at once: differences take too long in Python")
    plans = [("Euler's method", euler, n) for n in EULER_STEPS]
    plans += [("Runge-Kutta method", runge_kutta, n) for n in RUNGE_KUTTA_STEPS]
    for curve, rule, steps in plans:
        call = partial(stepped, rows, rule, steps)
        setting = f"{steps} a row"
        yield Method(STEPPING, curve, setting, "position", call, scene.rows, call, slow=True)


def stepped(rows: RowByRow, rule: Any, steps: int) -> Values:
    """Positions by name, stepped from row to row."""
    q, turned = rows.start.copy(), dict(rows.turned)
    q[rows.driven] = rows.inputs[:, 0]
    found, orientations = [q], [turned]
    for row in range(1, rows.inputs.shape[1]):
        part = (rows.inputs[:, row] - rows.inputs[:, row - 1]) / steps
        for _ in range(steps):
            q, turned = rows.rebased(q, turned)
            q = q + rule(rows, q, turned, part)
        found.append(q)
        orientations.append(turned)
    return rows.named(np.array(found).T, orientations)


def euler(rows: RowByRow, q: Floats, turned: dict[int, Any], part: Floats) -> Floats:
    """One step that moves the inputs by `part`."""
    return slopes(rows, q, turned, part)


def runge_kutta(rows: RowByRow, q: Floats, turned: dict[int, Any], part: Floats) -> Floats:
    """The same by the classical method of fourth order."""
    one = slopes(rows, q, turned, part)
    two = slopes(rows, q + 0.5 * one, turned, part)
    three = slopes(rows, q + 0.5 * two, turned, part)
    four = slopes(rows, q + three, turned, part)
    found: Floats = (one + 2.0 * two + 2.0 * three + four) / 6.0
    return found


def slopes(rows: RowByRow, q: Floats, turned: dict[int, Any], part: Floats) -> Floats:
    """How all coordinates move to first order where the inputs move by `part`."""
    moved = np.zeros_like(q)
    moved[rows.driven] = part

    def along(direction: Floats) -> Floats:
        ahead, behind = (rows.gap(q + s * direction, turned) for s in (DIFFERENCE, -DIFFERENCE))
        return (ahead - behind) / (2.0 * DIFFERENCE)

    columns = np.array([along(unit) for unit in np.eye(q.size)[rows.unknowns]]).T
    moved[rows.unknowns] = np.linalg.lstsq(columns, -along(moved), rcond=None)[0]
    return moved
