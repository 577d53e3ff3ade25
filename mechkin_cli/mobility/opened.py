"""A mechanism opened to a tree of elementary displacements: its poses, loops and their rank.

Tree (`opened`): every joint is carried, part by part. One that would close a loop carries a copy of
its second link (a cut), so that a configuration is a point in the space of all joint coordinates
and closes where every copy lies on its link. No joint has closing equations here, and nothing is
driven. `Poses` has the kernel give the poses of the bodies.

Rotations and displacements are vectors, for questions of rank (messages, never cells); arrays may
have any leading dimensions.

Loops (`Loops`) are closed at many states at once: how far they are open, and their screws. A state
of the kernel holds the coordinates of all joints; a step (freedoms,) changes it, balls by rotation
vectors about the axes of the body before them. Twists are (angular, linear at the centre), lengths
in parts of the size. Arrays are (rows, ...). Couplings are equations between coordinates, after
those of the cuts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    GROUND_NAME,
    Attached,
    Joint,
    Mechanism,
    Part,
    RigidLink,
    far_link,
    screws_at,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, RowInputs, Session, quaternion_product, turned_quaternion
from mechkin_cli.structure import SolverGraph, TreeEdge

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import CoordinateLaw
    from mechkin_cli.plan import Layout
    from mechkin_cli.show import Floats


Pose = tuple["Floats", "Floats"]
"""Where a body stands: turn and place; its drawing's point p is at turn p + place (lengths in
sizes, about the centre)."""


class Opened(NamedTuple):
    """The tree: `mechanism` and `graph` of elementary joints, each one edge; `elements` are the
    edges of every joint of the mechanism in the order of its parts; `cuts` gives the copy that each
    cut joint carries the link on which it lies."""

    mechanism: Mechanism
    graph: SolverGraph
    elements: Mapping[str, tuple[int, ...]]
    cuts: Mapping[str, str]


class RelatedState(NamedTuple):
    """A term of a coupling's equation `row`: a freedom's column, its state, the factor in the units
    of the equation, and what a `step` of the column and a `unit` of the state are of the coordinate
    (rad, m); with a law the term is a function of that."""

    row: int
    column: int
    state: int
    factor: float
    step: float
    unit: float
    law: CoordinateLaw | None


def opened(mechanism: Mechanism) -> Opened:
    """The mechanism as a tree, breadth first from ground."""
    edges: list[TreeEdge] = []
    elements: dict[str, tuple[int, ...]] = {}
    reached, front = {GROUND_NAME}, [GROUND_NAME]
    for link in front:
        for joint in mechanism.joints_of[link]:
            name, far = joint.name, far_link(joint, link)
            if name in elements or far in reached:
                continue
            elements[name] = _carry(edges, _parts_of(joint, joint.second), link)
            reached.add(far)
            front.append(far)
    cuts = {}
    for name, joint in mechanism.joints.items():
        if name not in elements:
            copy = f"{name} | cut"
            elements[name] = _carry(edges, _parts_of(joint, copy), joint.first)
            cuts[copy] = joint.second
    links = {edge.child: RigidLink(edge.child) for edge in edges}
    joints = {edge.joint.name: edge.joint for edge in edges}
    tree = Mechanism(mechanism.name, links, joints, couplings=mechanism.couplings)
    return Opened(tree, SolverGraph(tuple(edges), (), (), (), (), ()), elements, cuts)


def _parts_of(joint: Joint, second: str) -> list[Joint]:
    """The parts of a joint, from its first link to `second`, as joints of their own."""
    between = [f"{joint.name} | {k}" for k in range(1, len(joint.parts))]
    bodies = [joint.first, *between, second]
    parts = []
    for k, part in enumerate(joint.parts):
        name, (first, second) = f"{joint.name} | part {k + 1}", bodies[k : k + 2]
        frames = part.before, part.after
        parts.append(Joint(name, part.letter, first, second, *frames, (part,), joint.lead))
    return parts


def _carry(edges: list[TreeEdge], parts: list[Joint], link: str) -> tuple[int, ...]:
    """Adds the parts outward from `link`, at either end; their edges from first to last."""
    forward = link == parts[0].first
    for part in parts if forward else parts[::-1]:
        ends = (part.first, part.second) if forward else (part.second, part.first)
        edges.append(TreeEdge(part, *ends))
    numbers = tuple(range(len(edges) - len(parts), len(edges)))
    return numbers if forward else numbers[::-1]


class Poses:
    """The kernel's poses of bodies, about `centre` (m) in parts of `size` (m)."""

    def __init__(
        self, session: Session, bodies: Iterable[str], centre: Floats, size: float
    ) -> None:
        self.session, self.bodies = session, tuple(bodies)
        self.centre, self.size = centre, size
        marks = [centre, *(centre + size * axis for axis in np.eye(3))]
        points = [Attached(body, tuple(mark.tolist())) for body in self.bodies for mark in marks]
        self.readout = session.readout((), points)
        slots = np.array(self.readout.points, dtype=np.intp)
        self._slots = (slots[:, None] + np.arange(3)).ravel()

    def at(self, inputs: Floats, states: Floats) -> tuple[Floats, Floats]:
        """Turns (rows, bodies, 3, 3) and places (rows, bodies, 3) of ground and the bodies, in this
        order, at inputs (inputs, rows) and states (states, rows)."""
        batch = self.session.run(RowInputs(inputs, states), Ask(readout=self.readout))
        assert batch.outputs is not None
        rows = states.shape[1]
        marks = batch.outputs[self._slots].reshape(len(self.bodies), 4, 3, rows)
        marks = (marks.transpose(3, 0, 1, 2) - self.centre) / self.size
        turns = np.empty((rows, len(self.bodies) + 1, 3, 3))
        places = np.zeros((rows, len(self.bodies) + 1, 3))
        turns[:, 0] = np.eye(3)
        places[:, 1:] = marks[:, :, 0]
        turns[:, 1:] = np.swapaxes(marks[:, :, 1:] - marks[:, :, :1], -1, -2)
        return turns, places

    def named(self, turns: Floats, places: Floats) -> dict[str, Pose]:
        """The poses of one row by the names of the bodies."""
        names = (GROUND_NAME, *self.bodies)
        return {name: (turns[k], places[k]) for k, name in enumerate(names)}


