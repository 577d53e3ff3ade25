"""A mechanism in a plane at 50 digits: three coordinates a body, Newton-Euler as a dense system.

Independent of the package: it reads the text of a file in metres, radians, kilograms and newtons,
with numbers alone. Every body has (x, y, phi) from its drawing, every joint the constraints that a
textbook gives it (Nikravesh 1988, chapter 4), and the input one more. Places come from Newton's
method, rates and accelerations from the constraints' derivatives, which are central differences at
50 digits, and forces from

    M a = Q + J^T lambda,

where the multipliers of a joint are what its first link does to its second. With phi counted
counter-clockwise nothing here knows of a third axis.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import yaml
from mpmath import mp

mp.dps = 50
STEP = mp.mpf(10) ** -15
Number = Any
Point = tuple[Number, Number]


def number(text: object) -> Number:
    return mp.mpf(str(text))


def pair(given: Sequence[object]) -> Point:
    return number(given[0]), number(given[1])


def each(given: Any, links: Sequence[str]) -> tuple[Point, Point]:
    """One vector for either link."""
    if isinstance(given, Mapping):
        return pair(given[links[0]]), pair(given[links[1]])
    return pair(given), pair(given)


@dataclass
class Moving:
    """The mechanism at one row: its places q, rates and accelerations, and what the joints do."""

    model: Maximal
    q: list[Number]
    rates: list[Number]
    accelerations: list[Number]
    multipliers: list[Number]
    drive: Number = field(default=0)

    def coordinate(self, name: str, order: int = 0) -> Number:
        """A joint's theta or s, or a derivative of it."""
        return self.along(lambda q: self.model.coordinate(name, q), order)

    def place(self, link: str, at: Point, order: int = 0) -> Point:
        """A point of a link, or a derivative."""
        parts = [self.along(lambda q, k=k: self.model.point(link, at, q)[k], order) for k in (0, 1)]
        return parts[0], parts[1]

    def along(self, function: Callable[[list[Number]], Number], order: int) -> Number:
        """A function of places, or a derivative of it by time along the motion."""
        if order == 0:
            return function(self.q)
        h = STEP if order == 1 else mp.mpf(10) ** -12

        def at(t: Number) -> Number:
            parts = zip(self.q, self.rates, self.accelerations, strict=True)
            return function([x + v * t + a * t * t / 2 for x, v, a in parts])

        if order == 1:
            return (at(h) - at(-h)) / (2 * h)
        return (at(h) - 2 * at(0) + at(-h)) / h**2

    def reaction(self, joint: str) -> tuple[Number, Number, Number]:
        """Force (x, y) of the joint's first link on its second, and its moment about the joint's
        point."""
        kind, rows = self.model.kinds[joint], self.model.rows[joint]
        values = [self.multipliers[k] for k in rows]
        if kind == "P":
            across = self.model.across(joint, self.q)
            return values[0] * across[0], values[0] * across[1], values[1]
        if kind == "Ps":
            across = self.model.across(joint, self.q)
            return values[0] * across[0], values[0] * across[1], mp.mpf(0)
        force = values[0], values[1]
        return (*force, values[2] if kind == "W" else mp.mpf(0))

    @property
    def effort(self) -> Number:
        """Of the input's drive."""
        return self.multipliers[-1]


