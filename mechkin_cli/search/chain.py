"""A loop at known upstream states as a chain of elementary motions, and the proven bounds of its
number of assemblies.

Chain: with the block's unknowns at zero the axes of its freedoms stand at known places. Going round
the loop from the cut joint's first link to its second, the loop closes where the product of the
motions about these axes (product of exponentials) carries what is drawn on the second link onto
what is drawn on the first.

Bounds, by the pairs alone: what is left of a loop at fixed inputs closes in six freedoms, turns R,
slides P, and at most one sphere S (C is R P, U is R R, E is P P R, Sp is S P P, Sg is S P; a driven
freedom is gone). Their order does not matter. The bounds hold for isolated assemblies:

- one S and three others (Pieper 1968): the centre's curve on one link, a line or a circle, meets
  its surface on the other. Line and plane 1; with one turn circle and plane, or line and quadric,
  2; with two circle and quadric, or line and torus, 4; circle and torus 4, since four of their
  eight intersections lie on the circle at infinity;
- no S (Raghavan, Roth 1993; Lee, Liang 1988 for 7R): 3R 3P 2, 4R 2P 8, 5R P 16, 6R 16;
- a distance and one other freedom: circle or line and sphere, 2. A body at six distances: 40
  (Ronga, Vust 1995).

Loops that are drawn planar or spherical have fewer (`loop_equation`).
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import functions
from mechkin_cli.mechanism import GROUND, Frame, Vector, add, cross, dot, scale
from mechkin_cli.plan import Carrier, Layout
from mechkin_cli.record import NamedTuple
from mechkin_cli.structure import Block, SolverGraph

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Constraint, Joint
    from mechkin_cli.show import Floats


class ChainMotion(NamedTuple):
    """A turn about, or a slide along, an axis through a point."""

    slide: bool
    axis: Vector
    point: Vector


class Chain(NamedTuple):
    """The unknown motions in the order of the loop, and the cut joint's frames on its first and its
    second link, in kernel lengths; `distance` is the length that it keeps."""

    joint: Joint
    motions: tuple[ChainMotion, ...]
    first: Frame
    second: Frame
    distance: float | None


def chain_of(layout: Layout, number: int, base: Floats) -> Chain | None:
    """The chain of a block with one cut joint, upstream states as in `base` (states,); None where
    an unknown is a thread, a ball or a carriage or its turns are counted, or no loop of links is
    closed."""
    way = _way_of(layout, number)
    return None if way is None else _chain_along(way, [float(x) for x in base])


def chains_of(layout: Layout, number: int, bases: Floats) -> list[Chain] | None:
    """The chains at many places, upstream states as in the columns of `bases` (states, places):
    those of `chain_of`, to the last bit."""
    way = _way_of(layout, number)
    if way is None:
        return None
    if any(layout.carriers[k].part.track is not None for path in way.paths for k in path):
        # curves are evaluated number by number
        return [_chain_along(way, column) for column in bases.T.tolist()]
    chain = _chain_along(way, [np.ascontiguousarray(row) for row in bases])
    vectors = [v for motion in chain.motions for v in (motion.axis, motion.point)]
    vectors += [*chain.first, *chain.second]
    parts = [np.broadcast_to(part, bases.shape[1]) for vector in vectors for part in vector]
    slides = [motion.slide for motion in chain.motions]
    found = []
    for numbers in np.array(parts).T.tolist():
        own: list[Vector] = [
            (numbers[i], numbers[i + 1], numbers[i + 2]) for i in range(0, len(numbers), 3)
        ]
        motions = tuple(
            ChainMotion(slide, own[2 * k], own[2 * k + 1]) for k, slide in enumerate(slides)
        )
        frames = Frame(*own[-8:-4]), Frame(*own[-4:])
        found.append(Chain(chain.joint, motions, *frames, chain.distance))
    return found


class _Way(NamedTuple):
    """Round the loop of a block with one cut joint: the kernel's joints from either of its links to
    ground, those that only one of them has, in order, and the states that are unknown."""

    layout: Layout
    constraint: Constraint
    paths: tuple[list[int], list[int]]
    around: list[int]
    unknown: set[int]


def _way_of(layout: Layout, number: int) -> _Way | None:
    """None where `chain_of` has no chain."""
    graph = layout.graph
    block = graph.blocks[number]
    if len(block.closings) != 1:
        return None
    constraint = graph.closings[block.closings[0]]
    kinds = [layout.carriers[layout.carrier_of(e, f)[0]].part.type for e, f in block.unknowns]
    if any(kind.is_ball or kind.counts_turns or kind.is_carriage for kind in kinds):
        return None
    unknown = {layout.state(e, f) for e, f in block.unknowns}
    if constraint.slides or constraint.terms:
        return None
    first, second = (
        _path(layout, layout.link_number[link]) for link in (constraint.first, constraint.second)
    )
    shared = set(first) & set(second)
    around = [k for k in (*first, *reversed(second)) if k not in shared]
    if any(graph.edges[layout.carriers[k].edge].hung for k in around):
        return None
    own = [
        state
        for k in around
        for state, _ in enumerate(layout.carriers[k].part.type.slides, layout.carriers[k].state)
    ]
    if len(unknown.intersection(own)) != len(unknown):
        return None
    return _Way(layout, constraint, (first, second), around, unknown)


def _chain_along(way: _Way, states: list[Any]) -> Chain:
    """The chain with upstream `states`: numbers, or arrays of as many places."""
    layout, constraint = way.layout, way.constraint
    for state in way.unknown:
        states[state] = 0.0
    frames = _ChainFrames(layout, states)
    motions = []
    for k in way.around:
        carrier = layout.carriers[k]
        unknown = [
            slide
            for state, slide in enumerate(carrier.part.type.slides, start=carrier.state)
            if state in way.unknown
        ]
        if unknown:
            before = frames.before(k)
            motions += [ChainMotion(slide, before.z, before.o) for slide in unknown]
    ends = (constraint.first, constraint.second)
    first, second = (
        frames.on_link(link, frame) for link, frame in zip(ends, constraint.frames, strict=True)
    )
    distance = None if constraint.length is None else constraint.length / layout.length
    return Chain(constraint.joint, tuple(motions), first, second, distance)


def _path(layout: Layout, body: int) -> list[int]:
    """The kernel's joints from a body to ground."""
    path = []
    while body >= 0:
        path.append(body)
        body = layout.carriers[body].parent
    return path


