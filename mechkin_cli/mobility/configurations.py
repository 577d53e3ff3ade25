"""Assembled configurations of the opened mechanism, and the motion from one to the next.

The unknowns are the coordinates of all joints, loops and inputs alike; poses come from the kernel,
columns from the joint table's screws. A configuration closes by least-squares Newton steps on all
cuts (truncated singular values), so redundant constraints and free motions do no harm.
Twists are (angular, linear at the centre), lengths in parts of the size.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    GROUND_NAME,
    Assembly,
    Joint,
    Mechanism,
    MotionInputs,
    Problem,
    screws_at,
)
from mechkin_cli.mobility.opened import LoopClosure, Loops, Pose, Poses, displacement, opened
from mechkin_cli.plan import home_state
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Session
from mechkin_cli.structure import RandomStarts
from mechkin_cli.units import UnitSystem

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats


# Closing loops from many places at once, by Levenberg and Marquardt's steps.
#
# A step is that of Gauss and Newton, damped by the square of what the loops are open: quadratic
# where the equations bound the distance, however many of them are redundant (Yamashita, Fukushima
# 2001), and halving where they touch their solutions. Steps are solved by QR of the Jacobian above
# the damping, so that the Jacobian's condition is not squared.


class Sphere(NamedTuple):
    """Places whose steps from a `centre` (states,) have lengths, `radii` (places,)."""

    centre: Floats
    radii: Floats


class Closed(NamedTuple):
    """States (places, states), how far (places,) their loops are open, Jacobians there."""

    states: Floats
    misses: Floats
    jacobians: Floats

    def good(self, limit: float) -> NDArray[np.bool_]:
        """Places whose loops are open by less than a limit."""
        return self.misses < limit


def closed(part: LoopPart, starts: Floats, sphere: Sphere | None = None) -> Closed:
    """The assembled places next to `starts` (places, states), on a sphere if one is given."""
    states = starts.copy()
    places = len(states)
    best = Closed(
        states.copy(), np.full(places, np.inf), np.zeros((places, part.rows.size, part.count))
    )
    stuck = np.zeros(places, dtype=np.intp)
    active = np.arange(places)
    for _ in range(tolerances.MOBILITY_ITERATIONS):
        misses, jacobians = part.closing(states[active])
        largest = np.abs(misses).max(axis=1, initial=0.0)
        if sphere is not None:
            misses, matrix, off = _on_sphere(
                part, states[active], misses, jacobians, Sphere(sphere.centre, sphere.radii[active])
            )
        else:
            matrix, off = jacobians, np.zeros(active.size)
        whole = np.maximum(largest, np.where(off > tolerances.MOBILITY_SPHERE, off, 0.0))
        stuck[active] += np.where(whole < 0.9 * best.misses[active], 0, 1)
        better = whole < best.misses[active]
        chosen = active[better]
        best.states[chosen] = states[chosen]
        best.misses[chosen] = whole[better]
        best.jacobians[chosen] = jacobians[better]
        rounding = np.where(whole < tolerances.MOBILITY_NEAR, 1, tolerances.MOBILITY_STUCK)
        going = (whole >= tolerances.MOBILITY_TIGHT) & (stuck[active] <= rounding)
        active, misses, matrix = active[going], misses[going], matrix[going]
        if not active.size:
            break
        states[active] = part.moved(states[active], damped_steps(matrix, misses))
    return best


def _on_sphere(
    part: LoopPart, states: Floats, misses: Floats, jacobians: Floats, sphere: Sphere
) -> tuple[Floats, Floats, Floats]:
    """Misses and Jacobians with the sphere's equation, and how far off it the places are."""
    ways = part.steps(states, np.broadcast_to(sphere.centre, states.shape))
    off = (np.sum(ways * ways, axis=1) / sphere.radii - sphere.radii) / 2.0
    row = ways / sphere.radii[:, None]
    return (
        np.concatenate([misses, off[:, None]], axis=1),
        np.concatenate([jacobians, row[:, None]], axis=1),
        np.abs(off),
    )