def displacement(turn: Floats, place: Floats, to_turn: Floats, to_place: Floats) -> Floats:
    """The displacement (..., 6) that carries the pose `to_turn` (..., 3, 3), `to_place` (..., 3)
    onto `turn`, `place`: rotation vector, shift of the origin."""
    by = turn @ np.swapaxes(to_turn, -1, -2)
    shift = place - (by @ to_place[..., None])[..., 0]
    return np.concatenate([_rotation_vector(by), shift], axis=-1)


def _rotation_vector(turn: Floats) -> Floats:
    """Axis times angle (..., 3) of a rotation (..., 3, 3); at half a turn any axis."""
    skew = 0.5 * np.stack(
        [
            turn[..., 2, 1] - turn[..., 1, 2],
            turn[..., 0, 2] - turn[..., 2, 0],
            turn[..., 1, 0] - turn[..., 0, 1],
        ],
        axis=-1,
    )
    sine = np.sqrt(np.sum(skew * skew, axis=-1))
    cosine = 0.5 * (np.trace(turn, axis1=-2, axis2=-1) - 1.0)
    angle = np.arctan2(sine, cosine)
    still = sine == 0.0
    vector = skew * (angle / np.where(still, 1.0, sine))[..., None]
    vector[..., 0] += np.where(still, angle, 0.0)
    return np.asarray(vector, dtype=np.float64)


