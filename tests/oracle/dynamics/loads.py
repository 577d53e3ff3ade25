"""Loads as forces at mass centres and couples, and what they do to the energy.

`Loads.wrenches` adds to (force, couple) of every link, `Loads.powers` tells the power of all loads
that have no potential, `Loads.potential` the potential energy of gravity and springs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from oracle.dynamics.drawn import Drawn
from oracle.dynamics.laws import Law, Quantity, law
from oracle.dynamics.rows import Array, Posture
from oracle.expressions import Scope


@dataclass
class Place:
    """A posture with everything that a load may read."""

    posture: Posture
    quantity: Quantity
    rows: dict[str, Array]
    """d(coordinate rate)/d(all velocities), by coordinate."""


Wrench = tuple[int, Array, Array]
"""Link, force, couple about its mass centre."""
Apply = Callable[[Place], list[Wrench]]


@dataclass
class Pull:
    """A load; `energy` where it has a potential."""

    apply: Apply
    energy: Callable[[Place], float] | None = None


def pulls(drawn: Drawn, data: dict[str, Any], scope: Scope, run: str | None = None) -> list[Pull]:
    """The loads of a file that act in a run, one after the other."""
    found = []
    for load in data.get("loads", []):
        if "runs" in load and run not in load["runs"]:
            continue
        found.append(_READERS[load["type"]](drawn, data, scope, load))
    return found


def effort(coordinate: str, value: Law) -> Pull:
    """An effort on a coordinate."""

    def apply(place: Place) -> list[Wrench]:
        return _along(place.rows[coordinate], value(place.quantity))

    return Pull(apply)


def _along(row: Array, value: float) -> list[Wrench]:
    by_link = row.reshape(-1, 6)
    return [(k, value * part[:3], value * part[3:]) for k, part in enumerate(by_link) if part.any()]


def _gravity(drawn: Drawn, data: Any, scope: Scope, load: Any) -> Pull:
    g = np.array([float(x) for x in scope.vector(load["g"], "acceleration")])

    def apply(place: Place) -> list[Wrench]:
        return [(k, m * g, np.zeros(3)) for k, m in enumerate(drawn.mass[:-1]) if m]

    return Pull(apply, lambda place: -float(np.sum(drawn.mass * (place.posture.x @ g))))


def _applied(drawn: Drawn, data: Any, scope: Scope, load: Any) -> Pull:
    kind = load["type"]
    if "joint" in load:
        coordinate = f"{load['joint']}.{'s' if kind == 'force' else 'theta'}"
        return effort(coordinate, law(scope, load["value"], kind))
    k = drawn.link(load["link"])
    components = [law(scope, text, kind) for text in load[kind]]
    turns = load.get("axes", "ground") == "link"
    point = np.zeros(3)
    if kind == "force":
        point = (
            np.array([float(x) for x in scope.vector(load["point"], "length")]) - drawn.centre[k]
        )

    def apply(place: Place) -> list[Wrench]:
        R = place.posture.R[k]
        vector = np.array([component(place.quantity) for component in components])
        vector = R @ vector if turns else vector
        if kind == "torque":
            return [(k, np.zeros(3), vector)]
        return [(k, vector, np.cross(R @ point, vector))]

    return Pull(apply)


def _line(drawn: Drawn, data: Any, scope: Scope, load: Any) -> Callable[[Place], Any]:
    """Length, its rate, and what a unit pull does, of the line between two points."""
    ends = []
    for name in load["between"]:
        point = data["points"][name]
        k = drawn.link(point["link"])
        at = np.array([float(x) for x in scope.vector(point["at"], "length")])
        ends.append((k, at - drawn.centre[k]))

    def measure(place: Place) -> Any:
        p = place.posture
        arms = [p.R[k] @ at for k, at in ends]
        (i, a), (j, b) = ((k, arm) for (k, _), arm in zip(ends, arms, strict=True))
        d = p.x[j] + b - p.x[i] - a
        rate = p.v[j] + np.cross(p.w[j], b) - p.v[i] - np.cross(p.w[i], a)
        length = float(np.sqrt(d @ d))
        n = d / length
        return length, float(n @ rate), [(i, n, np.cross(a, n)), (j, -n, np.cross(b, -n))]

    return measure


def _spring(drawn: Drawn, data: Any, scope: Scope, load: Any) -> Pull:
    line = "between" in load
    name = "" if line else f"{load['joint']}.{load['coordinate']}"
    turning = not line and load["coordinate"].startswith("theta")
    units, value = scope.units, scope.scalar
    per = units.of("torque") if turning else units.of("force") / units.of("length")
    k = float(load["stiffness"]) * float(per)
    free = float(value(load.get("free", "0"), "angle" if turning else "length"))
    preload = float(value(load.get("preload", "0"), "torque" if turning else "force"))
    measure = _line(drawn, data, scope, load) if line else None

    def stretch(place: Place) -> float:
        return (measure(place)[0] if measure else place.quantity(name)) - free

    def apply(place: Place) -> list[Wrench]:
        pull = preload + k * stretch(place)
        if measure:
            return [(i, pull * f, pull * c) for i, f, c in measure(place)[2]]
        return _along(place.rows[name], -pull)

    def energy(place: Place) -> float:
        x = stretch(place)
        return preload * x + k * x * x / 2

    return Pull(apply, energy)


def _damper(drawn: Drawn, data: Any, scope: Scope, load: Any) -> Pull:
    line = "between" in load
    name = "" if line else f"{load['joint']}.{load['coordinate']}"
    turning = not line and load["coordinate"].startswith("theta")
    units = scope.units
    per = (
        units.of("torque") / units.value("rad/s")
        if turning
        else units.of("force") / units.of("speed")
    )
    c = float(load["damping"]) * float(per)
    measure = _line(drawn, data, scope, load) if line else None

    def apply(place: Place) -> list[Wrench]:
        if measure:
            _, rate, unit = measure(place)
            return [(i, c * rate * f, c * rate * m) for i, f, m in unit]
        return _along(place.rows[name], -c * place.quantity(f"{name}_dot"))

    return Pull(apply)


_READERS = {
    "gravity": _gravity,
    "force": _applied,
    "torque": _applied,
    "spring": _spring,
    "damper": _damper,
}
