"""Assembled configurations of the opened mechanism, and the motion from one to the next.

The unknowns are the coordinates of all joints, loops and inputs alike; poses come from the kernel,
columns from the joint table's screws. Twists are (angular, linear at the centre), lengths in parts
of the size.

Loops close from many places at once by Levenberg and Marquardt's steps (`closed`): a step is that
of Gauss and Newton, damped by the square of what the loops are open, so that redundant constraints
and free motions do no harm: quadratic where the equations bound the distance (Yamashita, Fukushima
2001), and halving where they touch their solutions. Steps are solved by QR of the Jacobian above
the damping, so that the Jacobian's condition is not squared.

Loops of a spanning tree that share a joint, one after the other, are a part (`LoopPart`), which
moves on its own; its freedoms are those of the joints passed. What no loop passes moves freely.
Motions of the whole are products of motions of the parts, so that dimensions add up.

The first row's assembly is one, too (`first_row`). What locks an idle freedom is an equation more,
with dead centres of its own: where a branch ends the mechanism is looked at without it
(`lost_holds`), as the motions that all loops allow with the inputs at rest. If these are as many as
it has idle freedoms, the mechanism is as regular there as anywhere, and the end is that of what is
locked.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import choose_start, probe_of
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mechanism import (
    GROUND_NAME,
    Assembly,
    Joint,
    LockedFreedom,
    Mechanism,
    MotionInputs,
    Problem,
    is_unnamed,
    screws_at,
)
from mechkin_cli.mobility.elimination import DampedTriangle, Fronts, regular_motions
from mechkin_cli.mobility.opened import (
    Loops,
    Pose,
    Poses,
    Rank,
    displacement,
    full_rank,
    opened,
    quaternion_of,
    rank_of,
)
from mechkin_cli.plan import home_state
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Session
from mechkin_cli.units import UnitSystem

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats


class Closed(NamedTuple):
    """States (places, states), how far (places,) their loops are open, Jacobians there."""

    states: Floats
    misses: Floats
    jacobians: Floats

    def good(self, limit: float) -> NDArray[np.bool_]:
        """Places whose loops are open by less than a limit."""
        return self.misses < limit


def closed(part: LoopPart, starts: Floats, sphere: tuple[Floats, Floats] | None = None) -> Closed:
    """The assembled places next to `starts` (places, states); with a `sphere`, those whose steps
    from its centre (states,) have its radii (places,) as lengths."""
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
            centre, radii = sphere[0], sphere[1][active]
            steps = part.steps(states[active], np.broadcast_to(centre, states[active].shape))
            beyond = (np.sum(steps * steps, axis=1) / radii - radii) / 2.0
            row = steps / radii[:, None]
            misses = np.concatenate([misses, beyond[:, None]], axis=1)
            matrix, off = np.concatenate([jacobians, row[:, None]], axis=1), np.abs(beyond)
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
        fronts = part.fronts if sphere is None else None
        states[active] = part.moved(states[active], damped_steps(matrix, misses, fronts))
    return best


def damped_steps(jacobians: Floats, misses: Floats, fronts: Fronts | None = None) -> Floats:
    """Damped steps (places, columns), none longer than the stride; by `fronts`, or all at once."""
    damping = np.sqrt(np.sum(misses * misses, axis=1))
    damping = np.maximum(damping, tolerances.MOBILITY_DAMPING)
    if fronts is None:
        steps = _steps_at_once(jacobians, misses, damping)
    else:
        steps = DampedTriangle(fronts, jacobians, misses, damping).solution()
    longest = np.abs(steps).max(axis=1, initial=0.0)
    too_long = np.maximum(longest / tolerances.MOBILITY_STRIDE, 1.0)
    return np.asarray(steps / too_long[:, None])


def _steps_at_once(jacobians: Floats, misses: Floats, damping: Floats) -> Floats:
    places, _, columns = jacobians.shape
    # equations that nothing moves, as those out of a plane, ask for no step
    told = np.any(jacobians != 0.0, axis=(0, 2))
    above = np.concatenate([jacobians[:, told], -misses[:, told, None]], axis=2)
    below = np.zeros((places, columns, columns + 1))
    below[:, np.arange(columns), np.arange(columns)] = damping[:, None]
    triangle = np.asarray(np.linalg.qr(np.concatenate([above, below], axis=1), mode="r"))
    solved = np.linalg.solve(triangle[:, :columns, :columns], triangle[:, :columns, columns:])
    return np.asarray(solved[:, :, 0])


class LoopPart:
    """Loops and couplings of a mechanism that share joints: numbers of their equations `rows` and
    freedoms `columns`; `cuts` count the loops, then the couplings."""

    def __init__(
        self, mechanism: Mechanism, loops: Loops, cuts: NDArray[np.intp], columns: NDArray[np.intp]
    ) -> None:
        self.mechanism, self.loops, self.columns = mechanism, loops, columns
        closed = loops.cut_rows // 6
        own = cuts[cuts < closed]
        of_cuts = (6 * own[:, None] + np.arange(6)).ravel()
        self.rows = np.concatenate([of_cuts, cuts[cuts >= closed] + 5 * closed])
        self.count = columns.size
        self.cuts = cuts
        self.held = 3 * own.size if mechanism.plane else 0
        """Equations that a plane holds, which nothing moves."""

    @cached_property
    def fronts(self) -> Fronts | None:
        """How its loops are eliminated one after the other; None where that does not pay."""
        if self.cuts.size < tolerances.MOBILITY_LONG_ROW:
            return None
        places = np.cumsum([0, *np.where(self.cuts < self.loops.cut_rows // 6, 6, 1)])
        rows = [np.arange(*ends) for ends in itertools.pairwise(places.tolist())]
        fronts = Fronts(self.loops.passing[self.cuts][:, self.columns], rows)
        return fronts if fronts.pays else None

    def rank(self, jacobian: Floats, zero: float) -> Rank:
        """The rank of its closing, as `rank_of`."""
        motions = None
        if self.fronts is not None and self.cuts.size >= tolerances.MOBILITY_LONGER_ROW:
            motions = regular_motions(self.fronts, jacobian, zero)
        return rank_of(jacobian, zero) if motions is None else full_rank(jacobian, motions)

    def rank_reached(self, jacobian: Floats, most: int) -> Rank:
        """The rank at a place that was reached, where it has at most so many motions as where it
        came from: next to a place a rank does not fall."""
        rank = self.rank(jacobian, tolerances.MOBILITY_RANK_REACHED)
        if rank.motions.shape[1] > most:
            rank = self.rank(jacobian, tolerances.RANK_ZERO)
        return rank

    def own(self, jacobian: Floats) -> Floats:
        """Its part of the Jacobian (equations, freedoms) of all."""
        own: Floats = jacobian[self.rows[:, None], self.columns]
        return own

    def closing(self, states: Floats) -> tuple[Floats, Floats]:
        """Misses (places, rows) and Jacobian (places, rows, columns) at states (places, states)."""
        misses, jacobian = self.loops.closing(states)
        if jacobian.shape[1:] == (self.rows.size, self.count):
            return misses, jacobian  # it is the only part
        return misses[:, self.rows], jacobian[:, self.rows[:, None], self.columns]

    def moved(self, states: Floats, steps: Floats) -> Floats:
        """States displaced by steps (places, columns)."""
        every = np.zeros((len(steps), self.loops.count))
        every[:, self.columns] = steps
        return self.loops.moved(states, every)

    def steps(self, states: Floats, others: Floats) -> Floats:
        """The steps (places, columns) from `others` to `states`."""
        return self.loops.steps(states, others)[:, self.columns]

    def driven(self, body: Body, driven: Iterable[tuple[str, str]]) -> list[int]:
        """Numbers of its columns that are driven."""
        columns = {body.column(*each) for each in driven}
        return [k for k, column in enumerate(self.columns.tolist()) if column in columns]

    def alone(self, state: Floats, motions: Floats) -> Floats:
        """An orthonormal basis (k, count) of those of some `motions` (columns, k) from a place that
        move but one link, or two that are joined."""
        numbers = self.loops.number
        twists = self.loops.twists(
            *self.loops.poses.at(np.empty((0, 1)), state[:, None]), state[None]
        )
        seen = twists[0][:, :, self.columns] @ motions
        links = [link for link in self.mechanism.links if link != GROUND_NAME]
        groups = [{link} for link in links]
        groups += [{j.first, j.second} for j in self.mechanism.joints.values()]
        bases = [np.zeros((motions.shape[1], 0))]
        for group in groups:
            rest = [numbers[link] for link in links if link not in group]
            _, values, right = np.linalg.svd(seen[rest].reshape(-1, motions.shape[1]))
            rank = int(np.count_nonzero(values > tolerances.MOBILITY_NO_WRENCH))
            bases.append(right[rank:].T)  # motions that leave the rest still
        left, values, _ = np.linalg.svd(np.concatenate(bases, axis=1), full_matrices=False)
        return np.asarray(left[:, values > tolerances.MOBILITY_FORM])


def _parts(mechanism: Mechanism, loops: Loops) -> tuple[LoopPart, ...]:
    """The parts in the order of their first cuts."""
    passed = loops.passing
    left = list(range(len(passed)))
    parts = []
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
        parts.append(LoopPart(mechanism, loops, np.array(sorted(cuts)), np.flatnonzero(columns)))
    return tuple(parts)


class Body:
    """What all configurations share: the mechanism, its moving links, centre (m) and size (m), the
    mechanism opened to a tree, and the count of all joints' freedoms."""

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
        self.count = self.loops.count

    @cached_property
    def parts(self) -> tuple[LoopPart, ...]:
        """Loops that move on their own."""
        return _parts(self.mechanism, self.loops)

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Columns that no loop passes, nor a coupling."""
        return np.flatnonzero(~np.any(self.loops.passing, axis=0))

    @cached_property
    def columns(self) -> dict[str, list[int]]:
        """Columns of each joint's freedoms."""
        starts = [carrier.column for carrier in self.layout.carriers]
        ends = [*starts[1:], self.count]
        return {
            name: [column for k in edges for column in range(starts[k], ends[k])]
            for name, edges in self.opened.elements.items()
        }

    @cached_property
    def signs(self) -> dict[str, Floats]:
        """How the loop of each cut (cuts,) passes each joint: outward +1, back to ground -1."""
        table, elements = self.loops.edge_signs, self.opened.elements
        return {name: table[:, numbers[0]] for name, numbers in elements.items()}

    def column(self, joint: str, coordinate: str) -> int:
        """Of a coordinate."""
        freedom = self.mechanism.joints[joint].type.freedom_of[coordinate]
        return self.columns[joint][freedom]

    def coordinates(self, chosen: NDArray[np.bool_]) -> tuple[str, ...]:
        """Names of the coordinates whose columns are chosen (columns,)."""
        return tuple(
            f"{joint.name}.{name}"
            for joint in self.mechanism.joints.values()
            for name in joint.type.freedom_of
            if chosen[self.column(joint.name, name)]
        )


