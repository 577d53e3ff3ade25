"""Places in the home drawing, as coordinates or as the names of points; and the named points.

A name stands for the place where its point is drawn. What is fixed in a link, a mass centre or the
point of a force, moves with that link, so the point that it is named by has to be one of that link;
the halves of a joint may meet at any place of the drawing.
"""

from __future__ import annotations

from collections.abc import Iterable

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.mechanism.model import GROUND_NAME, Attached
from mechkin_cli.mechanism.vectors import ZERO, Vector
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.units import LENGTH


def read_points(fields: Fields, file: MechanismFile) -> dict[str, Attached]:
    """The named points of the file, which `fields` knows from here on; what is wrong is noted."""
    links = dict.fromkeys([*file.links, *(row.link for row in file.chain)])
    links.pop(GROUND_NAME, None)
    drawn = {
        name: fields.vector(("points", name, "at"), point.at, LENGTH)
        for name, point in file.points.items()
        if not isinstance(point.at, str)
    }
    for name in file.points:
        _follow(fields, file, name, drawn)
    for name, point in file.points.items():
        if is_link(fields, ("points", name, "link"), point.link, links) and name in drawn:
            fields.points[name] = Attached(point.link, drawn[name])
    return dict(fields.points)


def place_at(
    fields: Fields, path: Path, given: str | tuple[str, ...], link: str | None = None
) -> Vector:
    """A place in the drawing, in m; where it is fixed in a `link`, a name has to be of a point of
    that link. What is wrong is noted, and zero stands in."""
    if not isinstance(given, str):
        return fields.vector(path, given, LENGTH)
    if given not in fields.points:
        _refuse_unknown(fields, path, given)
        return ZERO
    point = fields.points[given]
    if link is not None and point.link != link:
        text = f"{given} is a point of {point.link}, and this place moves with {link}"
        hint = f"name one of {link}, such as {given}_of_{link}: {{link: {link}, at: {given}}}"
        fields.error("point-of-another-link", path, text, hint)
    return point.vector


def is_link(fields: Fields, path: tuple[str, ...], name: str, links: Iterable[str]) -> bool:
    """Whether a link is there; if not, that is noted once, at the path of its name."""
    if name == GROUND_NAME or name in links:
        return True
    fields.refused.add(path[1])
    hint = nearest_hint(name, [GROUND_NAME, *links])
    fields.error("unknown-link", path, f"there is no link {name}", hint)
    return False


def _follow(fields: Fields, file: MechanismFile, name: str, drawn: dict[str, Vector]) -> None:
    """Puts a point, and those on the way, at the place of the point that its `at` leads to."""
    way: list[str] = []
    while name not in drawn and name in file.points and name not in fields.refused:
        if name in way:
            circle = " -> ".join([*way[way.index(name) :], name])
            text = f"the place of {name} leads back to itself: {circle}"
            fields.error("circular-place", ("points", name, "at"), text, "write coordinates here")
            fields.refused.update(way)
            return
        way.append(name)
        at = file.points[name].at
        assert isinstance(at, str)
        name = at
    if name in drawn:
        drawn.update(dict.fromkeys(way, drawn[name]))
        return
    if way:
        _refuse_unknown(fields, ("points", way[-1], "at"), name)
        fields.refused.update(way)


def _refuse_unknown(fields: Fields, path: Path, name: str) -> None:
    if fields.is_refused(name):
        return
    data = fields.document.data
    section = data.get("points")
    known = list(section) if isinstance(section, dict) else []
    joints = data.get("joints")
    is_joint = isinstance(joints, dict) and name in joints
    hint = f"{name} is a joint: name its point under points" if is_joint else None
    hint = hint or nearest_hint(name, known) or "name it under points"
    fields.error("unknown-point", path, f"there is no point {name}", hint)
