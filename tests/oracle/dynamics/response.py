"""A file's `responses:` by the independent equations of motion, in the file's units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from oracle.bodies import is_angle
from oracle.document import Document, document
from oracle.dynamics.drawn import draw
from oracle.dynamics.integrate import Node, integrate
from oracle.dynamics.laws import law
from oracle.dynamics.loads import effort, pulls
from oracle.dynamics.motion import Course, Motion
from oracle.dynamics.rows import Array
from oracle.expressions import Scope
from oracle.kinematics import solve
from oracle.mechanism import Mechanism
from oracle.reader import kind_of, read


@dataclass
class Response:
    """A motion prepared to run."""

    motion: Motion
    start: Array
    times: list[float]
    mechanism: Mechanism

    def run(self, tolerance: float = 1e-13) -> dict[str, Array]:
        """By name: `time`, coordinates with `_dot` and `_ddot`, `J.force.x`, `J.moment.x`,
        energies, work, defect of energy."""
        self.motion.turns = self.turns.copy()
        nodes = integrate(self.motion, self.start, self.times, tolerance)
        return quantities(self.motion, self.times, nodes, self.mechanism)

    def __post_init__(self) -> None:
        self.turns = self.motion.turns.copy()


def prepare(
    source: Any, name: str | None = None, courses: Mapping[str, Course] | None = None
) -> Response:
    """A response of a file; driven coordinates have their courses, in the base of its units.

    Left out: stop events, tables as loads.
    """
    data = document(source)
    name = name or next(iter(data["responses"]))
    wanted = data["responses"][name]
    mechanism = read({k: v for k, v in data.items() if k not in ("loads", "motion")})
    units = mechanism.units
    scope = Scope(units, data.get("parameters", {}))
    drawn = draw(mechanism)
    loads = pulls(drawn, data, scope, name)
    for coordinate, text in wanted.get("efforts", {}).items():
        kind = "torque" if is_angle(coordinate) else "force"
        loads.append(effort(coordinate, law(scope, text, kind)))
    motion = Motion(drawn, loads, courses)
    places, rates = _start(scope, wanted["start"])
    near = wanted.get("near", data.get("assembly", {}).get("near"))
    times = moments(wanted["time"], float(units.value(units.words["time"])))
    state = motion.home()
    if near:
        state = _placed(motion, mechanism, scope, places, near)
    motion.keep_turns(state)
    state = motion.close(times[0], state, places)
    return Response(motion, motion.rates(times[0], state, rates), times, mechanism)


def _start(scope: Scope, start: dict[str, str]) -> tuple[dict[str, float], dict[str, float]]:
    places, rates = {}, {}
    for key, text in start.items():
        coordinate = key.removesuffix("_dot")
        if key == coordinate:
            places[key] = float(scope.scalar(text, kind_of(key)))
        else:
            kind = "angular rate" if is_angle(coordinate) else "speed"
            rates[coordinate] = float(scope.scalar(text, kind))
    missing = [name for name in places if name not in rates]
    return places, rates | dict.fromkeys(missing[: len(places) - len(rates)], 0.0)


def _placed(motion: Motion, mechanism: Mechanism, scope: Scope, places: Any, near: Any) -> Array:
    """The assembly near named coordinates, found at 60 digits by the solver of positions."""
    inputs = {n: (v,) for n, v in places.items()}
    guess = {n: scope.scalar(text, kind_of(n)) for n, text in near.items()}
    found = solve(mechanism, inputs, guess)
    state = motion.home()
    one = state[:-1].reshape(motion.links, 13)
    for k, name in enumerate(motion.drawn.names):
        _rotation, _ = found.poses[name]
        one[k, :3] = [float(x) for x in found.motion(name, list(motion.drawn.centre[k]))[0]]
        one[k, 3:7] = _quaternion(np.array(found.rotation(name)[0], dtype=float))
    motion.turns = _turns(motion, found)
    return state


def _turns(motion: Motion, found: Any) -> Array:
    turns = np.zeros(motion.drawn.relations.count)
    for name, terms in motion.drawn.coordinates.items():
        if is_angle(name):
            for k, _ in terms:
                turns[k] = float(found[name])
    return turns


def _quaternion(R: Array) -> Array:
    """Scalar first, of a rotation matrix, by the largest of its components."""
    K = np.array(
        [
            [np.trace(R), R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
            [0, R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
            [0, 0, R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1]],
            [0, 0, 0, R[2, 2] - R[0, 0] - R[1, 1]],
        ]
    )
    K = K + np.triu(K, 1).T
    _, vectors = np.linalg.eigh(K)
    return np.asarray(vectors[:, -1])


def moments(time: Mapping[str, Any], second: float = 1.0) -> list[float]:
    """The moments of `time:`."""
    if "values" in time:
        return [float(x) * second for x in time["values"]]
    begin, end = float(time["from"]), float(time["to"])
    if "count" in time:
        return [float(t) * second for t in np.linspace(begin, end, int(time["count"]))]
    step = float(time["step"])
    count = int((end - begin) / step + 1e-9) + 1
    return [(begin + i * step) * second for i in range(count)]


def quantities(
    motion: Motion, times: list[float], nodes: list[Node], mechanism: Mechanism
) -> dict[str, Array]:
    """What a response's rows hold, in the file's units."""
    rows: dict[str, list[float]] = {}
    units = mechanism.units

    def put(name: str, value: float, kind: str) -> None:
        rows.setdefault(name, []).append(value / float(units.of(kind)))

    angular = ("angle", "angular rate", "angular acceleration")
    linear = ("length", "speed", "acceleration")
    first = 0.0
    for time, (state, turns) in zip(times, nodes, strict=True):
        motion.turns = turns
        at = motion.posture(state)
        V = np.hstack([at.v, at.w])[:-1].ravel()
        acceleration, _ = motion.accelerations(time, state)
        J = motion.counted @ motion.drawn.relations.jacobian(at)
        bias = motion.counted @ motion.drawn.relations.bias(at)
        values = motion.counted @ motion.relations(state)
        for k, name in enumerate(motion.drawn.coordinates):
            kinds = angular if is_angle(name) else linear
            put(name, values[k], kinds[0])
            put(f"{name}_dot", J[k] @ V, kinds[1])
            put(f"{name}_ddot", J[k] @ acceleration + bias[k], kinds[2])
        for name, (force, moment) in motion.reactions(time, state).items():
            kind = mechanism.joints[name].type
            for k, x in enumerate("xyz" if kind != "W" else ""):
                put(f"{name}.force.{x}", force[k], "force")
                if kind not in ("S", "Sp", "Sg"):
                    put(f"{name}.moment.{x}", moment[k], "torque")
        kinetic, potential = motion.energies(time, state)
        first = first if "kinetic" in rows else kinetic + potential
        put("kinetic", kinetic, "torque")
        put("potential", potential, "torque")
        put("work", state[-1], "torque")
        put("defect", kinetic + potential - first - state[-1], "torque")
    rows["time"] = [t / float(units.value(units.words["time"])) for t in times]
    return {name: np.array(values) for name, values in rows.items()}


def of(source: Document | Any, **options: Any) -> dict[str, Array]:
    """The rows of a file's response."""
    return prepare(source, **options).run()
