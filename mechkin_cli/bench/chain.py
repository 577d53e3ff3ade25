"""A mechanism as plain data for solvers that are not mechkin's: bodies, closings, coordinates.

The tree and the cut joints are those of the solver graph, so that every solver is given the
smallest systems that mechkin has found; formulas are its own. SI, ground axes of the drawing.
A body is placed by D = D_parent B E(q) A with constant frames B and A and an elementary
displacement E; a cut joint is a common point, a distance of two points (rods), or two frames
that its own chain of displacements brings together.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from mechkin_cli.mechanism import Frame

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Constraint, Joint, Part
    from mechkin_cli.plan import Layout


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


@dataclass(frozen=True)
class BodyTree:
    """Bodies in placing order (None where one hangs), closings, coordinates.

    `coordinates` are names in the file, "" without one; `lengths` are the numbers of those that are
    lengths. `inputs` and `unknowns` are numbers of coordinates; the rest are held at zero. `states`
    says for each coordinate where it stands in the kernel's states, a ball's first one with its
    quaternion; None for coordinates of cut joints. `points` are (name, body, place).
    """

    bodies: tuple[TreeBody | None, ...]
    closings: tuple[Closed, ...]
    coordinates: tuple[str, ...]
    lengths: frozenset[int]
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
        self.coordinates: list[str] = []
        self.lengths: set[int] = set()
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
            frozenset(self.lengths),
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
            if freedom.is_slide:
                self.lengths.add(len(self.coordinates))
            self.coordinates.append(full)
            self.states.append(None if state is None else state + (0 if kind.is_ball else local))
        return TreeDisplacement(part.letter, part.before, part.after, joint.pitch, first)

    def _closing(self, constraint: Constraint) -> Closed:
        joint, bodies = constraint.joint, self.layout.link_number
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


# Places of the bodies and the gaps of the closings, in numbers of any kind.

Turned = Mapping[int, Any]
"""The orientation (3, 3) from which each ball counts its three turns, by its first coordinate."""


class Entries:
    """Frames as three rows of four entries, which are floats, arrays over rows, jets or symbols.

    Args:
        cos, sin: of an entry.
        number: makes an entry of a float.
    """

    def __init__(
        self,
        cos: Callable[[Any], Any],
        sin: Callable[[Any], Any],
        number: Callable[[float], Any] = float,
    ) -> None:
        self.cos, self.sin, self.number = cos, sin, number

    def frame(self, frame: Frame) -> Any:
        """A constant frame."""
        columns = (frame.x, frame.y, frame.z, frame.o)
        return [[self.number(column[i]) for column in columns] for i in range(3)]

    def inverse(self, frame: Any) -> Any:
        """The inverse displacement."""
        turned = [[frame[j][i] for j in range(3)] for i in range(3)]
        return [[*row, -sum(row[k] * frame[k][3] for k in range(3))] for row in turned]

    def product(self, a: Any, b: Any) -> Any:
        """The product of two displacements."""
        return [
            [
                *(row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j] for j in range(3)),
                row[0] * b[0][3] + row[1] * b[1][3] + row[2] * b[2][3] + row[3],
            ]
            for row in a
        ]

    def screwed(self, a: Any, angle: Any, slide: Any) -> Any:
        """The frame turned about its z axis and moved along it; None for neither."""
        if slide is not None:
            a = [[x, y, z, o + z * slide] for x, y, z, o in a]
        return a if angle is None else self.turned(a, 2, angle)

    def turned(self, a: Any, about: int, angle: Any) -> Any:
        """The frame turned about its axis x (0), y (1) or z (2)."""
        c, s = self.cos(angle), self.sin(angle)
        i, j = (about + 1) % 3, (about + 2) % 3
        found = [list(row) for row in a]
        for row, old in zip(found, a, strict=True):
            row[i], row[j] = old[i] * c + old[j] * s, old[j] * c - old[i] * s
        return found

    def oriented(self, a: Any, orientation: Any) -> Any:
        """The frame turned by a matrix (3, 3)."""
        return self.product(a, [[*row, 0.0] for row in orientation])

    def image(self, a: Any, place: Place) -> Sequence[Any]:
        """The image of a point."""
        x, y, z = place
        return [row[0] * x + row[1] * y + row[2] * z + row[3] for row in a]

    def apart(self, a: Any, b: Any) -> Sequence[Any]:
        """From one frame to another that nearly coincides with it: three turns, three lengths."""
        turns = []
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            # half the sum of the axes' vector products
            turns.append(sum(b[j][n] * a[k][n] - b[k][n] * a[j][n] for n in range(3)) * 0.5)
        return [*turns, *(a[i][3] - b[i][3] for i in range(3))]


class Placing:
    """A chain in an algebra: its constant frames multiplied once."""

    def __init__(self, chain: BodyTree, algebra: Entries) -> None:
        self.chain, self.algebra = chain, algebra
        self._frames: dict[Frame, tuple[Any, Any]] = {}

    def _constant(self, frame: Frame) -> tuple[Any, Any]:
        if frame not in self._frames:
            there = self.algebra.frame(frame)
            self._frames[frame] = there, self.algebra.inverse(there)
        return self._frames[frame]

    def places(self, q: Any, turned: Turned) -> list[Any]:
        """Displacements of all bodies from the drawing; None of those that hang."""
        found: list[Any] = []
        for body in self.chain.bodies:
            if body is None:
                found.append(None)
                continue
            parent = None if body.parent == GROUND else found[body.parent]
            frame = self._moved(parent, body.by, q, turned)
            found.append(self.algebra.product(frame, self._constant(body.by.after)[1]))
        return found

    def _moved(self, parent: Any, by: TreeDisplacement, q: Any, turned: Turned) -> Any:
        """The frame behind a displacement."""
        before, algebra = self._constant(by.before)[0], self.algebra
        frame = before if parent is None else algebra.product(parent, before)
        k = by.first
        if by.kind == "R":
            return algebra.screwed(frame, q[k], None)
        if by.kind == "P":
            return algebra.screwed(frame, None, q[k])
        if by.kind == "H":
            return algebra.screwed(frame, q[k], by.pitch * q[k])
        if by.kind == "C":
            return algebra.screwed(frame, q[k], q[k + 1])
        if by.kind == "S":
            frame = algebra.oriented(frame, turned[k]) if k in turned else frame
            for about in range(3):
                frame = algebra.turned(frame, about, q[k + about])
        return frame

    def gaps(self, places: Sequence[Any], q: Any, turned: Turned) -> list[Any]:
        """All closing equations, turns in rad and lengths in m."""
        found: list[Any] = []
        for closing in self.chain.closings:
            if isinstance(closing, CommonFrame):
                found += self._frame_gap(closing, places, q, turned)
                continue
            ends = zip(
                (closing.first, closing.second),
                (closing.on_first, closing.on_second),
                strict=True,
            )
            one, two = (self.image(places, body, at) for body, at in ends)
            apart = [a - b for a, b in zip(one, two, strict=True)]
            if isinstance(closing, CommonPoint):
                found += apart
            else:
                found.append(_distance_gap(closing, apart, q))
        return found

    def image(self, places: Sequence[Any], body: int, at: Place) -> Sequence[Any]:
        """Where a point of a body is now."""
        return at if body == GROUND else self.algebra.image(places[body], at)

    def _frame_gap(
        self, closing: CommonFrame, places: Sequence[Any], q: Any, turned: Turned
    ) -> list[Any]:
        one = None if closing.first == GROUND else places[closing.first]
        last = closing.chain[-1]
        for by in closing.chain:
            one = self._moved(one, by, q, turned)
            if by is not last:
                one = self.algebra.product(one, self._constant(by.after)[1])
        two = self._constant(last.after)[0]
        if closing.second != GROUND:
            two = self.algebra.product(places[closing.second], two)
        return list(self.algebra.apart(one, two))


def _distance_gap(closing: Distance, apart: Sequence[Any], q: Any) -> Any:
    """(d^2 - l^2)/(2 l) of the lengths as drawn: the difference of the lengths, smooth at zero."""
    x, y, z = apart
    wanted = (
        closing.length
        if closing.slide is None
        else closing.length + closing.sign * q[closing.slide]
    )
    return (x * x + y * y + z * z - wanted * wanted) * (0.5 / closing.length)
