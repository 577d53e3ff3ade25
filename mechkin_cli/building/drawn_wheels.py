"""What couplings look like: wheels with teeth or smooth, racks, belts and screws, as pages and
pictures draw them.

A wheel is drawn on its own link, in the home drawing, where it meshes: its teeth stand so that one
of them fills a gap of its mate at the pitch point. Wheels that several couplings have in common are
drawn once. What is smooth has no number of teeth that is told; a rack's pinion without one has
`PINION_TEETH`. In a plane, where wheels of one shaft would lie in one another, couplings are drawn
in layers. Widths are a picture's choice: nothing is computed from them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import pi

from mechkin_cli import tolerances
from mechkin_cli.building.belts import belt_radii
from mechkin_cli.building.fields import Fields, place_at
from mechkin_cli.building.serpentine import belt_loop
from mechkin_cli.building.wheels import Turning, against, on_one_carrier
from mechkin_cli.mechanism import (
    Frame,
    Joint,
    Mechanism,
    Relation,
    Vector,
    add,
    cross,
    dot,
    frame_about,
    frame_on,
    norm,
    scale,
    subtract,
    unit,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import (
    AnyCoupling,
    BeltCoupling,
    ChainCoupling,
    GearCoupling,
    RackCoupling,
    ScrewCoupling,
)
from mechkin_cli.tape import cos, of_two, sin, square_root
from mechkin_cli.units import DIMENSIONLESS, LENGTH, Dimension

PINION_TEETH = 18
FACE = 0.3
"""Width of wheels in parts of the radius of the smaller one."""

WORM = 2.0
"""Teeth that lean by a larger tangent are drawn as threads."""


class DrawnWheel(NamedTuple):
    """A wheel, or the `slide` of a rack: joint and sense of its slide.

    Attributes:
        link: on whose home drawing the rest stands.
        on: its frame: centre (m), z the axis, x to the middle of a tooth at the centre's height; of
            a rack a place of its pitch line where a tooth is, z along it, x out of its teeth.
        radius: of the pitch circle, m; of a rack that of its pinion, whose teeth it has.
        width: m.
        teeth: their number; 0: smooth.
        inner: whether its teeth are inside.
        apex: where the apex of its pitch cone is on z (m); 0: it is a cylinder.
        lean: by how much teeth go along the circumference, counter-clockwise about z, per length
            along z.
    """

    link: str
    on: Frame
    radius: float
    width: float
    teeth: int = 0
    inner: bool = False
    apex: float = 0.0
    lean: float = 0.0
    slide: tuple[str, float] | None = None

    @property
    def is_worm(self) -> bool:
        """Whether its teeth are threads."""
        return self.teeth > 0 and abs(self.lean) > WORM

    @property
    def pitch(self) -> float:
        """From tooth to tooth on the pitch circle (m); of what is smooth its circumference."""
        return 2.0 * pi * self.radius / (self.teeth or 1)


class DrawnBelt(NamedTuple):
    """A belt or chain: its closed line (n, 3) on the home drawing of the carrier `link`, in m, and
    its `width` along `axis`."""

    link: str
    line: tuple[Vector, ...]
    axis: Vector
    width: float


class DrawnScrew(NamedTuple):
    """A spindle and its nut.

    Attributes:
        link: the spindle's, on whose home drawing `on` stands: z the axis, the origin (m) where the
            nut is drawn.
        lead: m per turn, positive for a right-hand thread.
        bearing: where the spindle's own joint is on z, m.
        nut_link, nut: the nut's link, and its frame as drawn on that.
        slide: joint and sense of the nut's slide along z.
    """

    link: str
    on: Frame
    lead: float
    bearing: float
    nut_link: str
    nut: Frame
    slide: tuple[str, float]


class _Side(NamedTuple):
    """A wheel at the pitch point, as drawn on the carrier: its frame there, x towards that point,
    and the way to its link."""

    on: Frame
    radius: float
    turning: Turning
    teeth: int
    inner: bool = False
    apex: float = 0.0
    lean: float = 0.0


def drawn_couplings(
    fields: Fields, couplings: Mapping[str, AnyCoupling], mechanism: Mechanism
) -> tuple[tuple[DrawnWheel, ...], tuple[DrawnBelt, ...], tuple[DrawnScrew, ...]]:
    """The wheels and racks, belts and screws of a file without errors."""
    drawing = _Drawing(fields, mechanism)
    for name, section in couplings.items():
        if isinstance(section, GearCoupling):
            drawing.gear(name, section, mechanism.couplings[name])
        elif isinstance(section, RackCoupling):
            drawing.rack(name, section)
        elif isinstance(section, BeltCoupling | ChainCoupling) and len(section.joints) > 2:
            drawing.serpentine(name, section)
        elif isinstance(section, BeltCoupling | ChainCoupling):
            drawing.belt(name, section)
        elif isinstance(section, ScrewCoupling):
            drawing.screw(name, section)
    return (*drawing.layered(), tuple(drawing.screws))


class _Drawing:
    def __init__(self, fields: Fields, mechanism: Mechanism) -> None:
        self.fields = fields
        self.mechanism = mechanism
        self.joints: Mapping[str, Joint] = mechanism.joints
        self.wheels: list[DrawnWheel] = []
        self.belts: list[tuple[DrawnBelt, int]] = []
        self.screws: list[DrawnScrew] = []
        self.groups: list[int] = []
        """Of each wheel: couplings that share wheels are of one group."""

    def gear(self, name: str, section: GearCoupling, relation: Relation) -> None:
        """Two wheels that mesh."""
        pair = self._pair(section.joints)
        numbers = self._numbers(name, "radii", section.radii, LENGTH)
        teeth = self._numbers(name, "teeth", section.teeth, DIMENSIONLESS)
        sides = _meshing(pair, teeth or numbers, section.internal, relation)
        if sides is None:
            return
        whole = teeth is not None and all(abs(n - round(n)) < tolerances.PARALLEL for n in teeth)
        counts = [round(n) for n in teeth] if teeth is not None and whole else [0, 0]
        one, other = (s._replace(teeth=n) for s, n in zip(sides, counts, strict=True))
        width = FACE * min(one.radius, other.radius)
        widths = [width, width]
        for k, side in enumerate((one, other)):
            if abs(side.lean) > WORM:
                # five threads, and a wheel as wide as the worm
                widths[k] = 10.0 * pi * side.radius / (abs(side.lean) * max(side.teeth, 1))
                widths[1 - k] = 1.2 * side.radius
        flank = None if relation.mesh is None else relation.mesh.along
        self._mesh((one, other), (widths[0], widths[1]), flank)

    def rack(self, name: str, section: RackCoupling) -> None:
        """A pinion and its rack."""
        pinion, rack = (self.joints[each] for each in section.joints)
        carrier = next(iter({pinion.first, pinion.second} & {rack.first, rack.second}))
        radius = self.fields.number(("couplings", name, "radius"), section.radius, LENGTH)
        about, along = frame_on(pinion, carrier), frame_on(rack, carrier)
        pitch = along.o
        if section.at is not None:
            pitch = place_at(self.fields, ("couplings", name, "at"), section.at)
        lever = dot(cross(about.z, subtract(pitch, about.o)), along.z)
        outward = unit(scale(1.0 if lever > 0.0 else -1.0, cross(along.z, about.z)))
        wheel = against(pinion, carrier)
        side = _Side(frame_about(about.z, outward, about.o), radius, wheel, PINION_TEETH)
        at, found = self._wheel(side, FACE * radius, side.on.x, True)
        # the pinion's tooth next to the pitch point, along the pitch line, is in a gap of the rack
        way = 1.0 if dot(cross(about.z, outward), along.z) > 0.0 else -1.0
        off = way * _turn(side, self._mark(found, wheel)) * radius
        point = add(add(about.o, scale(radius, outward)), scale(off + 0.5 * found.pitch, along.z))
        frame = Frame(scale(-1.0, outward), cross(along.z, scale(-1.0, outward)), along.z, point)
        link = rack.second if rack.first == carrier else rack.first
        sense = 1 if rack.first == carrier else -1
        frame = self._on_link(frame, ((rack.name, -sense),))
        slide = (f"{rack.name}.s", float(sense))
        self.wheels.append(DrawnWheel(link, frame, radius, found.width, found.teeth, slide=slide))
        self.groups.append(self.groups[at])

    def belt(self, name: str, section: BeltCoupling | ChainCoupling) -> None:
        """Two pulleys and what runs over them."""
        carrier, first, second = self._pair(section.joints)
        crossed, counts = False, [0, 0]
        if isinstance(section, ChainCoupling):
            teeth = self._numbers(name, "teeth", section.teeth, DIMENSIONLESS) or (1.0, 1.0)
            pitch = self.fields.number(("couplings", name, "pitch"), section.pitch, LENGTH)
            counts = [round(n) for n in teeth]
            radii = (teeth[0] * pitch / (2.0 * pi), teeth[1] * pitch / (2.0 * pi))
        else:
            radii = self._numbers(name, "radii", section.radii, LENGTH) or (1.0, 1.0)
            crossed = section.crossed
        z, start = first.axis.z, first.axis.o
        apart = subtract(second.axis.o, start)
        across = subtract(apart, scale(dot(apart, z), z))
        distance = norm(across)
        along = scale(1.0 / distance, across)
        aside = cross(z, along)
        end = add(start, across)
        width = FACE * min(radii)
        way = dot(z, second.axis.z)
        sides = [
            _Side(Frame(along, cross(axis, along), axis, centre), radius, turning, count)
            for axis, centre, radius, turning, count in (
                (z, start, radii[0], first, counts[0]),
                (scale(way, z), end, radii[1], second, counts[1]),
            )
        ]
        placed = [self._wheel(side, 1.3 * width, along, True)[0] for side in sides]
        self._join(*placed)
        sine = (radii[0] + radii[1] if crossed else radii[0] - radii[1]) / distance
        touch = float(of_two("ATAN2", square_root(max(0.0, 1.0 - sine * sine)), sine))
        facing = (pi - touch, touch - pi) if crossed else (-touch, touch)
        arcs = (
            *_arc(start, radii[0], along, aside, (touch, 2.0 * pi - touch)),
            *_arc(end, radii[1], along, aside, facing),
        )
        self.belts.append((DrawnBelt(carrier, arcs, z, width), placed[0]))

    def screw(self, name: str, section: ScrewCoupling) -> None:
        """The part that turns as a spindle, the other one as its nut."""
        turning, sliding = (self.joints[each] for each in section.joints)
        carrier = next(iter({turning.first, turning.second} & {sliding.first, sliding.second}))
        about, along = frame_on(turning, carrier), frame_on(sliding, carrier)
        height = dot(subtract(along.o, about.o), about.z)
        on = frame_about(about.z, about.x, add(about.o, scale(height, about.z)))
        lead = self.fields.number(("couplings", name, "lead"), section.lead, LENGTH)
        spindle = against(turning, carrier)
        sense = 1 if sliding.first == carrier else -1
        self.screws.append(
            DrawnScrew(
                self._end(spindle),
                self._on_link(on, spindle.back),
                float(lead),
                -height,
                sliding.second if sense > 0 else sliding.first,
                self._on_link(on, ((sliding.name, -sense),)),
                (sliding.name, sense * (1.0 if dot(about.z, along.z) > 0.0 else -1.0)),
            )
        )

    def serpentine(self, name: str, section: BeltCoupling | ChainCoupling) -> None:
        """More than two pulleys and what runs over them."""
        path = ("couplings", name)
        radii = belt_radii(self.fields, path, section)
        loop = None if radii is None else belt_loop(self.fields, path, section, radii, self.joints)
        if loop is None:
            return
        counts = [0] * len(loop.wheels)
        if isinstance(section, ChainCoupling):
            teeth = (
                self.fields.number((*path, "teeth", i), text, DIMENSIONLESS)
                for i, text in enumerate(section.teeth)
            )
            counts = [round(float(number)) for number in teeth]
        width = FACE * min(place.radius for place in loop.places)
        first = 0
        line: list[Vector] = []
        for k, (wheel, place, count) in enumerate(
            zip(loop.wheels, loop.places, counts, strict=True)
        ):
            # from where the belt comes
            x = scale(place.side, cross(place.axis, loop.along[k - 1]))
            y = scale(-place.side, cross(place.axis, x))
            line += _arc(place.centre.vector, place.radius, x, y, (0.0, loop.wrap(k)))
            frame = Frame(x, cross(wheel.axis.z, x), wheel.axis.z, place.centre.vector)
            at, _ = self._wheel(_Side(frame, place.radius, wheel, count), 1.3 * width, x, True)
            first = at if k == 0 else first
            self._join(first, at)
        z = loop.places[0].axis
        self.belts.append((DrawnBelt(loop.carrier, tuple(line), z, width), first))

    def layered(self) -> tuple[tuple[DrawnWheel, ...], tuple[DrawnBelt, ...]]:
        """All of them; in a plane those of one shaft above one another."""
        belts = tuple(belt for belt, _ in self.belts)
        if not self.mechanism.plane or not self.wheels:
            return tuple(self.wheels), belts
        step = 1.4 * max(wheel.width for wheel in self.wheels)
        layers: dict[int, int] = {}
        for group in dict.fromkeys(self.groups):
            taken = {layers[other] for other in layers if self._overlap(group, other)}
            layers[group] = next(k for k in range(len(layers) + 1) if k not in taken)
        raised = tuple(
            wheel._replace(on=wheel.on._replace(o=_raised(wheel.on.o, layers[group] * step)))
            for wheel, group in zip(self.wheels, self.groups, strict=True)
        )
        return raised, tuple(
            belt._replace(line=tuple(_raised(p, layers[self.groups[at]] * step) for p in belt.line))
            for belt, at in self.belts
        )

    def _overlap(self, group: int, other: int) -> bool:
        one, two = (
            [w for w, g in zip(self.wheels, self.groups, strict=True) if g == each]
            for each in (group, other)
        )
        return any(norm(subtract(a.on.o, b.on.o)) < a.radius + b.radius for a in one for b in two)

    def _pair(self, names: Sequence[str]) -> tuple[str, Turning, Turning]:
        pair = on_one_carrier(self.joints[names[0]], self.joints[names[1]], self.joints)
        assert pair is not None
        return pair

    def _numbers(
        self, name: str, key: str, texts: Sequence[str] | None, dimension: Dimension
    ) -> tuple[float, float] | None:
        if texts is None:
            return None
        one, other = (
            float(self.fields.number(("couplings", name, key, i), text, dimension))
            for i, text in enumerate(texts)
        )
        return one, other

    def _mesh(
        self, sides: tuple[_Side, _Side], widths: tuple[float, float], flank: Vector | None
    ) -> None:
        """Both wheels, the second's teeth in the gaps of the first's; of one that is drawn already
        the teeth stand."""
        one, other = sides
        if self._known(one) is None and self._known(other) is not None:
            one, other, widths = other, one, (widths[1], widths[0])
        at, first = self._wheel(one, widths[0], one.on.x)
        mark = other.on.x
        if first.teeth and other.teeth:
            ways = [cross(side.on.z, side.on.x) for side in (one, other)]
            along = ways[0] if flank is None else flank
            same = dot(ways[0], along) * dot(ways[1], along) > 0.0
            turn = _turn(one, self._mark(first, one.turning)) * one.teeth / (2.0 * pi)
            turn = ((turn if same else -turn) + 0.5) * 2.0 * pi / other.teeth
            mark = add(scale(cos(turn), mark), scale(sin(turn), ways[1]))
        self._join(at, self._wheel(other, widths[1], mark)[0])

    def _wheel(
        self, side: _Side, width: float, mark: Vector, any_teeth: bool = False
    ) -> tuple[int, DrawnWheel]:
        """A wheel with a tooth at `mark` on the carrier, or the one that is drawn there already."""
        known = self._known(side, any_teeth)
        if known is not None:
            return known, self.wheels[known]
        frame = self._on_link(frame_about(side.on.z, mark, side.on.o), side.turning.back)
        made = DrawnWheel(
            self._end(side.turning),
            frame,
            side.radius,
            width,
            side.teeth,
            side.inner,
            side.apex,
            side.lean,
        )
        self.wheels.append(made)
        self.groups.append(len(self.wheels) - 1)
        return len(self.wheels) - 1, made

    def _known(self, side: _Side, any_teeth: bool = False) -> int | None:
        """The number of a wheel of the same link, place, radius and teeth."""
        link, near = self._end(side.turning), tolerances.PARALLEL * side.radius
        place = self._on_link(side.on, side.turning.back).o
        for number, wheel in enumerate(self.wheels):
            if (
                wheel.link == link
                and wheel.slide is None
                and wheel.inner == side.inner
                and (any_teeth or wheel.teeth == side.teeth)
                and abs(wheel.radius - side.radius) <= near
                and norm(subtract(wheel.on.o, place)) <= near
            ):
                return number
        return None

    def _join(self, one: int, other: int) -> None:
        kept, gone = sorted((self.groups[one], self.groups[other]))
        self.groups = [kept if each == gone else each for each in self.groups]

    def _mark(self, wheel: DrawnWheel, turning: Turning) -> Vector:
        """The mark of a wheel as drawn on the carrier."""
        return self._on_link(wheel.on, turning.way).x

    def _end(self, turning: Turning) -> str:
        name, sense = turning.way[0]
        return self.joints[name].first if sense > 0 else self.joints[name].second

    def _on_link(self, frame: Frame, way: Sequence[tuple[str, int]]) -> Frame:
        """A frame drawn on one link as it is drawn on that at the end of a way."""
        for name, sense in way:
            joint = self.joints[name]
            one, other = joint.on_first, joint.on_second
            if sense < 0:
                one, other = other, one
            frame = other.carry(one.of(frame))
        return frame


def _meshing(
    pair: tuple[str, Turning, Turning],
    numbers: tuple[float, float] | None,
    internal: bool,
    relation: Relation,
) -> tuple[_Side, _Side] | None:
    """Both wheels at their pitch point; None where it is not known."""
    _, first, second = pair
    one, other = first.axis, second.axis
    normal, apart = cross(one.z, other.z), subtract(other.o, one.o)
    oblique = norm(normal) > tolerances.PARALLEL
    if numbers is None:
        return None
    ring = (internal and numbers[0] > numbers[1], internal and numbers[1] > numbers[0])
    if relation.mesh is not None:
        point = relation.mesh.point
    elif oblique:
        return None
    else:
        across = subtract(apart, scale(dot(apart, one.z), one.z))
        total = abs(numbers[1] - numbers[0]) if internal else numbers[0] + numbers[1]
        distance = norm(across)
        if total == 0.0 or distance == 0.0:
            return None
        beyond = -1.0 if ring[1] else 1.0
        point = add(one.o, scale(beyond * numbers[0] / total, across))
    apexes = [0.0, 0.0]
    sides: list[_Side] = []
    for axis, turning, inner in ((one, first, ring[0]), (other, second, ring[1])):
        centre = add(axis.o, scale(dot(subtract(point, axis.o), axis.z), axis.z))
        arm = subtract(point, centre)
        radius = norm(arm)
        if radius == 0.0:
            return None
        sides.append(_Side(frame_about(axis.z, arm, centre), radius, turning, 0, inner))
    if oblique:
        foot = add(one.o, scale(dot(cross(apart, other.z), normal) / dot(normal, normal), one.z))
        if abs(dot(subtract(foot, other.o), unit(normal))) <= tolerances.PARALLEL * sides[0].radius:
            apexes = [dot(subtract(foot, side.on.o), side.on.z) for side in sides]
            return (sides[0]._replace(apex=apexes[0]), sides[1]._replace(apex=apexes[1]))
    if relation.mesh is not None:
        trace = cross(sides[0].on.x, relation.mesh.along)
        for k, side in enumerate(sides):
            along = dot(trace, side.on.z)
            if along != 0.0:
                sides[k] = side._replace(lean=dot(trace, side.on.y) / along)
    return sides[0], sides[1]


def _turn(side: _Side, mark: Vector) -> float:
    """The angle from the pitch point to a mark, about the wheel's axis as drawn on the carrier."""
    return float(of_two("ATAN2", dot(mark, side.on.y), dot(mark, side.on.x)))


def _arc(
    centre: Vector, radius: float, x: Vector, y: Vector, ends: tuple[float, float]
) -> Iterator[Vector]:
    """Places on a circle from angle to angle."""
    steps = 24
    for k in range(steps + 1):
        turn = ends[0] + (ends[1] - ends[0]) * k / steps
        yield add(centre, add(scale(radius * cos(turn), x), scale(radius * sin(turn), y)))


def _raised(point: Vector, by: float) -> Vector:
    return (point[0], point[1], point[2] + by)