class _ChainFrames:
    """Frames of bodies in the kernel's axes and lengths, at one state or at many at once."""

    def __init__(self, layout: Layout, states: list[Any]) -> None:
        self.layout, self.states = layout, states
        self._bodies: dict[int, Frame] = {-1: GROUND}

    def body(self, number: int) -> Frame:
        # outward from the last that is known, since a chain may be longer than calls go deep
        ahead = [number]
        while ahead[-1] not in self._bodies:
            ahead.append(self.layout.carriers[ahead[-1]].parent)
        for at in ahead[-2::-1]:
            carrier = self.layout.carriers[at]
            moved = _displacement(self.layout, carrier, self.states)
            self._bodies[at] = self.before(at).carry(moved)
        return self._bodies[number]

    def before(self, number: int) -> Frame:
        """The frame on the parent about which a body moves."""
        carrier = self.layout.carriers[number]
        inner = self.layout.frame_on(carrier.parent, carrier.part.before)
        return self.body(carrier.parent).carry(_frame(inner))

    def on_link(self, link: str, frame: Frame) -> Frame:
        number = self.layout.link_number[link]
        return self.body(number).carry(_frame(self.layout.frame_on(number, frame)))


def _frame(numbers: list[float]) -> Frame:
    x, y, z, o = ((numbers[i], numbers[i + 1], numbers[i + 2]) for i in range(0, len(numbers), 3))
    return Frame(x, y, z, o)