def quaternion_of(turn: Floats) -> Floats:
    """Unit quaternion of a rotation, scalar first; exact where the angle is half a turn, too."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = turn.tolist()
    products = np.array(  # 4 q q^T
        [
            [1.0 + xx + yy + zz, zy - yz, xz - zx, yx - xy],
            [zy - yz, 1.0 + xx - yy - zz, xy + yx, xz + zx],
            [xz - zx, xy + yx, 1.0 - xx + yy - zz, yz + zy],
            [yx - xy, xz + zx, yz + zy, 1.0 - xx - yy + zz],
        ]
    )
    row = products[int(np.argmax(np.diag(products)))]
    return np.asarray(row / np.sqrt(row @ row), dtype=np.float64)


def _turn_between(quaternion: Floats, other: Floats) -> Floats:
    """The rotation vectors (..., 3) that turn `other` (..., 4) on to `quaternion`."""
    inverse = other * np.array([1.0, -1.0, -1.0, -1.0])
    by = np.stack(
        quaternion_product(np.moveaxis(quaternion, -1, 0), np.moveaxis(inverse, -1, 0)), -1
    )
    by = np.where(by[..., :1] < 0.0, -by, by)
    sine = np.sqrt(np.sum(by[..., 1:] ** 2, axis=-1, keepdims=True))
    angle = 2.0 * np.arctan2(sine, by[..., :1])
    return np.asarray(by[..., 1:] * np.where(sine > 0.0, angle / np.where(sine > 0.0, sine, 1), 2))


def _cross(one: Floats, two: Floats) -> Floats:
    """Cross products (..., 3), with less overhead than NumPy's."""
    return np.asarray(
        one[..., [1, 2, 0]] * two[..., [2, 0, 1]] - one[..., [2, 0, 1]] * two[..., [1, 2, 0]]
    )