class Configuration:
    """The opened mechanism at a state of the kernel."""

    def __init__(self, body: Body, state: Floats) -> None:
        self.body, self.state = body, state

    @cached_property
    def _arrays(self) -> tuple[Floats, Floats]:
        return self.body.loops.poses.at(np.empty((0, 1)), self.state[:, None])

    @cached_property
    def poses(self) -> dict[str, Pose]:
        """Poses of all bodies, copies of links at cuts among them."""
        turns, places = self._arrays
        return self.body.loops.poses.named(turns[0], places[0])

    @cached_property
    def every_twist(self) -> Floats:
        """Twists (bodies, 6, freedoms) of all bodies for unit rates of the joints' freedoms."""
        every: Floats = self.body.loops.twists(*self._arrays, self.state[None])[0]
        return every

    @cached_property
    def twists(self) -> dict[str, Floats]:
        """The same by the body's name, (6, freedoms) each."""
        return {name: self.every_twist[k] for name, k in self.body.loops.number.items()}

    @cached_property
    def _closing(self) -> tuple[Floats, Floats]:
        return self.body.loops.closing_of(*self._arrays, self.state[None])

    @property
    def jacobian(self) -> Floats:
        """Twists of the copies against their links, and rates of what couplings keep: (equations,
        freedoms)."""
        return np.asarray(self._closing[1][0])

    @cached_property
    def moved_by(self) -> tuple[list[list[int]], list[list[int]]]:
        """The equations and the bodies that each freedom moves."""
        equations = (np.flatnonzero(column).tolist() for column in self.jacobian.T)
        bodies = np.any(self.every_twist != 0.0, axis=1).T
        return list(equations), [np.flatnonzero(column).tolist() for column in bodies]

    @property
    def miss(self) -> float:
        """Largest part of the copies' displacements against their links: rad, parts of the size."""
        return float(np.abs(self._closing[0][0]).max(initial=0.0))

    @property
    def assembled(self) -> bool:
        """Whether all loops close, in parts of how far the links are."""
        return self.miss < tolerances.MOBILITY_CLOSED * self.reach

    @cached_property
    def reach(self) -> float:
        """How far the links are from the drawing's centre, in parts of its size; at least 1."""
        return max(1.0, *(float(np.abs(at).max()) for _, at in self.poses.values()))

    def point(self, joint: Joint) -> Floats:
        """Where the joint's point on its first link is."""
        turn, place = self.poses[joint.first]
        at = (np.array(joint.on_first.o) - self.body.centre) / self.body.size
        return np.asarray(turn @ at + place, dtype=np.float64)

    def wider(self, joint: Joint, letter: str) -> Floats:
        """The Jacobian's columns of a softer joint of one part, on the frames of a joint of one
        part: of the body that it carries against the one before."""
        body = self.body
        (number,) = body.opened.elements[joint.name]
        edge, before = body.opened.graph.edges[number], body.layout.carriers[number].part.before
        turn, place = self.poses[edge.parent]
        origin = (np.array(before.o) - body.centre) / body.size
        frame = before._replace(o=tuple(origin.tolist()))
        columns = []
        for angular, linear in screws_at(letter, frame, edge.joint.pitch / body.size):
            spin = turn @ np.array(angular)
            screw = np.array([*spin, *(turn @ linear + np.cross(place, spin))])
            columns.append(np.outer(body.signs[joint.name], screw).ravel())
        of_cuts = np.array(columns).T
        couplings = np.zeros((len(self.jacobian) - len(of_cuts), of_cuts.shape[1]))
        return np.concatenate([of_cuts, couplings])

    def moved(self, steps: Floats) -> Configuration:
        """Displaced by steps (freedoms,) of the joints' freedoms."""
        return Configuration(self.body, self.body.loops.moved(self.state[None], steps[None])[0])

    def closed(self) -> Configuration:
        """The configuration that steps of Levenberg and Marquardt reach from here."""
        state = self.state
        for part in self.body.parts:
            state = closed(part, state[None]).states[0]
        return Configuration(self.body, state)


