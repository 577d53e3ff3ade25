"""Random loops of pairs that may leave links idle, with kinematics of their own.

A crank drives a loop of R, P, C, S, E, U, Sp, Sg pairs whose axes are often parallel, in line, or
through one another's centres. The kinematics are a product of exponentials with balls as rotation
matrices, closed by Gauss and Newton's method with the pseudoinverse, which needs no idle freedom to
be held. Which freedoms are idle is read off null spaces at random configurations: rates of the
joints around some neighbouring links with which these move as one body and all others rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
BALL = "ball"
CLEAR = 1e-7
"""Singular values below are zero, all others are well above."""


@dataclass(frozen=True)
class Pair:
    """A pair in the loop, from one link on to the next; `back`: drawn from the next one."""

    kind: str
    point: Floats
    axis: Floats
    other: Floats
    back: bool

    def steps(self) -> list[tuple[str, Floats]]:
        """Turns, slides and balls from its first link to its second, with what each is about."""
        x, y = self.other, np.cross(self.axis, self.other)
        found: dict[str, list[tuple[str, Floats]]] = {
            "R": [("turn", self.axis)],
            "P": [("slide", self.axis)],
            "C": [("turn", self.axis), ("slide", self.axis)],
            "S": [(BALL, self.axis)],
            "U": [("turn", self.axis), ("turn", x)],
            "E": [("slide", x), ("slide", y), ("turn", self.axis)],
            "Sp": [(BALL, self.axis), ("slide", x), ("slide", y)],
            "Sg": [(BALL, self.axis), ("slide", -self.axis)],
        }
        return found[self.kind]

    def names(self) -> list[str]:
        """The coordinate of each freedom, empty where it has none."""
        return {
            "R": ["theta"],
            "P": ["s"],
            "C": ["theta", "s"],
            "S": [""] * 3,
            "U": ["theta1", "theta2"],
            "E": ["x", "y", "theta"],
            "Sp": [""] * 5,
            "Sg": ["", "", "", "s"],
        }[self.kind]

    def text(self, name: str, links: tuple[str, str]) -> str:
        one, two = reversed(links) if self.back else links
        keys = {"E": "normal", "Sp": "normal", "Sg": "groove"}
        more = "" if self.kind == "S" else f", {keys.get(self.kind, 'axis')}: {listed(self.axis)}"
        more += f", x: {listed(self.other)}" if self.kind == "E" else ""
        more += f", axis2: {listed(self.other)}" if self.kind == "U" else ""
        where = f"point: {listed(self.point)}"
        return f"  {name}: {{type: {self.kind}, links: [{one}, {two}], {where}{more}}}"


def listed(vector: Floats) -> str:
    return "[" + ", ".join(repr(float(c)) for c in vector) + "]"


def unit(rng: Random) -> Floats:
    vector = np.array([rng.gauss(0, 1) for _ in range(3)])
    return vector / np.linalg.norm(vector)


def random_loop(rng: Random, kinds: tuple[str, ...]) -> list[Pair]:
    """Pairs of some kinds, each often in line with the one before it."""
    pairs: list[Pair] = []
    for kind in kinds:
        axis = unit(rng)
        point = np.array([rng.uniform(-1, 1) for _ in range(3)])
        if pairs:
            before = pairs[-1]
            if rng.random() < 0.5:
                axis = before.axis
            elif rng.random() < 0.3:
                axis = before.other
            if rng.random() < 0.25:
                point = before.point
            elif rng.random() < 0.4:
                along = axis if rng.random() < 0.5 else before.axis
                point = before.point + rng.uniform(-0.8, 0.8) * along
        other = np.cross(axis, unit(rng))
        other /= np.linalg.norm(other)
        pairs.append(Pair(kind, point, axis, other, rng.random() < 0.5))
    return pairs


def written(pairs: list[Pair], travel: float, rows: int, order: list[int] | None = None) -> str:
    """The loop as a file; its first pair is driven."""
    count = len(pairs)
    links = ["ground", *(f"L{k}" for k in range(1, count)), "ground"]
    lines = [pair.text(f"J{k}", (links[k], links[k + 1])) for k, pair in enumerate(pairs)]
    order = order or list(range(count))
    sweep = f"{{from: 0, to: {travel!r}, count: {rows}, rate: 1}}"
    named = [f"L{k}" for k in order if k]
    return (
        "format: 1\nunits: {length: m, angle: rad}\n"
        f"links: {{{', '.join(f'{name}: {{}}' for name in named)}}}\njoints:\n"
        + "\n".join(lines[k] for k in order)
        + f"\nmotion: {{inputs: {{J0.theta: {sweep}}}}}\n"
    )


def skew(a: Floats) -> Floats:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]], dtype=float)


def turned(vector: Floats) -> Floats:
    """The rotation matrix of a rotation vector (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    k = skew(vector / angle)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


class Loop:
    """The kinematics of a loop; a state is a list of numbers and rotation matrices."""

    def __init__(self, pairs: list[Pair]) -> None:
        self.pairs = pairs
        self.steps: list[tuple[str, Floats, Floats, float]] = []
        self.columns: list[list[int]] = []
        self.names: list[str] = []
        count = 0
        for k, pair in enumerate(pairs):
            steps = [(kind, about, pair.point, 1.0) for kind, about in pair.steps()]
            if pair.back:
                steps = [(kind, about, at, -1.0) for kind, about, at, _ in reversed(steps)]
            self.steps += steps
            free = sum(3 if kind == BALL else 1 for kind, *_ in steps)
            names = [f"J{k}.{name}" if name else "" for name in pair.names()]
            self.names += list(reversed(names)) if pair.back else names
            self.columns.append(list(range(count, count + free)))
            count += free
        self.count = count

    def start(self) -> list[Floats | float]:
        return [np.eye(3) if kind == BALL else 0.0 for kind, *_ in self.steps]

    def moved(self, state: list[Floats | float], rates: Floats) -> list[Floats | float]:
        found: list[Floats | float] = []
        at = 0
        for (kind, *_), value in zip(self.steps, state, strict=True):
            if kind == BALL:
                found.append(turned(rates[at : at + 3]) @ value)
                at += 3
            else:
                found.append(value + rates[at])  # type: ignore[operator]
                at += 1
        return found

    def values(self, state: list[Floats | float]) -> dict[str, float]:
        """The coordinates by name."""
        flat: list[float] = []
        for (kind, *_), value in zip(self.steps, state, strict=True):
            flat += [0.0] * 3 if kind == BALL else [float(value)]  # type: ignore[arg-type]
        return {name: value for name, value in zip(self.names, flat, strict=True) if name}

    def screws(self, state: list[Floats | float]) -> tuple[Floats, Floats, Floats]:
        """All joint screws (6, freedoms) about the ground's origin, and the pose behind the last
        pair, which is that of the ground where the loop is closed."""
        rotation, shift = np.eye(3), np.zeros(3)
        found = []
        for (kind, about, at, sign), value in zip(self.steps, state, strict=True):
            place = rotation @ at + shift
            if kind == BALL:
                # a ball's rates are about axes of the link before it
                for axis in rotation.T:
                    found.append(np.concatenate([axis, np.cross(place, axis)]))
                own = value
            elif kind == "slide":
                axis = sign * (rotation @ about)
                found.append(np.concatenate([np.zeros(3), axis]))
                shift = shift + value * axis
                continue
            else:
                axis = sign * (rotation @ about)
                found.append(np.concatenate([axis, np.cross(place, axis)]))
                own = turned(sign * value * about)
            rotation = rotation @ own
            shift = place - rotation @ at
        return np.array(found).T, rotation, shift

    def miss(self, rotation: Floats, shift: Floats) -> Floats:
        """How far the loop is from closed, as a small twist."""
        part = (rotation - rotation.T) / 2
        return np.concatenate([[part[2, 1], part[0, 2], part[1, 0]], shift])

    def closed(
        self, state: list[Floats | float], still: tuple[int, ...] = ()
    ) -> list[Floats | float] | None:
        """The nearest closed state, with some freedoms at rest."""
        free = [k for k in range(self.count) if k not in still]
        for _ in range(40):
            screws, rotation, shift = self.screws(state)
            error = self.miss(rotation, shift)
            if np.abs(error).max() < 1e-13:
                return state if np.trace(rotation) > 2.9 else None
            rates = np.zeros(self.count)
            rates[free] = -np.linalg.pinv(screws[:, free], rcond=1e-6) @ error
            if np.abs(rates).max() > 0.5:
                rates *= 0.5 / np.abs(rates).max()
            state = self.moved(state, rates)
        return None

    def null(self, matrix: Floats) -> Floats:
        _, values, right = np.linalg.svd(matrix)
        return right[int(np.count_nonzero(values > CLEAR)) :].T

    def idle(self, state: list[Floats | float]) -> Floats:
        """An orthonormal basis (freedoms, count) of the idle motions: up to three neighbouring
        links move as one body, all others and the driven pair rest."""
        screws = self.screws(state)[0]
        found = np.zeros((self.count, 0))
        count = len(self.pairs)
        for first in range(2, count):  # the crank's own pair is driven
            for last in range(first, min(first + 3, count)):
                # links `first` to `last` stand between pairs first - 1 and last
                moving = self.columns[first - 1] + self.columns[last]
                own = self.null(screws[:, moving])
                motions = np.zeros((self.count, own.shape[1]))
                motions[moving] = own
                found = np.concatenate([found, motions], axis=1)
        left, values, _ = np.linalg.svd(found)
        return left[:, : int(np.count_nonzero(values > CLEAR))]

    def undriven(self, state: list[Floats | float]) -> Floats:
        """A basis of all motions that leave the driven pair at rest."""
        own = self.null(self.screws(state)[0][:, 1:])
        return np.concatenate([np.zeros((1, own.shape[1])), own])

    def wander(self, rng: Random, state: list[Floats | float]) -> list[Floats | float] | None:
        """Another closed state, some steps along random motions away."""
        for _ in range(4):
            motions = self.null(self.screws(state)[0])
            rates = motions @ np.array([rng.gauss(0, 1) for _ in range(motions.shape[1])])
            moved = self.closed(self.moved(state, 0.12 * rates / (np.linalg.norm(rates) or 1.0)))
            if moved is None:
                return None
            state = moved
        return state


class Told(NamedTuple):
    """What is known of a loop: numbers of idle and of undriven freedoms, the coordinates that no
    idle motion moves, and these along the sweep, in every row; None where it is no clear case."""

    idle: int
    undriven: int
    values: list[dict[str, float]]


def told(rng: Random, loop: Loop, travel: float, rows: int) -> Told | None:
    """What the null spaces and the followed branch say; None where the loop does not move by its
    crank, differs from place to place, or comes near a singular position."""
    states = [loop.start()]
    for _ in range(3):
        state = loop.wander(rng, states[0])
        if state is None:
            return None
        states.append(state)
    idle = [loop.idle(state) for state in states[1:]]
    undriven = [loop.undriven(state).shape[1] for state in states[1:]]
    numbers = {(one.shape[1], other) for one, other in zip(idle, undriven, strict=True)}
    moves = [np.abs(loop.null(loop.screws(state)[0])[0]).max(initial=0.0) for state in states]
    if len(numbers) > 1 or min(moves) < 0.03:
        return None
    (count, rest) = numbers.pop()
    if rest > count:
        return Told(count, rest, [])
    fixed = [
        k
        for k, name in enumerate(loop.names)
        if name and max(np.abs(one[k]).max(initial=0.0) for one in idle) < 1e-9
    ]
    state, found = states[0], []
    fine = 20
    for row in range(rows):
        for _ in range(fine if row else 0):
            rates = np.zeros(loop.count)
            rates[0] = travel / (rows - 1) / fine
            screws = loop.screws(state)[0]
            values = np.linalg.svd(screws[:, 1:], compute_uv=False)
            held = loop.count - 1 - rest
            if values[held - 1] < 0.05 or (len(values) > held and values[held] > CLEAR):
                return None
            rates[1:] = -np.linalg.pinv(screws[:, 1:], rcond=1e-6) @ screws[:, 0] * rates[0]
            if np.abs(rates).max() > 0.2:
                return None
            closed = loop.closed(loop.moved(state, rates), still=(0,))
            if closed is None:
                return None
            state = closed
        values_here = loop.values(state)
        found.append({loop.names[k]: values_here[loop.names[k]] for k in fixed})
    return Told(count, rest, found)