def damped_steps(jacobians: Floats, misses: Floats) -> Floats:
    """Damped steps (places, columns), none longer than the stride."""
    places, _, columns = jacobians.shape
    damping = np.sqrt(np.sum(misses * misses, axis=1))
    damping = np.maximum(damping, tolerances.MOBILITY_DAMPING)
    above = np.concatenate([jacobians, -misses[:, :, None]], axis=2)
    below = np.zeros((places, columns, columns + 1))
    below[:, np.arange(columns), np.arange(columns)] = damping[:, None]
    triangle = np.asarray(np.linalg.qr(np.concatenate([above, below], axis=1), mode="r"))
    steps = np.linalg.solve(triangle[:, :columns, :columns], triangle[:, :columns, columns:])
    found = steps[:, :, 0]
    longest = np.abs(found).max(axis=1, initial=0.0)
    too_long = np.maximum(longest / tolerances.MOBILITY_STRIDE, 1.0)
    return np.asarray(found / too_long[:, None])


# Parts of a mechanism whose loops have no joint in common: each moves on its own.
#
# Loops of a spanning tree that share a joint, one after the other, are a part; its freedoms are
# those of the joints passed. What no loop passes moves freely. Motions of the whole are products of
# motions of the parts, so that dimensions add up.


class LoopPart:
    """Loops of a mechanism that share joints: numbers of their equations `rows` and freedoms
    `columns`."""

    def __init__(
        self,
        mechanism: Mechanism,
        loops: Loops,
        cuts: NDArray[np.intp],
        columns: NDArray[np.intp],
    ) -> None:
        self.mechanism = mechanism
        self.loops = loops
        self.columns = columns
        self.rows = (6 * cuts[:, None] + np.arange(6)).ravel()
        self.count = columns.size

    def closing(self, states: Floats) -> tuple[Floats, Floats]:
        """Misses (places, rows) and Jacobian (places, rows, columns) at states (places, states)."""
        misses, jacobian = self.loops.closing(states)
        return misses[:, self.rows], jacobian[:, self.rows[:, None], self.columns]

    def moved(self, states: Floats, steps: Floats) -> Floats:
        """States displaced by steps (places, columns)."""
        every = np.zeros((len(steps), self.loops.count))
        every[:, self.columns] = steps
        return self.loops.moved(states, every)

    def steps(self, states: Floats, others: Floats) -> Floats:
        """The steps (places, columns) from `others` to `states`."""
        return self.loops.steps(states, others)[:, self.columns]

    def alone(self, state: Floats, motions: Floats) -> Floats:
        """An orthonormal basis (k, count) of those of some `motions` (columns, k) from a place that
        move but one link, or two that are joined."""
        numbers = self.loops.number
        twists = self.loops.twists(*self.loops.poses.at(np.empty((0, 1)), state[:, None]))
        seen = twists[0][:, :, self.columns] @ motions
        links = [link for link in self.mechanism.links if link != GROUND_NAME]
        groups = [{link} for link in links]
        groups += [{j.first, j.second} for j in self.mechanism.joints.values()]
        found = [np.zeros((motions.shape[1], 0))]
        for group in groups:
            rest = [numbers[link] for link in links if link not in group]
            found.append(null_space(seen[rest].reshape(-1, motions.shape[1])))
        left, values, _ = np.linalg.svd(np.concatenate(found, axis=1), full_matrices=False)
        return np.asarray(left[:, values > tolerances.MOBILITY_FORM])


def null_space(matrix: Floats) -> Floats:
    """An orthonormal basis (columns, count) of what a matrix of unit twists maps to none."""
    _, values, right = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(values > tolerances.MOBILITY_NO_WRENCH))
    return np.asarray(right[rank:].T)


