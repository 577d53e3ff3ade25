"""`view:` - the settings of a view, with links and points that exist and lengths in SI."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.mechanism import GROUND_NAME, Mechanism, Vector, is_written
from mechkin_cli.record import dataclass, field
from mechkin_cli.units import LENGTH, TIME

if TYPE_CHECKING:
    from mechkin_cli.schema import ShapeOfLink, ViewSection
    from mechkin_cli.units import Dimension


Kind = Literal["rod", "plate", "star", "none"]


ShapeSetting = tuple[Kind | None, tuple[Vector, ...] | None]
"""The shape of a link: its kind (None: as its points lie), and the points (m, as drawn) that it
goes through (None: its joints and named points)."""


@dataclass(frozen=True)
class ViewSettings:
    """How a mechanism is shown.

    Attributes:
        colours: of links by name, `#rrggbb`.
        hidden: links that are not drawn.
        shapes: of links by name.
        joint_radius: m; None: by the size of the mechanism.
        paths: named points whose paths are drawn; None: all.
        forces: whether arrows are shown at first.
        arrow_length: of the longest arrow, m; None: by the size of the mechanism.
        camera: direction from the mechanism to the eye; None: the page's choice.
        speed: seconds for once through a run; None: the page's choice.
    """

    colours: Mapping[str, str] = field(default_factory=dict)
    hidden: frozenset[str] = frozenset()
    shapes: Mapping[str, ShapeSetting] = field(default_factory=dict)
    joint_radius: float | None = None
    paths: frozenset[str] | None = None
    forces: bool = True
    arrow_length: float | None = None
    camera: Vector | None = None
    speed: float | None = None


def build_view(fields: Fields, section: ViewSection, mechanism: Mechanism) -> ViewSettings:
    """The settings of the section; errors are noted in `fields`."""
    view = _View(fields, mechanism)
    camera = section.camera
    return ViewSettings(
        colours=dict(view.of_links("colours", section.colours)),
        hidden=view.existing("hidden", section.hidden, view.known, "link"),
        shapes={
            name: view.shape(name, shape) for name, shape in view.of_links("shapes", section.shapes)
        },
        joint_radius=view.positive("joint_radius", section.joint_radius, LENGTH),
        paths=None
        if section.paths is None
        else view.existing("paths", section.paths, list(mechanism.points), "point"),
        forces=section.forces == "shown",
        arrow_length=view.positive("arrow_length", section.arrow_length, LENGTH),
        camera=None if camera is None else fields.direction(("view", "camera"), camera),
        speed=view.positive("speed", section.speed, TIME),
    )


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
        if section.points is None:
            return section.kind, None
        points = [self._point(link, at, point) for at, point in enumerate(section.points)]
        return section.kind, tuple(point for point in points if point is not None)

    def positive(self, key: str, text: str | None, dimension: Dimension) -> float | None:
        """A number above zero; None where the section has none."""
        if text is None:
            return None
        before = self.fields.error_count
        value = self.fields.number(("view", key), text, dimension)
        if value <= 0.0 and self.fields.error_count == before:
            self.fields.error("not-positive", ("view", key), f"{key} is above zero")
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
