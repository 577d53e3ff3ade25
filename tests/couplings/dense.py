"""Mechanisms with couplings in absolute coordinates: Newton-Euler as a dense system with
Lagrange multipliers.

Independent of the package: it reads the dictionary of a file in metres, radians, kilograms and
newtons, with numbers alone. Every body has a mass centre and an orientation, every joint the
conditions that a textbook gives it (Nikravesh 1988, chapters 6 and 7), every coupling one more
between turns and slides. What stands in them is a number or a vector with its rate and its
acceleration, linear in the bodies' accelerations, so that products follow by the product rule.

    M a + b = Q + J^T lambda,   J a + gamma = 0,

solved together, by least squares where conditions repeat. What a multiplier does is told as a
wrench: of a joint what its first link does to its second, about the origin; of teeth a force at the
pitch point. In a plane bodies keep three of six coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Floats = NDArray[np.float64]
Data = Mapping[str, Any]


def turned(vector: Floats) -> Floats:
    """The rotation (3, 3) about a vector by its length."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def skew(v: Floats) -> Floats:
    """The matrix of the product v x."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def square_to(axis: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors square to a unit vector and to each other."""
    one = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    one /= np.linalg.norm(one)
    return one, np.cross(axis, one)


@dataclass
class Timed:
    """A number () or vector (3,): its value, its rate, and its acceleration `by @ a + rest`."""

    value: Any
    rate: Any
    by: Floats
    rest: Any

    def __sub__(self, other: Timed) -> Timed:
        return Timed(
            self.value - other.value,
            self.rate - other.rate,
            self.by - other.by,
            self.rest - other.rest,
        )

    def __add__(self, other: Timed) -> Timed:
        return self - other.times(-1.0)

    def times(self, factor: float) -> Timed:
        return Timed(factor * self.value, factor * self.rate, factor * self.by, factor * self.rest)

    def dot(self, other: Timed) -> Timed:
        return Timed(
            self.value @ other.value,
            self.value @ other.rate + self.rate @ other.value,
            self.value @ other.by + other.value @ self.by,
            self.value @ other.rest + self.rest @ other.value + 2 * self.rate @ other.rate,
        )


@dataclass
class State:
    """Mass centres (bodies, 3), orientations (bodies, 3, 3), rates (6 bodies,) as velocity and
    spin of each, and the turns of joints, by name."""

    centres: Floats
    turns: Floats
    rates: Floats
    angles: dict[str, float]


@dataclass
class Solved:
    """Accelerations (6 bodies,), multipliers by the owner's name, and what was asked: rates and
    accelerations of the coordinates, wrenches and efforts."""

    accelerations: Floats
    coordinates: dict[str, tuple[float, float, float]]
    wrenches: dict[str, Floats]
    efforts: dict[str, float]
    teeth: dict[str, Floats]
    condition: float


class Unclosed(Exception):
    """No place was found next to the one before."""