def parts(mechanism: Mechanism, loops: Loops) -> tuple[LoopPart, ...]:
    """The parts in the order of their first cuts."""
    passed = loops.signs != 0.0
    left = list(range(len(passed)))
    found = []
    while left:
        cuts, grown = [left.pop(0)], True
        columns = passed[cuts[0]].copy()
        while grown:
            grown = False
            for cut in list(left):
                if np.any(passed[cut] & columns):
                    left.remove(cut)
                    cuts.append(cut)
                    columns |= passed[cut]
                    grown = True
        found.append(LoopPart(mechanism, loops, np.array(sorted(cuts)), np.flatnonzero(columns)))
    return tuple(found)


class Body:
    """What all configurations share: the mechanism, its moving links, centre (m) and size (m), and
    the mechanism opened to a tree."""

    def __init__(self, mechanism: Mechanism) -> None:
        points = [at.vector for _, at in mechanism.joint_points()]
        self.mechanism = mechanism
        self.links = tuple(name for name in mechanism.links if name != GROUND_NAME)
        self.centre: Floats = np.mean(np.array(points), axis=0) if points else np.zeros(3)
        self.size = mechanism.box_diagonal()
        self.opened = opened(mechanism)
        tree = Problem(self.opened.mechanism, MotionInputs((), 1), Assembly(), UnitSystem())
        self.session = Session.of(tree, self.opened.graph)
        self.layout = self.session.layout
        bodies = self.opened.mechanism.links
        poses = Poses(self.session, bodies, self.centre, self.size)
        self.loops = Loops(self.opened, self.layout, poses)

    @cached_property
    def parts(self) -> tuple[LoopPart, ...]:
        """Loops that move on their own."""
        return parts(self.mechanism, self.loops)

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Columns that no loop passes."""
        return np.flatnonzero(~np.any(self.loops.signs != 0.0, axis=0))

    @cached_property
    def columns(self) -> dict[str, list[int]]:
        """Columns of each joint's freedoms."""
        starts = [carrier.column for carrier in self.layout.carriers]
        ends = [*starts[1:], self.count]
        return {
            name: [column for k in edges for column in range(starts[k], ends[k])]
            for name, edges in self.opened.elements.items()
        }

    @property
    def count(self) -> int:
        """Number of all joints' freedoms."""
        return self.loops.count

    @cached_property
    def signs(self) -> dict[str, Floats]:
        """How the loop of each cut (cuts,) passes each joint: outward +1, back to ground -1."""
        table, elements = self.loops.edge_signs, self.opened.elements
        return {name: table[:, numbers[0]] for name, numbers in elements.items()}

    def column(self, joint: str, coordinate: str) -> int:
        """Column of a coordinate."""
        freedom = self.mechanism.joints[joint].type.freedom_of[coordinate]
        return self.columns[joint][freedom]