def _displacement(layout: Layout, carrier: Carrier, states: list[Any]) -> Frame:
    kind, state = carrier.part.type, carrier.state
    if kind.is_ball:
        w, x, y, z = states[state : state + 4]
        return Frame(
            (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
            (2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
            (2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
            (0.0, 0.0, 0.0),
        )
    if carrier.part.track is not None:
        at = tuple(states[state : state + len(carrier.part.at)])
        return GROUND._replace(o=scale(1.0 / layout.length, carrier.part._replace(at=at).way))
    turn = along = 0.0
    for local, freedom in enumerate(kind.freedoms):
        if freedom.is_slide:
            along += states[state + local]
        else:
            turn += states[state + local]
        if freedom.motion == "thread":
            pitch = layout.graph.edges[carrier.edge].joint.pitch
            along += states[state + local] * pitch / layout.length
    c, s = functions.cos(turn), functions.sin(turn)
    return Frame((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, along))


def square_to(axis: Vector, vector: Vector) -> Vector:
    """The part of a vector square to a unit axis."""
    return add(vector, scale(-dot(axis, vector), axis))


def are_parallel(a: Vector, b: Vector) -> bool:
    """Whether two unit vectors are parallel to `tolerances.PARALLEL`."""
    c = cross(a, b)
    return dot(c, c) < tolerances.PARALLEL * tolerances.PARALLEL


WITH_SPHERE = {0: 1, 1: 2, 2: 4, 3: 4}
"""Bound by the number of turns beside the sphere."""

WITHOUT_SPHERE = {3: 2, 4: 8, 5: 16, 6: 16}
"""Bound by the number of turns."""


AT_SIX_DISTANCES = 40
"""Bound of a body that six distances hold."""


def has_one_assembly(graph: SolverGraph) -> bool:
    """Whether the structure alone says that there is one assembly at most at any inputs, whatever
    the dimensions."""
    return all(most_of_block(graph, block) == 1 for block in graph.blocks)


def most_of_block(graph: SolverGraph, block: Block) -> int | None:
    """The proven bound of a block at fixed inputs and upstream states, None where none is known."""
    coupled = [bool(graph.closings[c].terms) for c in block.closings]
    if any(coupled):
        # couplings alone are linear, unless they are functions of coordinates
        laws = [term.law for c in block.closings for term in graph.closings[c].terms]
        linear = all(coupled) and all(law is None for law in laws)
        return 1 if linear and block.equations == len(block.unknowns) else None
    if all(graph.closings[c].length is not None for c in block.closings):
        return _bound_of_distances(graph, block)
    if len(block.closings) != 1 or block.equations != len(block.unknowns):
        return None
    freedoms = list(graph.closings[block.closings[0]].joint.type.chain)
    for number, freedom in block.unknowns:
        freedoms.append(graph.edges[number].joint.type.chain[freedom])
    count = Counter(freedom.motion for freedom in freedoms)
    turns, slides, spheres = count["turn"], count["slide"], count["ball"] // 3
    if len(freedoms) != 6 or turns + slides + 3 * spheres != 6:
        return None
    return (WITHOUT_SPHERE, WITH_SPHERE)[spheres].get(turns) if spheres <= 1 else None


def _bound_of_distances(graph: SolverGraph, block: Block) -> int | None:
    joints = [graph.edges[number].joint for number, _ in block.unknowns]
    alone = len(joints) == len(block.closings) == 1
    if alone and [f.motion for f in joints[0].type.chain] in (["turn"], ["slide"]):
        return 2
    one_joint = len({joint.name for joint in joints}) == 1
    six = len(block.closings) == 6 and one_joint and joints[0].type.is_free
    return AT_SIX_DISTANCES if six else None