class Dense:
    """A file of joints R, P, C and S with couplings linear, gear and rack."""

    def __init__(self, data: Data) -> None:
        self.data = data
        self.flat = "plane" in data
        self.links: list[str] = list(data["links"])
        self.joints: Data = data["joints"]
        self.width = 6 * len(self.links)
        kept = [0, 1, 5] if self.flat else list(range(6))
        self.kept = [6 * k + i for k in range(len(self.links)) for i in kept]
        bodies = [data["links"][name] for name in self.links]
        self.home = np.array([self.lifted(body["center_of_mass"]) for body in bodies])
        self.masses = np.array([body["mass"] for body in bodies])
        self.inertias = np.array([self.inertia(body["inertia"]) for body in bodies])
        self.gravity = np.zeros(3)
        for load in data.get("loads", []):
            if load["type"] == "gravity":
                self.gravity = self.lifted(load["g"])

    def lifted(self, given: Sequence[float]) -> Floats:
        """A vector of the plane in space."""
        return np.array([*given, 0.0] if len(given) == 2 else given, dtype=float)

    def inertia(self, given: Any) -> Floats:
        if not isinstance(given, Mapping):
            return np.diag([1.0, 1.0, given])
        return np.diag([given["xx"], given["yy"], given["zz"]])

    def at_home(self) -> State:
        """As drawn, at rest."""
        turns = np.array([np.eye(3)] * len(self.links))
        angles = dict.fromkeys(self.joints, 0.0)
        return State(self.home.copy(), turns, np.zeros(self.width), angles)

    # --- what stands in conditions ----------------------------------------------------------

    def fixed(self, vector: Floats) -> Timed:
        return Timed(vector, np.zeros(3), np.zeros((3, self.width)), np.zeros(3))

    def spin(self, link: str, state: State) -> Timed:
        """The spin of a link as a rate: its value is not used."""
        by = np.zeros((3, self.width))
        if link == "ground":
            return Timed(np.zeros(3), np.zeros(3), by, np.zeros(3))
        k = self.links.index(link)
        by[:, 6 * k + 3 : 6 * k + 6] = np.eye(3)
        return Timed(np.zeros(3), state.rates[6 * k + 3 : 6 * k + 6], by, np.zeros(3))

    def direction(self, link: str, drawn: Floats, state: State) -> Timed:
        """A vector that is fixed in a link."""
        if link == "ground":
            return self.fixed(drawn)
        k = self.links.index(link)
        now, spin = state.turns[k] @ drawn, state.rates[6 * k + 3 : 6 * k + 6]
        by = np.zeros((3, self.width))
        by[:, 6 * k + 3 : 6 * k + 6] = -skew(now)
        rate = np.cross(spin, now)
        return Timed(now, rate, by, np.cross(spin, rate))

    def point(self, link: str, drawn: Floats, state: State) -> Timed:
        """A point that is fixed in a link."""
        if link == "ground":
            return self.fixed(drawn)
        k = self.links.index(link)
        arm = self.direction(link, drawn - self.home[k], state)
        arm.by[:, 6 * k : 6 * k + 3] = np.eye(3)
        return Timed(
            state.centres[k] + arm.value,
            state.rates[6 * k : 6 * k + 3] + arm.rate,
            arm.by,
            arm.rest,
        )

    def axis(self, name: str) -> Floats:
        given = self.joints[name].get("axis", [0.0, 0.0, 1.0])
        axis = self.lifted(given)
        return axis / np.linalg.norm(axis)

    def coordinate(self, name: str, state: State) -> Timed:
        """A joint's turn or slide, measured at its second link from its first."""
        joint, _, word = name.partition(".")
        one, other = self.joints[joint]["links"]
        axis = self.direction(one, self.axis(joint), state)
        if word == "s":
            at = self.lifted(self.joints[joint]["point"])
            return axis.dot(self.point(other, at, state) - self.point(one, at, state))
        spin = self.spin(other, state) - self.spin(one, state)
        return Timed(
            state.angles[joint],
            axis.value @ spin.rate,
            axis.value @ spin.by,
            axis.rate @ spin.rate,
        )

    def angle(self, joint: str, state: State) -> float:
        """The turn of a joint as it is seen, next to the known one."""
        one, other = self.joints[joint]["links"]
        axis = self.axis(joint)
        mark = square_to(axis)[0]
        first, second = (self.direction(link, mark, state).value for link in (one, other))
        about = self.direction(one, axis, state).value
        seen = float(np.arctan2(np.cross(first, second) @ about, first @ second))
        known = state.angles[joint]
        return known + (seen - known + np.pi) % (2 * np.pi) - np.pi

    def held(self, name: str, state: State) -> list[Timed]:
        """What a joint keeps zero."""
        joint = self.joints[name]
        one, other = joint["links"]
        kind, drawn = joint["type"], self.lifted(joint["point"])
        apart = self.point(other, drawn, state) - self.point(one, drawn, state)
        found: list[Timed] = []
        marks = [self.fixed(v) for v in np.eye(3)]
        axis = self.axis(name)
        if kind in ("R", "S"):
            found += [mark.dot(apart) for mark in marks[: 2 if self.flat else 3]]
        if kind in ("P", "C"):
            across = [np.cross([0.0, 0.0, 1.0], axis)] if self.flat else square_to(axis)
            found += [self.direction(one, v, state).dot(apart) for v in across]
        if kind in ("R", "C", "P") and not self.flat:
            about = self.direction(one, axis, state)
            found += [about.dot(self.direction(other, v, state)) for v in square_to(axis)]
        if kind == "P":
            u, v = (axis, np.cross([0.0, 0.0, 1.0], axis)) if self.flat else square_to(axis)
            found.append(self.direction(one, u, state).dot(self.direction(other, v, state)))
        return found

    # --- couplings -------------------------------------------------------------------------

    def terms(self, name: str) -> dict[str, float]:
        """Coordinates and their factors; their sum is zero."""
        given = self.data["couplings"][name]
        if given["type"] == "linear":
            return {coordinate: float(factor) for coordinate, factor in given["terms"].items()}
        one, other = given["joints"]
        carrier = self.carrier(one, other)
        first = self.against(one, carrier)
        if given["type"] == "rack":
            sense, slide = self.sense(one, carrier), self.sense(other, carrier)
            lever = np.cross(self.axis(one), self.place(other) - self.place(one))
            side = np.sign(lever @ self.axis(other))
            # s = r phi, where the rim at the rack moves along its axis
            return {f"{one}.theta": sense, f"{other}.s": -slide * side / given["radius"]}
        n, m = given["teeth"]
        ratio = m / n * (-1.0 if given.get("internal") else 1.0)
        second = self.against(other, carrier)
        ratio *= np.sign(self.axis(one) @ self.axis(other))
        found = dict(first)
        for coordinate, factor in second.items():
            found[coordinate] = found.get(coordinate, 0.0) + ratio * factor
        return found

    def place(self, joint: str) -> Floats:
        return self.lifted(self.joints[joint]["point"])

    def sense(self, joint: str, carrier: str) -> float:
        return 1.0 if self.joints[joint]["links"][0] == carrier else -1.0

    def carrier(self, one: str, other: str) -> str:
        """The link that both joints are on; else one of the links of either that a joint about the
        other's axis joins to a link of the other."""
        shared = set(self.joints[one]["links"]) & set(self.joints[other]["links"])
        if shared:
            return str(next(link for link in self.joints[one]["links"] if link in shared))
        for near, far in ((one, other), (other, one)):
            for link in self.joints[far]["links"]:
                if self.between(near, link) is not None:
                    return str(link)
        raise ValueError(one)

    def between(self, joint: str, carrier: str) -> tuple[str, str] | None:
        """A joint about a joint's axis that leads from one of its links to a carrier, and that
        link."""
        base = self.joints[joint]["links"]
        for name, given in self.joints.items():
            ends = given["links"]
            if given["type"] != "R" or carrier not in ends or not set(ends) & set(base):
                continue
            apart = np.cross(self.axis(name), self.place(name) - self.place(joint))
            aslant = np.cross(self.axis(name), self.axis(joint))
            if name != joint and np.linalg.norm(apart) < 1e-6 and np.linalg.norm(aslant) < 1e-6:
                return name, str(next(link for link in ends if link in base))
        return None

    def against(self, joint: str, carrier: str) -> dict[str, float]:
        """The turn of a wheel against the carrier, about its joint's axis as drawn."""
        base = self.joints[joint]["links"]
        if carrier in base:
            return {f"{joint}.theta": self.sense(joint, carrier)}
        name, link = self.between(joint, carrier) or ("", "")
        own = 1.0 if base[0] == link else -1.0
        way = np.sign(self.axis(name) @ self.axis(joint)) * self.sense(name, carrier)
        return {f"{joint}.theta": own, f"{name}.theta": float(way)}

    def wheel(self, joint: str, carrier: str) -> str:
        """The link of a wheel."""
        one, other = self.joints[joint]["links"]
        if carrier in (one, other):
            return str(other if one == carrier else one)
        base = (self.between(joint, carrier) or ("", ""))[1]
        return str(other if one == base else one)

    def teeth(self, name: str, state: State) -> tuple[str, str, Floats, Floats, Floats] | None:
        """The links of both wheels, the pitch point, and per unit moment on the first wheel the
        force on the second along the flank, and apart; None for an ideal coupling."""
        given = self.data["couplings"][name]
        if given["type"] == "linear" or given.get("ideal"):
            return None
        one, other = given["joints"]
        carrier = self.carrier(one, other)
        axis, apart = self.axis(one), self.place(other) - self.place(one)
        inside = bool(given.get("internal"))
        if given["type"] == "rack":
            along = self.axis(other)
            outward = np.cross(along, axis)
            outward *= np.sign(outward @ apart)
            radius = given["radius"]
            push = outward
        else:
            apart = apart - apart @ axis * axis
            n, m = given["teeth"]
            distance = float(np.linalg.norm(apart))
            # of a ring and its pinion the axes are |r - r'| apart
            radius = distance * n / (abs(n - m) if inside else n + m)
            outward = apart / distance
            if inside and n < m:  # the first is the pinion, and touches away from the ring's axis
                outward = -outward
            push = -outward if inside and n > m else outward
        helix, pressure = given.get("helix", 0.0), given.get("pressure_angle", 0.0)
        # the moment of -F about the first axis is 1; a right-hand thread rises along the axis as it
        # goes round in the negative sense of what it pushes
        force = -np.cross(axis, outward) / radius + np.tan(helix) / radius * axis
        away = push * np.tan(pressure) / np.cos(helix) / radius
        point = self.place(one) + radius * outward
        lead = [self.direction(carrier, v, state).value for v in (force, away)]
        second = self.wheel(other, carrier)
        where = self.point(carrier, point, state).value
        return self.wheel(one, carrier), second, where, lead[0], lead[1]

    # --- forces -----------------------------------------------------------------------------

    def pushed(self, link: str, force: Floats, at: Floats, state: State) -> Floats:
        """The bodies' forces (6 bodies,) where a force acts on a link at a place."""
        found = np.zeros(self.width)
        if link != "ground":
            k = self.links.index(link)
            found[6 * k : 6 * k + 3] = force
            found[6 * k + 3 : 6 * k + 6] = np.cross(at - state.centres[k], force)
        return found

    def applied(self, state: State, efforts: Mapping[str, float]) -> tuple[Floats, Floats]:
        """Mass matrix and what acts on the bodies without multipliers."""
        mass, forces = np.zeros((self.width, self.width)), np.zeros(self.width)
        for k in range(len(self.links)):
            place, turn = slice(6 * k, 6 * k + 3), slice(6 * k + 3, 6 * k + 6)
            rotation = state.turns[k]
            inertia = rotation @ self.inertias[k] @ rotation.T
            mass[place, place] = self.masses[k] * np.eye(3)
            mass[turn, turn] = inertia
            spin = state.rates[turn]
            forces[place] += self.masses[k] * self.gravity
            forces[turn] -= np.cross(spin, inertia @ spin)
        for load in self.data.get("loads", []):
            if load["type"] == "torque":
                k = self.links.index(load["link"])
                given = load["torque"]
                torque = given if isinstance(given, list) else [0.0, 0.0, given]
                forces[6 * k + 3 : 6 * k + 6] += torque
            elif load["type"] == "damper":
                along = self.coordinate(load["joint"] + "." + load["coordinate"], state)
                forces -= load["damping"] * along.rate * along.by
        for name, effort in efforts.items():
            forces += effort * self.coordinate(name, state).by
        return mass, forces

    def conditions(self, state: State) -> tuple[list[Timed], list[str]]:
        """All conditions of joints and couplings, with the names of their owners."""
        found, owners = [], []
        for name in self.joints:
            own = self.held(name, state)
            found += own
            owners += [name] * len(own)
        for name in self.data.get("couplings", {}):
            parts = [
                self.coordinate(coordinate, state).times(factor)
                for coordinate, factor in self.terms(name).items()
            ]
            total = parts[0]
            for part in parts[1:]:
                total = total + part
            found.append(total)
            owners.append(name)
        return found, owners

    def solved(
        self,
        state: State,
        efforts: Mapping[str, float],
        driven: Mapping[str, float] | None = None,
        full: bool = True,
    ) -> Solved:
        """The accelerations under given efforts, with those of `driven` coordinates given."""
        conditions, owners = self.conditions(state)
        driven = driven or {}
        named = [self.coordinate(name, state) for name in driven]
        jacobian = np.array([c.by for c in (*conditions, *named)])
        rest = [c.rest for c in conditions]
        rest += [c.rest - driven[name] for c, name in zip(named, driven, strict=True)]
        mass, forces = self.applied(state, efforts)
        act = jacobian.T.copy()  # how multipliers push bodies
        meshes = {}
        for row, owner in enumerate(owners):
            if owner not in self.data.get("couplings", {}):
                continue
            mesh = self.teeth(owner, state)
            meshes[owner] = mesh
            if mesh is None:
                continue
            # the multiplier is the moment on the first wheel by its turn in the terms
            first, second, at, along, _ = mesh
            act[:, row] = self.pushed(second, along, at, state)
            act[:, row] += self.pushed(first, -along, at, state)
        keep = self.kept
        n, m = len(keep), len(jacobian)
        matrix = np.zeros((n + m, n + m))
        matrix[:n, :n] = mass[np.ix_(keep, keep)]
        matrix[:n, n:] = -act[keep]
        matrix[n:, :n] = jacobian[:, keep]
        right = np.concatenate([forces[keep], -np.array(rest)])
        found = np.linalg.lstsq(matrix, right, rcond=1e-13)[0]
        # what pushes wheels apart does no work: the moments are known without it
        apart = np.zeros(self.width)
        moments = {o: found[n + k] for k, o in enumerate(owners) if o in meshes}
        for owner, mesh in meshes.items():
            if mesh is not None:
                first, second, at, _, away = mesh
                size = abs(moments[owner])
                apart += self.pushed(second, size * away, at, state)
                apart -= self.pushed(first, size * away, at, state)
        if np.any(apart):
            right[:n] += apart[keep]
            found = np.linalg.lstsq(matrix, right, rcond=1e-13)[0]
        accelerations = np.zeros(self.width)
        accelerations[keep] = found[:n]
        if not full:
            return Solved(accelerations, {}, {}, {}, {}, 0.0)
        wrenches = {name: np.zeros(6) for name in self.joints}
        teeth: dict[str, Floats] = {}
        for row, owner in enumerate(owners):
            value = found[n + row]
            if owner in wrenches:
                wrenches[owner] += value * self.wrench(owner, act[:, row], state)
            else:
                mesh = meshes[owner]
                wrenches[owner] = np.array([value])
                if mesh is not None:
                    teeth[owner] = value * mesh[3] + abs(value) * mesh[4]
        values = dict(zip(driven, found[n + len(owners) :], strict=True))
        coordinates = {}
        for name in self.names():
            c = self.coordinate(name, state)
            coordinates[name] = (
                float(c.value),
                float(c.rate),
                float(c.by @ accelerations + c.rest),
            )
        condition = float(np.linalg.cond(jacobian[:, keep]))
        return Solved(accelerations, coordinates, wrenches, values, teeth, condition)

    def wrench(self, joint: str, forces: Floats, state: State) -> Floats:
        """Force and moment about the origin on a joint's second link, of what acts on both."""
        one, other = self.joints[joint]["links"]
        link, sign = (other, 1.0) if other != "ground" else (one, -1.0)
        k = self.links.index(link)
        force, couple = forces[6 * k : 6 * k + 3], forces[6 * k + 3 : 6 * k + 6]
        return sign * np.concatenate([force, couple + np.cross(state.centres[k], force)])

    def names(self) -> list[str]:
        """The coordinates that have a name."""
        words = {"R": ["theta"], "P": ["s"], "C": ["theta", "s"], "S": []}
        return [
            f"{joint}.{word}"
            for joint, given in self.joints.items()
            for word in words[given["type"]]
        ]

    # --- motions ----------------------------------------------------------------------------

    def moved(self, state: State, by: Floats) -> State:
        """The state a small step along."""
        angles = dict(state.angles)
        for name in self.names():
            joint, _, word = name.partition(".")
            if word == "theta":
                angles[joint] += float(self.coordinate(name, state).by @ by)
        turns = np.array(
            [turned(by[6 * k + 3 : 6 * k + 6]) @ turn for k, turn in enumerate(state.turns)]
        )
        return State(state.centres + by.reshape(-1, 6)[:, :3], turns, state.rates, angles)

    def closed(self, state: State, driven: Mapping[str, float]) -> State:
        """The place next to a state at some values of coordinates, by Newton's method."""
        for _ in range(40):
            for name in self.names():
                joint, _, word = name.partition(".")
                if word == "theta":
                    state.angles[joint] = self.angle(joint, state)
            conditions, _ = self.conditions(state)
            named = [self.coordinate(name, state) for name in driven]
            off = [c.value for c in conditions]
            off += [c.value - driven[name] for c, name in zip(named, driven, strict=True)]
            if max(abs(x) for x in off) < 1e-14:
                break
            jacobian = np.array([c.by for c in (*conditions, *named)])[:, self.kept]
            step = np.zeros(self.width)
            step[self.kept] = -np.linalg.lstsq(jacobian, np.array(off), rcond=1e-12)[0]
            state = self.moved(state, step)
            if np.max(np.abs(step)) < 1e-16:
                break
        else:
            raise Unclosed
        return state

    def with_rates(self, state: State, driven: Mapping[str, float]) -> State:
        """The state with the rates that those of some coordinates give."""
        conditions, _ = self.conditions(state)
        named = [self.coordinate(name, state) for name in driven]
        jacobian = np.array([c.by for c in (*conditions, *named)])[:, self.kept]
        right = np.array([*np.zeros(len(conditions)), *driven.values()])
        rates = np.zeros(self.width)
        rates[self.kept] = np.linalg.lstsq(jacobian, right, rcond=1e-12)[0]
        return State(state.centres, state.turns, rates, state.angles)

    def freedoms(self, state: State) -> int:
        """How many the conditions leave, to first order."""
        jacobian = np.array([c.by for c in self.conditions(state)[0]])[:, self.kept]
        return len(self.kept) - int(np.linalg.matrix_rank(jacobian, tol=1e-9))

    def condition(self, state: State, driven: Sequence[str]) -> float:
        """The condition number of all conditions with those coordinates driven."""
        conditions, _ = self.conditions(state)
        named = [self.coordinate(name, state) for name in driven]
        values = np.array([c.by for c in (*conditions, *named)])[:, self.kept]
        if values.shape[0] < values.shape[1]:
            return np.inf
        return float(np.linalg.cond(values))

    def swept(
        self, laws: Mapping[str, tuple[float, float, float, float]], rows: int
    ) -> list[Solved]:
        """The rows of a sweep: from and to, rate and acceleration of each input."""
        state, found = self.at_home(), []
        rates = {name: law[2] for name, law in laws.items()}
        accelerations = {name: law[3] for name, law in laws.items()}
        before = dict.fromkeys(laws, 0.0)
        for row in range(rows):
            share = row / (rows - 1)
            values = {name: law[0] + share * (law[1] - law[0]) for name, law in laws.items()}
            steps = 16  # or Newton's method may jump past a dead centre
            for k in range(1, steps + 1):
                between = {n: before[n] + k / steps * (values[n] - before[n]) for n in laws}
                state = self.closed(state, between)
            before = values
            moving = self.with_rates(state, rates)
            found.append(self.solved(moving, {}, accelerations))
        return found

    def responded(
        self, rates: Mapping[str, float], efforts: Mapping[str, float], times: Sequence[float]
    ) -> list[Solved]:
        """The rows of a response from home with given rates."""
        start = self.with_rates(self.at_home(), rates)
        return [self.solved(state, efforts) for state in self.followed(start, efforts, times)]

    def followed(
        self,
        start: State,
        efforts: Mapping[str, float],
        times: Sequence[float],
        until: Callable[[State], float] | None = None,
    ) -> list[State]:
        """The states at some times of a motion that begins at the first of them; with `until`, up
        to where that becomes zero from below, the last state being that."""
        joints = [name.partition(".")[0] for name in self.names() if name.endswith(".theta")]
        count = len(self.links)

        def packed(state: State) -> Floats:
            angles = [state.angles[joint] for joint in joints]
            parts = (state.centres.ravel(), state.turns.ravel(), state.rates, angles)
            return np.concatenate(parts)

        def unpacked(y: Floats) -> State:
            turns = y[3 * count : 12 * count].reshape(count, 3, 3)
            angles = dict.fromkeys(self.joints, 0.0)
            angles |= dict(zip(joints, y[18 * count :].tolist(), strict=True))
            centres = y[: 3 * count].reshape(count, 3)
            return State(centres, turns, y[12 * count : 18 * count], angles)

        def slope(_: float, y: Floats) -> Floats:
            state = unpacked(y)
            rates = state.rates.reshape(count, 6)
            turning = np.array([skew(w[3:]) @ t for w, t in zip(rates, state.turns, strict=True)])
            angles = [self.coordinate(f"{joint}.theta", state).rate for joint in joints]
            found = self.solved(state, efforts, full=False).accelerations
            return np.concatenate([rates[:, :3].ravel(), turning.ravel(), found, angles])

        def end(_: float, y: Floats) -> float:
            return -1.0 if until is None else until(unpacked(y))

        end.terminal, end.direction = True, 1.0  # type: ignore[attr-defined]
        span = (times[0], times[-1])
        answer = solve_ivp(
            slope, span, packed(start), "DOP853", times, events=end, rtol=1e-12, atol=1e-13
        )
        assert answer.success
        self.ended = float(answer.t_events[0][0]) if answer.t_events[0].size else None
        return [unpacked(y) for y in (*answer.y.T, *answer.y_events[0][:1])]
