"""A mechanism as plain data for solvers that are not mechkin's: bodies, closings, coordinates.

The tree and the closing joints are those of the solver graph, so that every solver is given the
smallest systems that mechkin has found; formulas are its own. SI, ground axes of the drawing.
A body is placed by D = D_parent B E(q) A with constant frames B and A and an elementary
displacement E; a closing joint is a common point, a distance of two points (rods), or two frames
that its own chain of displacements brings together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.mechanism import Frame

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Joint, Part
    from mechkin_cli.plan import Layout
    from mechkin_cli.structure import CutJoint


GROUND = -1
Place = tuple[float, float, float]


class TreeDisplacement(NamedTuple):
    """An elementary displacement of `kind` R, P, C, H, S or W from the frame `before` on one body
    to the frame `after` on the next; `first` is the number of its first coordinate."""

    kind: str
    before: Frame
    after: Frame
    pitch: float
    first: int


class TreeBody(NamedTuple):
    """A body that a displacement carries on its parent, by number."""

    name: str
    parent: int
    by: TreeDisplacement


class CommonPoint(NamedTuple):
    """The point `on_first` of one body is the point `on_second` of another."""

    first: int
    second: int
    on_first: Place
    on_second: Place


class Distance(NamedTuple):
    """Two points keep a distance, or one that grows with `sign` times the coordinate `slide`."""

    first: int
    second: int
    on_first: Place
    on_second: Place
    length: float
    slide: int | None
    sign: float


class CommonFrame(NamedTuple):
    """A chain of displacements leads from one body to the other."""

    first: int
    second: int
    chain: tuple[TreeDisplacement, ...]


Closed = CommonPoint | Distance | CommonFrame


class TreeCoordinate(NamedTuple):
    """A coordinate: its name in the file ("" without one), what a unit of it is there, and whether
    it is a length."""

    name: str
    factor: float
    is_length: bool


@dataclass(frozen=True)
class BodyTree:
    """Bodies in placing order (None where one hangs), closings, coordinates.

    `inputs` and `unknowns` are numbers of coordinates; the rest are held at zero. `states` says for
    each coordinate where it stands in the kernel's states, a ball's first one with its quaternion;
    None for coordinates of closing joints. `points` are (name, body, place).
    """

    bodies: tuple[TreeBody | None, ...]
    closings: tuple[Closed, ...]
    coordinates: tuple[TreeCoordinate, ...]
    inputs: tuple[int, ...]
    unknowns: tuple[int, ...]
    states: tuple[int | None, ...]
    balls: tuple[int, ...]
    points: tuple[tuple[str, int, Place], ...]
    length: float
    size: float

    @property
    def equations(self) -> int:
        """Number of closing equations."""
        return sum(EQUATIONS[type(closing)] for closing in self.closings)


EQUATIONS = {CommonPoint: 3, Distance: 1, CommonFrame: 6}


def chain_of(layout: Layout, points: dict[str, tuple[str, Place]]) -> BodyTree:
    """The chain of a mechanism in the kernel; with `points` (link, place) by name."""
    return _Builder(layout).chain(points)


class _Builder:
    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.coordinates: list[TreeCoordinate] = []
        self.states: list[int | None] = []
        self.balls: list[int] = []
        self.bodies: list[TreeBody | None] = []
        self.first: dict[int, int] = {}

    def chain(self, points: dict[str, tuple[str, Place]]) -> BodyTree:
        layout = self.layout
        for number in range(len(layout.carriers)):
            self.bodies.append(self._body(number))
        of_tree = len(self.coordinates)
        closings = tuple(self._closing(closing) for closing in layout.graph.closings)
        inputs = tuple(self._number(*pair) for pair in layout.graph.inputs)
        inside = {self._number(*u) for block in layout.graph.blocks for u in block.unknowns}
        unknowns = (*sorted(inside), *range(of_tree, len(self.coordinates)))
        known = [(name, layout.link_number[link], at) for name, (link, at) in points.items()]
        return BodyTree(
            tuple(self.bodies),
            closings,
            tuple(self.coordinates),
            inputs,
            unknowns,
            tuple(self.states),
            tuple(self.balls),
            tuple(p for p in known if p[1] == GROUND or self.bodies[p[1]] is not None),
            layout.length,
            layout.mechanism.box_diagonal(),
        )

    def _number(self, edge: int, freedom: int) -> int:
        number, local = self.layout.carrier_of(edge, freedom)
        return self.first[number] + local

    def _body(self, number: int) -> TreeBody | None:
        carrier = self.layout.carriers[number]
        edge = self.layout.graph.edges[carrier.edge]
        if edge.hung:
            return None
        self.first[number] = len(self.coordinates)
        by = self._displacement(carrier.part, edge.joint, carrier.first_freedom, carrier.state)
        hangs = carrier.parent != GROUND and self.bodies[carrier.parent] is None
        return None if hangs else TreeBody(edge.child, carrier.parent, by)

    def _displacement(
        self, part: Part, joint: Joint, first_freedom: int, state: int | None
    ) -> TreeDisplacement:
        first = len(self.coordinates)
        kind = part.type
        names = {} if joint.type.is_free and "." in joint.name else joint.type.scalars
        by_freedom = {freedom: name for name, freedom in names.items()}
        if kind.is_ball:
            self.balls.append(first)
        for local, freedom in enumerate(kind.freedoms):
            name = by_freedom.get(first_freedom + local, "")
            full = f"{joint.name}.{name}" if name and not kind.is_ball else ""
            self.coordinates.append(TreeCoordinate(full, 1.0, freedom.is_slide))
            self.states.append(None if state is None else state + (0 if kind.is_ball else local))
        return TreeDisplacement(part.letter, part.before, part.after, joint.pitch, first)

    def _closing(self, closing: CutJoint) -> Closed:
        joint, constraint, bodies = closing.joint, closing.constraint, self.layout.link_number
        first, second = bodies[constraint.first], bodies[constraint.second]
        if constraint.length is not None:
            one, other = (at.vector for at in constraint.points)
            slide, hung = None, constraint.hung
            for own in constraint.slides:
                slide = self._number(self.layout.edge_number[own.name], 0)
            sign = 0.0 if hung is None else hung.slide_sign
            return Distance(first, second, one, other, constraint.length, slide, sign)
        if joint.type.is_ball:
            return CommonPoint(first, second, joint.on_first.o, joint.on_second.o)
        freedom, found = 0, []
        for part in joint.parts:
            found.append(self._displacement(part, joint, freedom, None))
            freedom += len(part.type.freedoms)
        return CommonFrame(first, second, tuple(found))
