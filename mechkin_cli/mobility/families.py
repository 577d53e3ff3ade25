"""Families: the components of assembled places that meet at one, what rests along each, and what
keeps a problem in the one that its inputs name.

Along a family the first order may have more motions than the family has dimensions, wherever it
goes: a table on four equal parallel rods turns about their direction to first order, and no way
further, at every position without a turn. Its closing is a double root there, singular as it
stands, though each position is the only one of its inputs. A coordinate that rests along the whole
family and moves with the motion of first order is held (`held_to_family`): the loops imply its
equation, with which they are regular, so that rows are the family's. That the family has no more
dimensions than the inputs drive is told by finite moves (`dimension`), and each row's loops are
closed with all their equations, so that a coordinate that does not rest leaves them open.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.idle import three_turns
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mechanism import (
    Attached,
    LockedFreedom,
    Problem,
    is_written,
    slide_name,
    turn_name,
)
from mechkin_cli.mobility.configurations import Body, Configuration, LoopPart, home
from mechkin_cli.mobility.dimension import (
    AssemblyComponent,
    LocalFreedom,
    excess_of,
    freedom_of,
)
from mechkin_cli.mobility.opened import rank_of
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

Places = tuple[AssemblyComponent, ...]
"""Places of one family."""


class MotionFamily(NamedTuple):
    """A family that meets others at a place, or has motions of first order more than dimensions.

    `dimension` counts its freedoms and `excess` what the first order has beside them everywhere;
    `rests` are the coordinates, and the links' turns, that do not move along it, but for those that
    no family moves; `inputs` those that are independent of each other along it.
    """

    dimension: int
    excess: int
    rests: tuple[str, ...]
    inputs: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """The family in words."""
        text = "1 freedom" if self.dimension == 1 else f"{self.dimension} freedoms"
        text += f" (everywhere {self.excess} more to first order)" if self.excess else ""
        if self.rests:
            verb = "rests" if len(self.rests) == 1 else "rest"
            text += f": {', '.join(self.rests)} {verb}"
        return f"{text}; free inputs: {', '.join(self.inputs)}" if self.inputs else text


def families_of(
    start: Configuration,
    freedoms: Iterable[tuple[LoopPart, LocalFreedom]],
    driven: Sequence[tuple[str, str]],
) -> tuple[MotionFamily, ...]:
    """The families of the parts of which several meet at the start, or whose first order has more
    motions everywhere."""
    body = start.body
    found: list[MotionFamily] = []
    for part, freedom in freedoms:
        families = [family for family in freedom.families if family[0].dimension]
        random = RandomStarts()
        excess = [excess_of(part, family, random) for family in families]
        if len(families) < 2 and not any(excess):
            continue
        rests = [_resting(body, start.state, part, family) for family in families]
        always = set(rests[0]).intersection(*rests[1:]) if len(rests) > 1 else set()
        for family, names, more in zip(families, rests, excess, strict=True):
            own = tuple(name for name in names if name not in always)
            free = tuple(
                f"{name}.{c}" for name, c in _free(body, start.state, part, family, driven)
            )
            found.append(MotionFamily(family[0].dimension, more, own, free))
    return tuple(dict.fromkeys(found))


def _free(
    body: Body, start: Floats, part: LoopPart, family: Places, driven: Iterable[tuple[str, str]]
) -> list[tuple[str, str]]:
    """The inputs of a part, in their order, that are independent of those before."""
    free: list[tuple[str, str]] = []
    for each in driven:
        if _rank(part, start, family, part.driven(body, [*free, each])) > len(free):
            free.append(each)
    return free


def _rank(part: LoopPart, start: Floats, family: Places, columns: Sequence[int]) -> int:
    """How many rates of some columns are independent along a family; what rests has none."""
    still = set(_still(part, start, family).values())
    moving = [column for column in columns if column not in still]
    rank: int = max(one.rank_along(moving) for one in family)
    return rank


def _resting(body: Body, start: Floats, part: LoopPart, family: Places) -> list[str]:
    """Turns of links, coordinates of points and of joints that a family leaves where they are at
    the start (states,); rods between spheres, which only hold others, are left out."""
    mechanism = body.mechanism
    rods = {link for spin in mechanism.spins for link in spin.links}
    links = [link for link in body.links if link not in rods and is_written(link)]
    before = Configuration(body, start)
    turned = dict.fromkeys(links, 0.0)
    shifted = {name: np.zeros(3) for name, at in mechanism.points.items() if at.link in links}
    for one in family:
        place = Configuration(body, one.state)
        for link in links:
            off = np.abs(place.poses[link][0] - before.poses[link][0]).max()
            turned[link] = max(turned[link], float(off))
        for name in shifted:
            at = mechanism.points[name]
            off = _spot(place, at) - _spot(before, at)
            shifted[name] = np.maximum(shifted[name], np.abs(off))
    least = tolerances.MOBILITY_CHORD_DOUBT
    names = [f"the turns of {link}" for link, off in turned.items() if off < least]
    names += [
        f"{name}.position.{c}"
        for name, off in shifted.items()
        for c, part_of in zip("xyz", off, strict=True)
        if part_of < least
    ]
    still = np.zeros(body.count, dtype=np.bool_)
    still[list(_still(part, start, family))] = True
    return list(dict.fromkeys([*names, *body.coordinates(still)]))


def _spot(place: Configuration, at: Attached) -> Floats:
    """Where a point of a link is, about the centre, in parts of the size."""
    turn, origin = place.poses[at.link]
    return np.asarray(turn @ ((np.array(at.vector) - place.body.centre) / place.body.size) + origin)


# What holds a problem to the family that its inputs name.


def held_to_family(problem: Problem) -> tuple[LockedFreedom, ...]:
    """What the problem holds already, and what holds the motions of first order that loops stop
    along the one family in which the inputs are free, where the drawing lies in it; no more where
    the drawing is not assembled, regular, or in no such family that is told without doubt."""
    held, driven, mechanism = problem.held, problem.motion.driven, problem.mechanism
    idle = len(held) + len(mechanism.spins)
    if not driven or mechanism.kutzbach > len(driven) + idle:
        return held
    body = Body(mechanism)
    start = home(body)
    if not start.assembled or _freedom_at_rest(body, start, driven) <= idle:
        return held
    random, more = RandomStarts(), []
    for part in body.parts:
        freedom, columns = freedom_of(part, start.state, random), part.driven(body, driven)
        fitting = [
            family
            for family in freedom.families
            if _rank(part, start.state, family, columns) == len(columns)
        ]
        if freedom.doubt or len(fitting) != 1:
            return held
        if excess_of(part, fitting[0], random):
            more += _holds(problem, body, part, start.state, freedom.first.motions, fitting[0])
    return (*held, *more)


def _freedom_at_rest(body: Body, place: Configuration, driven: Sequence[tuple[str, str]]) -> int:
    """How many motions of first order leave the inputs at rest."""
    rows = np.eye(body.count)[[body.column(*each) for each in driven]]
    matrix = np.concatenate([place.jacobian, rows])
    return int(rank_of(matrix, tolerances.RANK_ZERO).motions.shape[1])


def _holds(
    problem: Problem,
    body: Body,
    part: LoopPart,
    state: Floats,
    motions: Floats,
    family: Places,
) -> list[LockedFreedom]:
    """Holds of coordinates that rest along a family, as many as there are more `motions` (columns,
    count) of first order at the drawing, so that with the inputs at rest none of these is left;
    none where too few coordinates are independent."""
    candidates = _candidates(problem, body, part, _still(part, state, family))
    rows = motions[part.driven(body, problem.motion.driven)]
    left = motions @ rank_of(rows, tolerances.RANK_ZERO).motions
    chosen: list[LockedFreedom] = []
    for _ in range(motions.shape[1] - family[0].dimension):
        sizes = [np.sqrt(left[column] @ left[column]) for column, _ in candidates]
        if not sizes or max(sizes) < tolerances.HELD_WELL:
            return []
        column, hold = candidates.pop(int(np.argmax(sizes)))
        chosen.append(hold)
        left = left @ rank_of(left[[column]], tolerances.RANK_ZERO).motions
    return chosen


def _still(part: LoopPart, state: Floats, family: Places) -> dict[int, int]:
    """Columns of the whole that rest along a family, where the drawing has them, with their numbers
    in the part."""
    starts = np.repeat(state[None], len(family), axis=0)
    steps = np.abs(part.steps(np.array([one.state for one in family]), starts)).max(axis=0)
    still = np.flatnonzero(steps < tolerances.MOBILITY_CHORD_DOUBT)
    return {int(part.columns[k]): int(k) for k in still}


def _candidates(
    problem: Problem, body: Body, part: LoopPart, still: dict[int, int]
) -> list[tuple[int, LockedFreedom]]:
    """What can be held, with its column: coordinates that are `still` and no input, turns of balls
    of which all three are; no spheres of a rod, which stand for
    a length."""
    mechanism = problem.mechanism
    rods = {name for spin in mechanism.spins for name in spin.joints}
    driven = {name for name, _ in problem.driven}
    found = []
    for joint in mechanism.joints.values():
        columns = body.columns[joint.name]
        balls = {k for k, freedom in enumerate(joint.type.chain) if freedom.motion == "ball"}
        if joint.name in rods or (balls and joint.name in driven):
            continue
        told = three_turns(joint) if all(columns[k] in still for k in balls) else None
        names = {k: name for name, k in joint.type.freedom_of.items()}
        link = joint.second if is_written(joint.second) else joint.first
        for k, column in enumerate(columns):
            turns, name = k in balls, names.get(k, slide_name(k))
            if column not in still or (joint.name, name) in problem.driven:
                continue
            if turns and told is None:
                continue
            holding = f"{joint.name}.{name}.effort"
            if turns or k not in names:
                name = turn_name(k) if turns else name
                holding = f"{link}.holding_{'moment' if turns else 'force'}_{k}"
            hold = LockedFreedom(
                (link,),
                (joint.name,),
                (joint.name, name),
                frozenset(),
                {link: None},
                not turns,
                holding,
                told if turns else None,
                everywhere=False,
                idle=False,
            )
            found.append((still[column], hold))
    return found