class Loops:
    """The closing of the cuts of an opened mechanism, and what its couplings keep."""

    def __init__(self, opened: Opened, layout: Layout, poses: Poses) -> None:
        self.opened, self.layout, self.poses = opened, layout, poses
        number = {name: k for k, name in enumerate((GROUND_NAME, *poses.bodies))}
        self.number = number
        spins: list[Any] = []
        slides: list[Any] = []
        edges: list[int] = []
        self._carried: list[tuple[int, int, Part]] = []
        for k, edge in enumerate(opened.graph.edges):
            carrier = layout.carriers[k]
            origin = (np.array(carrier.part.before.o) - poses.centre) / poses.size
            frame = carrier.part.before._replace(o=tuple(origin.tolist()))
            if carrier.part.track is None:
                own = screws_at(carrier.part.letter, frame, edge.joint.pitch / poses.size)
            else:  # those of each state take their place
                self._carried.append((len(edges), carrier.state, carrier.part))
                own = carrier.part.screws(0.0)
            for spin, slide in own:
                spins.append(spin)
                slides.append(slide)
                edges.append(k)
        self.count = len(edges)
        self._spins = np.array(spins, dtype=np.float64).reshape(-1, 3, 1)
        self._slides = np.array(slides, dtype=np.float64).reshape(-1, 3, 1)
        self._edges = np.array(edges, dtype=np.intp)
        parents = [number[edge.parent] for edge in opened.graph.edges]
        self._parents = np.array([parents[k] for k in edges], dtype=np.intp)
        self._copies = np.array([number[copy] for copy in opened.cuts], dtype=np.intp)
        self._links = np.array([number[link] for link in opened.cuts.values()], dtype=np.intp)

    @cached_property
    def passed(self) -> Floats:
        """Whether the path from ground to each body passes each edge (bodies, edges), 0 or 1."""
        edges = self.opened.graph.edges
        passed = np.zeros((len(self.number), len(edges)))
        for k, edge in enumerate(edges):
            passed[self.number[edge.child]] = passed[self.number[edge.parent]]
            passed[self.number[edge.child], k] = 1.0
        return passed

    @cached_property
    def edge_signs(self) -> Floats:
        """How the loop of each cut passes each edge (cuts, edges): outward +1, back to ground
        -1."""
        return self.passed[self._copies] - self.passed[self._links]

    @cached_property
    def signs(self) -> Floats:
        """How the loop of each cut passes each freedom (cuts, freedoms)."""
        return self.edge_signs[:, self._edges]

    @property
    def cut_rows(self) -> int:
        """Equations of the cuts, which come before those of the couplings."""
        return 6 * len(self._copies)

    @cached_property
    def passing(self) -> NDArray[np.bool_]:
        """Which freedoms each cut's loop passes, then which each coupling is between (cuts and
        couplings, freedoms)."""
        between = np.zeros(self._relations[0].shape, dtype=np.bool_)
        for term in self._related:
            between[term.row, term.column] = True
        return np.concatenate([self.signs != 0.0, between])

    @cached_property
    def _related(self) -> list[RelatedState]:
        """The terms of all couplings."""
        found = []
        for row, relation in enumerate(self.opened.mechanism.couplings.values()):
            unit = self.poses.size if relation.length else 1.0
            for term in relation.terms:
                freedom = term.joint.freedom_number(term.coordinate)
                for k in self.opened.elements[term.joint.name]:
                    carrier = self.layout.carriers[k]
                    if freedom < len(carrier.part.type.freedoms):
                        break
                    freedom -= len(carrier.part.type.freedoms)
                step, state = (term.joint.unit_of(term.coordinate, each) for each in self._units)
                at = carrier.column + freedom, carrier.state + freedom
                found.append(RelatedState(row, *at, term.factor / unit, step, state, term.law))
        return found

    @cached_property
    def _relations(self) -> tuple[Floats, Floats, Floats]:
        """Of the couplings: their Jacobian (couplings, freedoms), what they are by the states
        (couplings, states), and should be (couplings,), without functions of coordinates."""
        relations = self.opened.mechanism.couplings.values()
        jacobian = np.zeros((len(relations), self.count))
        by_state = np.zeros((len(relations), self.layout.states))
        units = [self.poses.size if relation.length else 1.0 for relation in relations]
        totals = [each.total / unit for each, unit in zip(relations, units, strict=True)]
        for term in self._related:
            if term.law is None:
                jacobian[term.row, term.column] += term.factor * term.step
                by_state[term.row, term.state] += term.factor * term.unit
        return jacobian, by_state, np.array(totals)

    def _curved(self, states: Floats, off: Floats, jacobian: Floats) -> None:
        """Adds the terms that are functions of coordinates, at states (rows, states)."""
        for term in self._related:
            if term.law is not None:
                orders = term.law.orders(states[:, term.state] * term.unit)
                off[:, term.row] += term.factor * orders[0]
                jacobian[:, term.row, term.column] += term.factor * term.step * orders[1]

    @property
    def _units(self) -> tuple[float, float]:
        """The length of a step and of a state, in m."""
        return self.poses.size, self.layout.length

    def closing(self, states: Floats) -> tuple[Floats, Floats]:
        """Misses and Jacobian at states (rows, states)."""
        return self.closing_of(*self.poses.at(np.empty((0, len(states))), states.T), states)

    def closing_of(self, turns: Floats, places: Floats, states: Floats) -> tuple[Floats, Floats]:
        """Displacements of the copies against their links and what couplings are off, the misses
        (rows, equations), and their Jacobian by the freedoms (rows, equations, freedoms), at poses
        of all bodies and the states (rows, states) that they belong to."""
        one, two = self._copies, self._links
        misses = displacement(turns[:, one], places[:, one], turns[:, two], places[:, two])
        screws = np.swapaxes(self.screws(turns, places, states), 1, 2)
        jacobian = self.signs[:, None, :] * screws[:, None]
        rows, size = len(turns), self.cut_rows
        misses, jacobian = misses.reshape(rows, size), jacobian.reshape(rows, size, self.count)
        related, by_state, totals = self._relations
        if not totals.size:
            return misses, jacobian
        off = states @ by_state.T - totals
        every = np.broadcast_to(related, (rows, *related.shape)).copy()
        self._curved(states, off, every)
        return np.concatenate([misses, off], axis=1), np.concatenate([jacobian, every], axis=1)

    def screws(self, turns: Floats, places: Floats, states: Floats) -> Floats:
        """Unit screws (rows, freedoms, 6) of all freedoms where the bodies are, at the states
        (rows, states) that they belong to."""
        turn, place = turns[:, self._parents], places[:, self._parents]
        spins = (turn @ self._spins)[..., 0]
        slides = (turn @ self._slides)[..., 0] + _cross(place, spins)
        for column, state, part in self._carried:
            count = len(part.at)
            for row, at in enumerate(states[:, state : state + count].tolist()):
                ways = [way for _, way in part._replace(at=tuple(at)).screws(0.0)]
                on_parent = np.array(ways).T / self.poses.size
                slides[row, column : column + count] = (turn[row, column] @ on_parent).T
        return np.concatenate([spins, slides], axis=2)

    def twists(self, turns: Floats, places: Floats, states: Floats) -> Floats:
        """Twists (rows, bodies, 6, freedoms) of all bodies for unit rates of the freedoms."""
        screws = np.swapaxes(self.screws(turns, places, states), 1, 2)
        return np.asarray(self.passed[:, self._edges][:, None, :] * screws[:, None])

    def moved(self, states: Floats, steps: Floats) -> Floats:
        """States (rows, states) displaced by steps (rows, freedoms)."""
        moved = states.copy()
        columns, slots, units = self._scalars
        moved[:, slots] += steps[:, columns] * units
        columns, slots = self._balls
        if slots.size:
            before, by = moved[:, slots], steps[:, columns].reshape(-1, 3)
            moved[:, slots] = turned_quaternion(before.reshape(-1, 4).T, by.T).T.reshape(
                before.shape
            )
        return moved

    def steps(self, states: Floats, others: Floats) -> Floats:
        """The steps (rows, freedoms) that lead from `others` to `states`, both (rows, states)."""
        steps = np.zeros((len(states), self.count))
        columns, slots, units = self._scalars
        steps[:, columns] = (states[:, slots] - others[:, slots]) / units
        columns, slots = self._balls
        if slots.size:
            steps[:, columns] = _turn_between(states[:, slots], others[:, slots])
        return steps

    @cached_property
    def _scalars(self) -> tuple[NDArray[np.intp], NDArray[np.intp], Floats]:
        """Columns, slots in the state and units of the freedoms that are no ball's."""
        columns, slots, units = [], [], []
        unit = self.poses.size / self.layout.length
        for carrier in self.layout.carriers:
            if carrier.part.type.is_ball:
                continue
            for k, freedom in enumerate(carrier.part.type.freedoms):
                columns.append(carrier.column + k)
                slots.append(carrier.state + k)
                units.append(unit if freedom.is_slide else 1.0)
        return np.array(columns, dtype=np.intp), np.array(slots, dtype=np.intp), np.array(units)

    @cached_property
    def _balls(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Columns (balls, 3) and slots in the state (balls, 4) of the balls."""
        balls = [c for c in self.layout.carriers if c.part.type.is_ball]
        columns = np.array([c.column for c in balls], dtype=np.intp)
        slots = np.array([c.state for c in balls], dtype=np.intp)
        return columns[:, None] + np.arange(3), slots[:, None] + np.arange(4)


class Rank(NamedTuple):
    """Rank of the loops' closing: `motions` (freedoms, count) are what it allows, `stresses`
    (equations, redundant) the wrenches that hold each other; `gap` is the ratio of singular values
    at the rank."""

    motions: Floats
    stresses: Floats
    gap: float

    @property
    def clear(self) -> bool:
        """Whether the gap decides the rank."""
        return self.gap >= tolerances.RANK_GAP

    @property
    def doubt(self) -> str:
        """Why the rank is not clear, in words."""
        return f"a gap of {self.gap:.3g} between singular values"


def rank_of(matrix: Floats, zero: float) -> Rank:
    """Rank, motions and stresses; singular values below `zero` of the largest are none."""
    rows, columns = matrix.shape
    if not matrix.any():  # nothing closes, or welds alone
        return Rank(np.eye(columns), np.eye(rows), np.inf)
    # equations that nothing moves, as those out of a plane, are stresses each by itself
    told = np.flatnonzero(matrix.any(axis=1))
    still = np.flatnonzero(~matrix.any(axis=1))
    left, values, right = np.linalg.svd(matrix[told])
    least = tolerances.RANK_ROUNDING * values[0]
    values = np.maximum(values, least)
    rank = int(np.count_nonzero(values > zero * values[0]))
    below = values[rank] if rank < len(values) else least
    stresses = np.zeros((rows, rows - rank))
    stresses[told, : told.size - rank] = left[:, rank:]
    stresses[still, told.size - rank + np.arange(still.size)] = 1.0
    return Rank(right[rank:].T, stresses, float(values[rank - 1] / below))


def full_rank(matrix: Floats, motions: Floats) -> Rank:
    """The rank of a matrix whose rows are independent but for those of zeros, with the motions that
    it allows."""
    still = np.flatnonzero(~matrix.any(axis=1))
    stresses = np.zeros((len(matrix), still.size))
    stresses[still, np.arange(still.size)] = 1.0
    return Rank(motions, stresses, np.inf)
