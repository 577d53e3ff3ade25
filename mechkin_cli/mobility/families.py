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

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.idle import three_turns
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mechanism import (
    Attached,
    Joint,
    LockedFreedom,
    Problem,
    Vector,
    cross,
    is_unnamed,
    is_written,
    perpendicular,
    slide_name,
    turn_name,
    unit,
)
from mechkin_cli.mobility.configurations import Body, Configuration, LoopPart, home
from mechkin_cli.mobility.dimension import (
    AssemblyComponent,
    LocalFreedom,
    freedom_of,
    general_places,
    still_along,
    usual,
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
            one = len(self.rests) == 1 and not self.rests[0].startswith("the turns")
            verb = "rests" if one else "rest"
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
        general = [general_places(part, family, random) for family in families]
        if len(families) < 2 and not any(places[0].excess for places in general):
            continue
        rests = [_resting(body, start.state, part, family) for family in families]
        always = set(rests[0]).intersection(*rests[1:]) if len(rests) > 1 else set()
        for places, names in zip(general, rests, strict=True):
            own = tuple(name for name in names if name not in always)
            free = tuple(
                f"{name}.{c}" for name, c in _free(body, start.state, part, places, driven)
            )
            found.append(MotionFamily(places[0].dimension, places[0].excess, own, free))
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
    still = set(still_along(part, start, family).values())
    moving = [column for column in columns if column not in still]
    rank: int = max(one.rank_along(moving) for one in family)
    return rank


def _resting(body: Body, start: Floats, part: LoopPart, family: Places) -> list[str]:
    """Turns of links, coordinates of points and of joints that a family leaves where they are at
    the start (states,); rods between spheres, which only hold others, are left out, and links that
    move by other parts, too."""
    mechanism = body.mechanism
    rods = {link for spin in mechanism.spins for link in spin.links}
    before = Configuration(body, start)
    outside = np.ones(body.count, dtype=np.bool_)
    outside[part.columns] = False
    links = [
        link
        for link in body.links
        if link not in rods and is_written(link) and not before.twists[link][:, outside].any()
    ]
    places = [Configuration(body, one.state) for one in family]
    turned = {
        link: usual([np.abs(p.poses[link][0] - before.poses[link][0]).max() for p in places])
        for link in links
    }
    shifted = {
        name: usual([np.abs(_spot(place, at) - _spot(before, at)) for place in places])
        for name, at in mechanism.points.items()
        if at.link in links
    }
    least = tolerances.MOBILITY_CHORD_DOUBT
    names = [f"the turns of {link}" for link, off in turned.items() if off < least]
    names += [
        f"{name}.position.{c}"
        for name, off in shifted.items()
        for c, part_of in zip("xyz", off, strict=True)
        if part_of < least
    ]
    still = np.zeros(body.count, dtype=np.bool_)
    still[list(still_along(part, start, family))] = True
    return list(dict.fromkeys([*names, *body.coordinates(still)]))


def _spot(place: Configuration, at: Attached) -> Floats:
    """Where a point of a link is, about the centre, in parts of the size."""
    turn, origin = place.poses[at.link]
    return np.asarray(turn @ ((np.array(at.vector) - place.body.centre) / place.body.size) + origin)


# What holds a problem to the family that its inputs name.


def held_to_family(
    problem: Problem, alike: Sequence[LockedFreedom] = ()
) -> tuple[LockedFreedom, ...]:
    """What the problem holds already, and what holds the motions of first order that loops stop
    along the one family in which the inputs are free, where the drawing lies in it; no more where
    the drawing is not assembled, regular, or in no such family that is told without doubt.

    Where what holds a design `alike` rests along a family here, too, no others are searched for.
    """
    held, driven, mechanism = problem.held, problem.motion.driven, problem.mechanism
    idle = len(held) + len(mechanism.spins)
    if not driven or mechanism.kutzbach > len(driven) + len(held) + len(mechanism.told_spins):
        return held
    body = Body(mechanism)
    start = home(body)
    if not start.assembled or _freedom_at_rest(body, start, driven) <= idle:
        return held
    random, more, freedoms = RandomStarts(), [], int(body.free.size)
    for part in body.parts:
        columns = part.driven(body, driven)
        for rests in dict.fromkeys((_resting_in(part, body, alike), ())):
            freedom = freedom_of(part, start.state, random, rests=rests)
            fitting = []
            for family in freedom.families:
                places = general_places(part, family, random)
                if _rank(part, start.state, places, columns) == len(columns):
                    fitting.append((family, places[0]))
            if fitting:
                break
        # what is least free is driven by the inputs, if any is
        least = min((place.dimension for _, place in fitting), default=0)
        fitting = [one for one in fitting if one[1].dimension == least]
        if freedom.doubt or len(fitting) != 1:
            return held
        freedoms += least
        family, place = fitting[0]
        if place.excess:
            more += _holds(problem, body, part, start.state, freedom.first.motions, family, alike)
    return (*held, *more) if freedoms == len(driven) + idle else held


def _resting_in(part: LoopPart, body: Body, held: Iterable[LockedFreedom]) -> tuple[int, ...]:
    """Columns of a part that rest where some freedoms are held: all three of a ball."""
    rests: set[int] = set()
    for one in held:
        if one.coordinate is None:
            continue
        joint = body.mechanism.joints[one.joints[0]]
        rests.update(
            body.columns[joint.name][k]
            for k, freedom in enumerate(joint.type.chain)
            if (
                freedom.motion == "ball"
                if one.told
                else k == joint.freedom_number(one.coordinate[1])
            )
        )
    return tuple(k for k, column in enumerate(part.columns.tolist()) if column in rests)


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
    alike: Sequence[LockedFreedom],
) -> list[LockedFreedom]:
    """Holds of coordinates that rest along a family, as many as there are more `motions` (columns,
    count) of first order at the drawing, so that with the inputs at rest none of these is left;
    those of a design `alike` first, so that assemblies go over into each other; none where too few
    coordinates are independent."""
    rows = motions[part.driven(body, problem.motion.driven)]
    left = motions @ rank_of(rows, tolerances.RANK_ZERO).motions
    candidates = list(_candidates(problem, body, left, still_along(part, state, family), alike))
    if not candidates or not left.size:
        return []
    known = {one.coordinate for one in alike}
    first = np.array([one.coordinate in known for _, one in candidates])
    rates = np.array([row for row, _ in candidates]).reshape(-1, left.shape[1])
    chosen: list[LockedFreedom] = []
    for _ in range(motions.shape[1] - family[0].dimension):
        sizes = np.sqrt(np.sum(rates * rates, axis=1))
        if sizes.max(initial=0.0) < tolerances.HELD_WELL:
            return []
        first &= sizes >= tolerances.HELD_WELL
        best = int(np.argmax(np.where(first, sizes, 0.0) if first.any() else sizes))
        chosen.append(candidates[best][1])
        rates = rates @ rank_of(rates[[best]], tolerances.RANK_ZERO).motions
    return chosen