class Maximal:
    """A file with `plane: xy` whose input is one coordinate."""

    def __init__(self, text: str) -> None:
        data = yaml.safe_load(text)
        assert data["plane"] == "xy"
        self.data = data
        self.links = list(data["links"])
        self.joints = data["joints"]
        self.kinds = {name: joint["type"] for name, joint in self.joints.items()}
        self.rows: dict[str, list[int]] = {}
        count = 0
        for name, kind in self.kinds.items():
            width = {"R": 2, "P": 2, "Ps": 1, "W": 3}[kind]
            self.rows[name] = list(range(count, count + width))
            count += width
        ((self.input, drive),) = data["motion"]["inputs"].items()
        self.rate = number(drive.get("rate", "0 rad/s").split()[0])

    # --- places ---------------------------------------------------------------------------

    def pose(self, link: str, q: Sequence[Number]) -> tuple[Number, Number, Number]:
        if link == "ground":
            return mp.mpf(0), mp.mpf(0), mp.mpf(0)
        k = 3 * self.links.index(link)
        return q[k], q[k + 1], q[k + 2]

    def vector(self, link: str, drawn: Point, q: Sequence[Number]) -> Point:
        phi = self.pose(link, q)[2]
        c, s = mp.cos(phi), mp.sin(phi)
        return c * drawn[0] - s * drawn[1], s * drawn[0] + c * drawn[1]

    def point(self, link: str, drawn: Point, q: Sequence[Number]) -> Point:
        x, y, _ = self.pose(link, q)
        u, v = self.vector(link, drawn, q)
        return x + u, y + v

    def ends(self, name: str, q: Sequence[Number]) -> tuple[Point, Point]:
        joint = self.joints[name]
        one, other = joint["links"]
        at = each(joint.get("point", [0, 0]), joint["links"])
        return self.point(one, at[0], q), self.point(other, at[1], q)

    def slide(self, name: str, q: Sequence[Number]) -> Point:
        """The unit vector along a slide or slot: of P on the first link, of Ps on the second."""
        joint = self.joints[name]
        side = 0 if self.kinds[name] == "P" else 1
        drawn = each(joint["axis" if side == 0 else "slot"], joint["links"])[side]
        size = mp.hypot(*drawn)
        return self.vector(joint["links"][side], (drawn[0] / size, drawn[1] / size), q)

    def across(self, name: str, q: Sequence[Number]) -> Point:
        u, v = self.slide(name, q)
        return -v, u

    def turn(self, name: str, q: Sequence[Number]) -> Number:
        """The angle of the second link against the first; zero where axes per link are in line."""
        joint = self.joints[name]
        one, other = joint["links"]
        zero = mp.mpf(0)
        lines = joint.get("zero") or (joint.get("axis") if self.kinds[name] == "P" else None)
        if isinstance(lines, Mapping):
            first, second = each(lines, joint["links"])
            zero = mp.atan2(second[1], second[0]) - mp.atan2(first[1], first[0])
        return self.pose(other, q)[2] - self.pose(one, q)[2] + zero

    def coordinate(self, name: str, q: Sequence[Number]) -> Number:
        joint, _, coordinate = name.partition(".")
        if coordinate == "theta":
            return self.turn(joint, q)
        one, other = self.ends(joint, q)
        sign = 1 if self.kinds[joint] == "P" else -1
        u, v = self.slide(joint, q)
        return sign * (u * (other[0] - one[0]) + v * (other[1] - one[1]))

    def constraints(self, q: Sequence[Number], value: Number) -> list[Number]:
        found: list[Number] = []
        for name, kind in self.kinds.items():
            one, other = self.ends(name, q)
            apart = other[0] - one[0], other[1] - one[1]
            if kind in ("R", "W"):
                found += apart
            else:
                across = self.across(name, q)
                found.append(across[0] * apart[0] + across[1] * apart[1])
            if kind in ("P", "W"):
                found.append(mp.sin(self.turn(name, q)))
        return [*found, self.coordinate(self.input, q) - value]

    def jacobian(self, q: Sequence[Number], value: Number) -> Any:
        columns = []
        for k in range(len(q)):
            up, down = list(q), list(q)
            up[k], down[k] = up[k] + STEP, down[k] - STEP
            high, low = self.constraints(up, value), self.constraints(down, value)
            columns.append([(a - b) / (2 * STEP) for a, b in zip(high, low, strict=True)])
        return mp.matrix(columns).T

    def closed(self, start: Sequence[float], value: Number) -> list[Number]:
        """The places (x, y, phi of each link) next to a start at a value of the input."""
        q = [number(x) for x in start]
        for _ in range(60):
            off = self.constraints(q, value)
            if max(abs(x) for x in off) < mp.mpf(10) ** -40:
                return q
            step = mp.lu_solve(self.jacobian(q, value), mp.matrix(off))
            q = [a - b for a, b in zip(q, step, strict=True)]
        raise ArithmeticError("not closed")

    # --- motion and forces ----------------------------------------------------------------

    def moving(self, start: Sequence[float], value: Number) -> Moving:
        """Everything at a value of the input, its rate constant; whole turns of it do not count."""
        if self.input.endswith("theta"):
            turns = mp.nint((value - self.coordinate(self.input, list(start))) / (2 * mp.pi))
            value = value - turns * 2 * mp.pi
        q = self.closed(start, value)
        jacobian = self.jacobian(q, value)
        count = len(q)
        driven = mp.matrix([0] * (count - 1) + [self.rate])
        rates = list(mp.lu_solve(jacobian, driven))
        h = mp.mpf(10) ** -12

        def at(t: Number) -> list[Number]:
            moved = [x + v * t for x, v in zip(q, rates, strict=True)]
            return self.constraints(moved, value + self.rate * t)

        middle = at(mp.mpf(0))
        bent = [-(a - 2 * b + c) / h**2 for a, b, c in zip(at(h), middle, at(-h), strict=True)]
        accelerations = list(mp.lu_solve(jacobian, mp.matrix(bent)))
        wanted = self._inertia(q, rates, accelerations) - self._loads(q, rates)
        multipliers = list(mp.lu_solve(jacobian.T, wanted))
        return Moving(self, q, rates, accelerations, multipliers)

    def _inertia(self, q: Sequence[Number], rates: Any, accelerations: Any) -> Any:
        """By virtual work of m a and I alpha at the mass centres."""
        moving = Moving(self, list(q), list(rates), list(accelerations), [])
        found = mp.matrix(len(q), 1)
        for link, section in self.data["links"].items():
            k = 3 * self.links.index(link)
            found[k + 2] += number(section.get("inertia", 0)) * accelerations[k + 2]
            if "mass" in section:
                centre = pair(section["center_of_mass"])
                a = moving.place(link, centre, 2)
                force = number(section["mass"]) * a[0], number(section["mass"]) * a[1]
                self._put(found, link, centre, force, q)
        return found

    def _loads(self, q: Sequence[Number], rates: Sequence[Number]) -> Any:
        found = mp.matrix(len(q), 1)
        moving = Moving(self, list(q), list(rates), [mp.mpf(0)] * len(q), [])
        for load in self.data.get("loads", ()):
            kind = load["type"]
            if kind == "gravity":
                for link, section in self.data["links"].items():
                    if "mass" in section:
                        mass, g = number(section["mass"]), pair(load["g"])
                        force = mass * g[0], mass * g[1]
                        self._put(found, link, pair(section["center_of_mass"]), force, q)
            elif kind == "force" and "link" in load:
                force = pair(load["force"])
                if load.get("axes") == "link":
                    force = self.vector(load["link"], force, q)
                self._put(found, load["link"], pair(load["point"]), force, q)
            elif kind == "torque" and "link" in load:
                found[3 * self.links.index(load["link"]) + 2] += number(load["torque"])
            elif "joint" in load:
                usual = "theta" if kind == "torque" else "s"
                name = f"{load['joint']}.{load.get('coordinate', usual)}"
                self._along(found, name, self._amount(load, name, moving), q)
            else:
                self._between(found, load, moving)
        return found

    @staticmethod
    def _amount(load: Mapping[str, Any], name: str, moving: Moving) -> Number:
        if "value" in load:
            return number(load["value"])
        if load["type"] == "spring":
            stretch = moving.coordinate(name) - number(load.get("free", 0))
            return -number(load.get("preload", 0)) - number(load["stiffness"]) * stretch
        return -number(load["damping"]) * moving.coordinate(name, 1)

    def _along(self, found: Any, name: str, amount: Number, q: Sequence[Number]) -> None:
        """A generalised force on a coordinate."""
        for k in range(len(q)):
            up, down = list(q), list(q)
            up[k], down[k] = up[k] + STEP, down[k] - STEP
            slope = (self.coordinate(name, up) - self.coordinate(name, down)) / (2 * STEP)
            found[k] += amount * slope

    def _between(self, found: Any, load: Mapping[str, Any], moving: Moving) -> None:
        ends = [self.data["points"][name] for name in load["between"]]
        places = [moving.place(end["link"], pair(end["at"])) for end in ends]
        span = places[1][0] - places[0][0], places[1][1] - places[0][1]
        length = mp.hypot(*span)
        if load["type"] == "spring":
            pull = number(load.get("preload", 0))
            pull += number(load["stiffness"]) * (length - number(load["free"]))
        else:
            speeds = [moving.place(end["link"], pair(end["at"]), 1) for end in ends]
            closing = sum(span[k] * (speeds[1][k] - speeds[0][k]) for k in (0, 1)) / length
            pull = number(load["damping"]) * closing
        for end, sign in zip(ends, (1, -1), strict=True):
            force = sign * pull * span[0] / length, sign * pull * span[1] / length
            self._put(found, end["link"], pair(end["at"]), force, moving.q)

    def _put(self, found: Any, link: str, drawn: Point, force: Point, q: Sequence[Number]) -> None:
        """A force at a point of a link."""
        if link == "ground":
            return
        k = 3 * self.links.index(link)
        arm = self.vector(link, drawn, q)
        found[k] += force[0]
        found[k + 1] += force[1]
        found[k + 2] += arm[0] * force[1] - arm[1] * force[0]