def home(body: Body) -> Configuration:
    """The drawing, assembled or not."""
    return Configuration(body, home_state(body.layout))


def with_links_at(start: Configuration, target: Mapping[str, Pose]) -> Configuration:
    """The configuration next to `start` whose links, and copies of them, have the target poses."""
    body = start.body
    bodies = {**{link: link for link in body.links}, **body.opened.cuts}
    here = start
    for _ in range(tolerances.MOBILITY_STUCK):
        pairs = [(here.poses[name], target[link]) for name, link in bodies.items()]
        miss = np.concatenate([displacement(*one, *two) for one, two in pairs])
        if np.abs(miss).max() < tolerances.MOBILITY_TIGHT:
            break
        matrix = np.concatenate([here.twists[name] for name in bodies])
        here = here.moved(-np.linalg.lstsq(matrix, miss, rcond=tolerances.MOBILITY_RANK)[0])
    return here


def assembled(body: Body) -> Configuration | None:
    """An assembled configuration: the home drawing, next to it, or from random coordinates."""
    place, random = home(body).closed(), RandomStarts()
    for _ in range(tolerances.MOBILITY_STARTS):
        if place.assembled:
            break
        place = _scattered(body, random).closed()
    return place if place.assembled else None


def _scattered(body: Body, random: RandomStarts) -> Configuration:
    """Turns and orientations anywhere, slides within the size."""
    state = home_state(body.layout)
    for carrier in body.layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state : carrier.state + 4] = random.quaternions(1)[:, 0]
            continue
        if carrier.part.track is not None:
            for k, (low, high) in enumerate(carrier.part.track.ends):
                at = 0.5 * (low + high) + random.between(0.5 * (high - low), 1)[0]
                state[carrier.state + k] = at
            continue
        for k, freedom in enumerate(carrier.part.type.freedoms):
            half = body.size / body.layout.length if freedom.is_slide else np.pi
            state[carrier.state + k] += random.between(half, 1)[0]
    return Configuration(body, state)