def _candidates(
    problem: Problem,
    body: Body,
    motions: Floats,
    still: dict[int, int],
    alike: Iterable[LockedFreedom],
) -> Iterator[tuple[Floats, LockedFreedom]]:
    """What can be held, with its rates in some motions (columns, count): coordinates that are
    `still` and no input, turns of balls of which all three are; no spheres of a rod, which stand
    for a length."""
    mechanism = problem.mechanism
    told_before = {one.told.name: one.told for one in alike if one.told is not None}
    rods = {name for spin in mechanism.spins for name in spin.joints}
    driven = {name for name, _ in problem.driven}
    for joint in mechanism.joints.values():
        columns = body.columns[joint.name]
        balls = [k for k, freedom in enumerate(joint.type.chain) if freedom.motion == "ball"]
        if joint.name in rods or (balls and joint.name in driven):
            continue
        if balls and all(columns[k] in still for k in balls):
            rates = motions[[still[columns[k]] for k in balls]]
            before = told_before.get(joint.name)
            axes, told = _turns_of(body, joint, columns[balls[0]], rates, before)
            for k, axis in zip(balls, axes, strict=True):
                yield axis @ rates, _hold(joint, k, turn_name(k), told)
        names = {k: name for name, k in joint.type.freedom_of.items()}
        for k, column in enumerate(columns):
            name = names.get(k, slide_name(k))
            if k not in balls and column in still and (joint.name, name) not in problem.driven:
                yield motions[still[column]], _hold(joint, k, name, None)


def _turns_of(
    body: Body, joint: Joint, column: int, rates: Floats, told: Joint | None
) -> tuple[Floats, Joint]:
    """Three axes (3, 3) in which a ball's turns from a `column` on are told, and the joint told by
    them: those by which a design alike has it `told`, else that of the largest of its rates
    (3, count) first."""
    before = next(one for one in body.layout.carriers if one.column == column).part.before
    place = next(k for k, part in enumerate(joint.parts) if part.type.is_ball)
    if told is not None:
        ground = [part.before.z for part in told.parts[place : place + 3]]
    else:
        # rounded, so that no plan holds digits that change with the linear algebra of a machine
        x = unit(_rounded(np.linalg.svd(rates)[0][:, 0]))
        y = perpendicular(x)
        ground = [before.vector(axis) for axis in (x, y, cross(x, y))]
    a, b, c = (joint.parts[place].before.components(axis) for axis in ground)
    axes = np.array([before.components(axis) for axis in ground])
    return axes, three_turns(joint, (a, b, c))


def _rounded(axis: Floats) -> Vector:
    """An axis rounded, its largest component positive."""
    sign = 1.0 if axis[int(np.argmax(np.abs(axis)))] > 0.0 else -1.0
    x, y, z = (round(sign * float(entry), tolerances.IDLE_DECIMALS) for entry in axis)
    return (x, y, z)


def _hold(joint: Joint, number: int, name: str, told: Joint | None) -> LockedFreedom:
    """Of a freedom by its number, a turn of a ball where it is `told` as others."""
    link = joint.second if is_written(joint.second) else joint.first
    turns = told is not None
    holding = f"{joint.name}.{name}.effort"
    if is_unnamed(name):
        holding = f"{link}.holding_{'moment' if turns else 'force'}_{number}"
    where = (joint.name, name)
    return LockedFreedom(
        (link,),
        (joint.name,),
        where,
        frozenset(),
        {link: None},
        not turns,
        holding,
        told,
        everywhere=False,
        idle=False,
    )
