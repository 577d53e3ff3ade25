"""`view:` - the settings of a view, with links and points that exist and lengths in SI."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from mechkin_cli.building.cables import DrawnCable, drawn_cables
from mechkin_cli.building.drawn_wheels import (
    DrawnBelt,
    DrawnScrew,
    DrawnWheel,
    drawn_couplings,
)
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.expressions import parse
from mechkin_cli.mechanism import GROUND_NAME, Attached, Mechanism, Vector, is_written
from mechkin_cli.record import NamedTuple, dataclass, field
from mechkin_cli.units import LENGTH, TIME

if TYPE_CHECKING:
    from mechkin_cli.schema import AnyCoupling, Cylinder, PartBetween, ShapeOfLink, ViewSection
    from mechkin_cli.units import Dimension


Kind = Literal["rod", "plate", "star", "cylinder", "wheel", "none"]


class ShapeSetting(NamedTuple):
    """The shape of a link: its `kind` (None: as its points lie), the `points` (m, as drawn) that it
    goes through (None: its joints and named points), `radius` and `width` in m (None: the page's
    choice), and the `axis` of a wheel, a unit vector as drawn."""

    kind: Kind | None = None
    points: tuple[Vector, ...] | None = None
    radius: float | None = None
    width: float | None = None
    axis: Vector | None = None


class DrawnBetween(NamedTuple):
    """What is drawn between two points of links: `radius` in m (None: the page's choice); of a
    cylinder the `stroke`, its least and its largest length in m (None: as far as it moves)."""

    kind: Literal["spring", "damper", "cylinder"]
    ends: tuple[Attached, Attached]
    radius: float | None = None
    stroke: tuple[float, float] | None = None


@dataclass(frozen=True)
class ViewSettings:
    """How a mechanism is shown.

    Attributes:
        colours: of links by name, `#rrggbb`.
        hidden: links that are not drawn.
        shapes: of links by name.
        between: what is drawn between points.
        joint_radius: m; None: by the size of the mechanism.
        paths: named points whose paths are drawn; None: all.
        forces: whether arrows are shown at first.
        arrow_length: of the longest arrow, m; None: by the size of the mechanism.
        camera: direction from the mechanism to the eye; None: the page's choice.
        parameters: the ends of their sliders by name, in the file's units.
        speed: seconds for once through a run; None: the page's choice.
        wheels, belts, cables, screws: what couplings look like.
    """

    colours: Mapping[str, str] = field(default_factory=dict)
    hidden: frozenset[str] = frozenset()
    shapes: Mapping[str, ShapeSetting] = field(default_factory=dict)
    between: tuple[DrawnBetween, ...] = ()
    joint_radius: float | None = None
    paths: frozenset[str] | None = None
    forces: bool = True
    arrow_length: float | None = None
    camera: Vector | None = None
    parameters: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    speed: float | None = None
    wheels: tuple[DrawnWheel, ...] = ()
    belts: tuple[DrawnBelt, ...] = ()
    cables: tuple[DrawnCable, ...] = ()
    screws: tuple[DrawnScrew, ...] = ()


def build_view(
    fields: Fields,
    section: ViewSection | None,
    couplings: Mapping[str, AnyCoupling],
    cylinders: Mapping[str, Cylinder],
    mechanism: Mechanism,
) -> ViewSettings:
    """The settings of the section, and how couplings and cylinders look; errors are noted in
    `fields`."""
    known = {} if fields.error_count else couplings
    wheels, belts, screws = drawn_couplings(fields, known, mechanism)
    cables = () if fields.error_count else drawn_cables(fields, couplings, mechanism)
    tubes = () if fields.error_count else tuple(_cylinders(fields, cylinders, mechanism))
    if section is None:
        return ViewSettings(wheels=wheels, belts=belts, cables=cables, screws=screws, between=tubes)
    view = _View(fields, mechanism)
    camera = section.camera
    return ViewSettings(
        colours=dict(view.of_links("colours", section.colours)),
        hidden=view.existing("hidden", section.hidden, view.known, "link"),
        shapes={
            name: view.shape(name, shape) for name, shape in view.of_links("shapes", section.shapes)
        },
        between=(*tubes, *view.between(section.between)),
        joint_radius=view.positive("joint_radius", section.joint_radius, LENGTH),
        paths=None
        if section.paths is None
        else view.existing("paths", section.paths, list(mechanism.points), "point"),
        forces=section.forces == "shown",
        arrow_length=view.positive("arrow_length", section.arrow_length, LENGTH),
        camera=None if camera is None else fields.direction(("view", "camera"), camera),
        parameters=dict(view.sliders(section.parameters)),
        speed=view.positive("speed", section.speed, TIME),
        wheels=wheels,
        belts=belts,
        cables=cables,
        screws=screws,
    )


def _cylinders(
    fields: Fields, cylinders: Mapping[str, Cylinder], mechanism: Mechanism
) -> Iterator[DrawnBetween]:
    """Cylinders of a file without errors, from eye to eye, a little wider than their bore."""
    for name, section in cylinders.items():
        ends = mechanism.points[section.first], mechanism.points[section.last]
        radius = None
        if section.bore is not None:
            radius = 0.6 * fields.number(("cylinders", name, "bore"), section.bore, LENGTH)
        stroke = None
        if section.stroke is not None:
            low, high = (
                float(fields.number(("cylinders", name, "stroke", i), text, LENGTH))
                for i, text in enumerate(section.stroke)
            )
            stroke = low, high
        yield DrawnBetween("cylinder", ends, radius, stroke)


class _View:
    def __init__(self, fields: Fields, mechanism: Mechanism) -> None:
        self.fields = fields
        self.mechanism = mechanism
        self.known = [GROUND_NAME, *(name for name in mechanism.links if is_written(name))]

    def existing(
        self, key: str, names: Iterable[str], known: list[str], what: str
    ) -> frozenset[str]:
        """Those of the names that are known."""
        each = enumerate(names)
        return frozenset(n for at, n in each if self._exists(("view", key, at), n, known, what))

    def of_links(self, key: str, entries: Mapping[str, Any]) -> list[tuple[str, Any]]:
        """Those entries of a mapping that belong to links."""
        known = []
        for name, value in entries.items():
            hint = self._hint(name, self.known)
            if hint is None:
                known.append((name, value))
            elif not self.fields.is_refused(name):
                text = f"there is no link {name}"
                self.fields.key_error("unknown-name", ("view", key, name), text, hint)
        return known

    def shape(self, link: str, section: ShapeOfLink) -> ShapeSetting:
        """The shape of a link."""
        path: Path = ("view", "shapes", link)
        before = self.fields.error_count
        given = None
        if section.points is not None:
            found = [self._point(link, at, point) for at, point in enumerate(section.points)]
            given = tuple(point for point in found if point is not None)
        radius = self.positive("radius", section.radius, LENGTH, path)
        width = self.positive("width", section.width, LENGTH, path)
        axis = None
        if section.axis is not None:
            axis = self.fields.direction((*path, "axis"), section.axis)
        if section.kind == "wheel" and self.fields.error_count == before:
            given, axis = self._wheel(link, section, given, axis)
        return ShapeSetting(section.kind, given, radius, width, axis)

    def _wheel(
        self,
        link: str,
        section: ShapeOfLink,
        points: tuple[Vector, ...] | None,
        axis: Vector | None,
    ) -> tuple[tuple[Vector, ...], Vector | None]:
        """The centre of a wheel and its axis, which is that of the joint at its centre where it has
        none."""
        path: Path = ("view", "shapes", link)
        joints = {name: at for name, at in self.mechanism.joint_points() if at.link == link}
        name = next(iter(joints), None) if section.points is None else section.points[0]
        if points is None:
            if name is None:
                text = f"the wheel {link} has no joint that would be its centre"
                self.fields.error("missing-key", path, text, "add `points:` with the centre")
                return (), axis
            points = (joints[str(name)].vector,)
        if axis is None and self.mechanism.plane:
            axis = (0.0, 0.0, 1.0)
        joint = self.mechanism.joints.get(name) if isinstance(name, str) else None
        if axis is None and joint is not None and joint.type.axis is not None:
            axis = joint.axis.vector
        if axis is None:
            where = f"{name}" if isinstance(name, str) else "its centre"
            text = f"the wheel {link} has no axis: {where} is no joint that has one"
            self.fields.error("missing-key", path, text, "add `axis: [x, y, z]`")
        return points[:1], axis

    def between(self, parts: Sequence[PartBetween]) -> Iterator[DrawnBetween]:
        """What is drawn between points that exist."""
        known = list(self.mechanism.points)
        for at, part in enumerate(parts):
            path: Path = ("view", "between", at)
            radius = self.positive("radius", part.radius, LENGTH, path)
            found = [
                self._exists((*path, "points", k), name, known, "point")
                for k, name in enumerate(part.points)
            ]
            if all(found):
                first, second = (self.mechanism.points[name] for name in part.points)
                yield DrawnBetween(part.kind, (first, second), radius)

    def sliders(
        self, sections: Mapping[str, Sequence[str]]
    ) -> Iterator[tuple[str, tuple[float, float]]]:
        """The ends of sliders of parameters that have one, in the file's units."""
        parameters = self.fields.parameters
        for name, texts in sections.items():
            path: Path = ("view", "parameters", name)
            hint = self._hint(name, list(parameters))
            if hint is not None:
                if not self.fields.is_refused(name):
                    text = f"there is no parameter {name}"
                    self.fields.key_error("unknown-name", path, text, hint)
                continue
            followed = self._followed(name)
            if followed:
                text = f"{name} follows from {followed} and has no slider"
                self.fields.key_error("needless-key", path, text, f"leave {name} out")
                continue
            before = self.fields.error_count
            dimension = parameters[name].dimension
            low, high = (
                self.fields.written((*path, k), text, dimension) for k, text in enumerate(texts)
            )
            if self.fields.error_count > before:
                continue
            if low < high:
                yield name, (low, high)
            else:
                text = f"there is nothing between {texts[0]} and {texts[1]}"
                self.fields.error("bad-value", path, text, "write the smaller end first")

    def _followed(self, name: str) -> str:
        """The parameters that one is written with."""
        section = self.fields.document.data["parameters"]
        return ", ".join(sorted(parse(str(section[name])).names))  # type: ignore[index, call-overload]

    def positive(
        self, key: str, text: str | None, dimension: Dimension, path: Path = ("view",)
    ) -> float | None:
        """A number above zero; None where the section at the path has none."""
        if text is None:
            return None
        before = self.fields.error_count
        value = self.fields.number((*path, key), text, dimension)
        if value <= 0.0 and self.fields.error_count == before:
            self.fields.error("not-positive", (*path, key), f"{key} is above zero")
        return value

    def _point(self, link: str, at: int, point: str | tuple[str, ...]) -> Vector | None:
        path: Path = ("view", "shapes", link, "points", at)
        if not isinstance(point, str):
            return self.fields.place(path, point)
        places = (*self.mechanism.joint_points(), *self.mechanism.points.items())
        own = {name: on.vector for name, on in places if on.link == link}
        known = self._exists(path, point, list(own), f"joint or point of {link}")
        return own[point] if known else None

    def _exists(self, path: Path, name: str, known: list[str], what: str) -> bool:
        hint = self._hint(name, known)
        if hint is not None and not self.fields.is_refused(name):
            self.fields.error("unknown-name", path, f"there is no {what} {name}", hint)
        return hint is None

    def _hint(self, name: str, known: list[str]) -> str | None:
        """A hint for a name that is not known; None for one that is."""
        if name in known:
            return None
        return nearest_hint(name, known) or f"there are {', '.join(known) or 'none'}"