def first_row(session: Session, body: Body) -> Configuration | None:
    """The assembly that a sweep starts from; None if the file drives nothing."""
    if not session.driven:
        return None
    start = choose_start(session)
    if start.state is None:
        return None
    return configuration_at(session, body, session.inputs.values[:, start.row], start.state)


def configuration_at(
    session: Session, body: Body, inputs: Floats, state: Floats
) -> Configuration | None:
    """The configuration of the opened mechanism whose links are where a session has them at inputs
    (inputs,) and a state (states,), kernel units; None if none is found."""
    poses = Poses(session, body.links, body.centre, body.size)
    turns, places = poses.at(inputs[:, None], state[:, None])
    if not (np.isfinite(turns).all() and np.isfinite(places).all()):
        return None  # inputs that are too few do not place all links
    links = poses.named(turns[0], places[0])
    coordinates, _ = probe_of(session).read(inputs, state[:, None])
    seed = _seed(body, {name: float(value[0]) for name, value in coordinates.items()}, links)
    place = with_links_at(seed, links)
    return place if place.assembled else None


def _seed(body: Body, coordinates: Mapping[str, float], links: Mapping[str, Pose]) -> Configuration:
    """The coordinates that have names, and the orientations of balls; other slides at zero."""
    state, layout = home(body).state.copy(), body.layout
    for name, joint in body.mechanism.joints.items():
        columns = body.columns[name]
        values = {columns[c.freedom]: c for c in joint.type.named if not c.on_thread}
        for k in body.opened.elements[name]:
            carrier, edge = layout.carriers[k], body.opened.graph.edges[k]
            part = edge.joint.parts[0]
            if part.type.is_ball:
                # slides beside a ball do not turn
                before = links[joint.first][0] @ np.array(part.before[:3]).T
                after = links[joint.second][0] @ np.array(part.after[:3]).T
                turn = before.T @ after if edge.forward else after.T @ before
                state[carrier.state : carrier.state + 4] = quaternion_of(turn)
                continue
            for number in range(len(part.type.freedoms)):
                known = values.get(carrier.column + number)
                if known is not None:
                    unit = joint.unit_of(known.name, layout.length)
                    value = coordinates[f"{name}.{known.name}"] / unit
                    state[carrier.state + number] = value
    return Configuration(body, state)