class Configuration:
    """The opened mechanism at a state of the kernel."""

    def __init__(self, body: Body, state: Floats) -> None:
        self.body = body
        self.state = state

    @cached_property
    def _arrays(self) -> tuple[Floats, Floats]:
        return self.body.loops.poses.at(np.empty((0, 1)), self.state[:, None])

    @cached_property
    def poses(self) -> dict[str, Pose]:
        """Poses of all bodies, copies of links at cuts among them."""
        turns, places = self._arrays
        return self.body.loops.poses.named(turns[0], places[0])

    @cached_property
    def twists(self) -> dict[str, Floats]:
        """Twists (6, freedoms) of all bodies for unit rates of the joints' freedoms."""
        loops = self.body.loops
        twists = loops.twists(*self._arrays)[0]
        return {name: twists[k] for name, k in loops.number.items()}

    @cached_property
    def closing(self) -> LoopClosure:
        """Misses and Jacobian of all loops, in arrays of one row."""
        return self.body.loops.closing_of(*self._arrays)

    @property
    def jacobian(self) -> Floats:
        """Twists of the copies against their links: (6 cuts, freedoms)."""
        return np.asarray(self.closing.jacobian[0])

    @property
    def misses(self) -> Floats:
        """Displacements of the copies against their links (6 cuts,): rad, parts of the size."""
        return np.asarray(self.closing.misses[0])

    @property
    def miss(self) -> float:
        """Largest part of `misses`."""
        return float(np.abs(self.misses).max(initial=0.0))

    @property
    def assembled(self) -> bool:
        """Whether all loops close."""
        return self.miss < tolerances.MOBILITY_CLOSED

    def point(self, joint: Joint) -> Floats:
        """Where the joint's point on its first link is."""
        pose = self.poses[joint.first]
        at = (np.array(joint.on_first.o) - self.body.centre) / self.body.size
        return np.asarray(pose.turn @ at + pose.place, dtype=np.float64)

    def wider(self, joint: Joint, letter: str) -> Floats:
        """The Jacobian's columns of a softer joint of one part, on the frames of a joint of one
        part."""
        (edge,) = self.body.opened.elements[joint.name]
        signs = self.body.signs[joint.name]
        found = self._screws(edge, letter)
        return np.array([np.outer(signs, screw).ravel() for screw in found]).T

    def _screws(self, edge: int, letter: str) -> Floats:
        """Unit screws (freedoms, 6) of a displacement `letter` in place of that of an edge: of the
        body it carries against the one before, whose place it is drawn on."""
        body = self.body
        before, joint = body.layout.carriers[edge].part.before, body.opened.graph.edges[edge].joint
        pose = self.poses[body.opened.graph.edges[edge].parent]
        origin = (np.array(before.o) - body.centre) / body.size
        frame = before._replace(o=tuple(origin.tolist()))
        found = [np.zeros((0, 6))]
        for angular, linear in screws_at(letter, frame, joint.pitch / body.size):
            spin = pose.turn @ np.array(angular)
            found.append(np.array([[*spin, *(pose.turn @ linear + np.cross(pose.place, spin))]]))
        return np.concatenate(found)

    def moved(self, steps: Floats) -> Configuration:
        """Displaced by steps (freedoms,) of the joints' freedoms."""
        return Configuration(self.body, self.body.loops.moved(self.state[None], steps[None])[0])

    def closed(self) -> Configuration:
        """The configuration that steps of Levenberg and Marquardt reach from here."""
        state = self.state
        for part in self.body.parts:
            state = closed(part, state[None]).states[0]
        return Configuration(self.body, state)


def least_squares(matrix: Floats, right: Floats) -> Floats:
    """The shortest of the best solutions."""
    found = np.linalg.lstsq(matrix, right, rcond=tolerances.MOBILITY_RANK)[0]
    return np.asarray(found, dtype=np.float64)


def home(body: Body) -> Configuration:
    """The drawing, assembled or not."""
    return Configuration(body, home_state(body.layout))


def with_links_at(start: Configuration, target: Mapping[str, Pose]) -> Configuration:
    """The configuration next to `start` whose links, and copies of them, have given poses."""
    body = start.body
    bodies = {link: link for link in body.links} | {c.copy: c.link for c in body.opened.cuts}
    here = start
    for _ in range(tolerances.MOBILITY_STUCK):
        pairs = [(here.poses[name], target[link]) for name, link in bodies.items()]
        miss = np.concatenate([displacement(*one, *two) for one, two in pairs])
        if np.abs(miss).max() < tolerances.MOBILITY_TIGHT:
            break
        matrix = np.concatenate([here.twists[name] for name in bodies])
        here = here.moved(-least_squares(matrix, miss))
    return here


def assembled(body: Body) -> Configuration | None:
    """An assembled configuration: the home drawing, next to it, or from random coordinates."""
    found = home(body).closed()
    random = RandomStarts()
    tries = 0
    while not found.assembled and tries < tolerances.MOBILITY_STARTS:
        tries += 1
        found = _scattered(body, random).closed()
    return found if found.assembled else None


def _scattered(body: Body, random: RandomStarts) -> Configuration:
    """Turns and orientations anywhere, slides within the size."""
    state = home_state(body.layout)
    for carrier in body.layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state : carrier.state + 4] = random.quaternions(1)[:, 0]
            continue
        for k, freedom in enumerate(carrier.part.type.freedoms):
            half = body.size / body.layout.length if freedom.is_slide else np.pi
            state[carrier.state + k] += random.between(half, 1)[0]
    return Configuration(body, state)