def lost_holds(session: Session, inputs: Floats, state: Floats) -> tuple[LockedFreedom, ...]:
    """What is locked and cannot keep its value at a place, inputs (inputs,) and states (states,),
    that is regular without it; empty where the mechanism itself is singular or none is found."""
    problem = session.problem
    if not problem.held or not np.isfinite(state).all():
        return ()
    body = Body(problem.mechanism)
    place = configuration_at(session, body, inputs, state)
    if place is None:
        return ()
    # lengths in parts of how far the links are, where that is more than the size; unit columns
    far = 1.0 / place.reach
    jacobian = place.jacobian
    parts = np.array([1.0, 1.0, 1.0, far, far, far])
    cuts = body.loops.cut_rows
    weights = np.concatenate([np.tile(parts, cuts // 6), np.ones(len(jacobian) - cuts)])
    matrix = jacobian * weights[:, None]
    lengths = np.sqrt((matrix * matrix).sum(axis=0))
    driven = np.eye(body.count)[[body.column(*each) for each in problem.motion.driven]]
    at_rest = np.concatenate([matrix / np.where(lengths > 0.0, lengths, 1.0), driven])
    motions = rank_of(at_rest, tolerances.REGULAR_WITHOUT_HOLDS).motions
    if motions.shape[1] != len(problem.held) + len(problem.mechanism.spins):
        return ()
    return _dependent(problem.held, body, motions)


def hold_ends(held: Iterable[LockedFreedom]) -> tuple[str, str]:
    """What is locked and cannot keep its value beyond a place, in words, and what to do."""
    held = tuple(held)
    words = "; ".join(dict.fromkeys(one.words for one in held))
    conventions = ", ".join(dict.fromkeys(one.convention for one in held))
    names = [one.name for one in held if one.cure == f"drive {one.name}"]
    drive = f"drive it (inputs: {{{names[0]}: ...}}) so that it can go on, or " if names else ""
    return (
        f"{words}; {conventions}, and cannot be kept there beyond this place, where the mechanism "
        "itself has no dead centre",
        f"{drive}put the idle links elsewhere, by the drawing or by assembly: {{near: ...}}",
    )


def _dependent(
    held: tuple[LockedFreedom, ...], body: Body, motions: Floats
) -> tuple[LockedFreedom, ...]:
    """Those whose coordinates the idle motions (freedoms, count) leave at rest, or change together;
    if those that have names are independent, those that have none."""
    named = [
        one for one in held if one.coordinate is not None and not is_unnamed(one.coordinate[1])
    ]
    unnamed = tuple(one for one in held if one.coordinate is not None and one not in named)
    if not named:
        return unnamed
    rates = motions[[body.column(*one.name.split(".")) for one in named]]
    left, values, _ = np.linalg.svd(rates)
    if unnamed and values[-1] > tolerances.HELD_INDEPENDENT:
        return unnamed
    parts = np.abs(left[:, -1])
    return tuple(
        one
        for one, part in zip(named, parts.tolist(), strict=True)
        if part > tolerances.HELD_PART * parts.max()
    )
