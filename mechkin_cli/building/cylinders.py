"""`cylinders:` to what they are made of: two links without mass between balls (in a plane pins),
which slide on each other; limits by the stroke, expressions of length, force and pressure.

The slide has the cylinder's name, and its coordinate is the length from eye to eye. Links and eyes
have names with a dot, as what guides a point.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.joints import Halves, parts_of
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.expressions import ExpressionError, literal, parse
from mechkin_cli.mechanism import (
    GROUND,
    Attached,
    Frame,
    Joint,
    Part,
    RigidLink,
    frame_about,
    joint_type,
    norm,
    perpendicular,
    scale,
    subtract,
    upright,
)
from mechkin_cli.schema import Cylinder, MechanismFile
from mechkin_cli.tolerances import SMALLEST_SIZE
from mechkin_cli.units import LENGTH

SLIDE = "s"
"""The coordinate of a cylinder."""


def define_cylinders(fields: Fields, file: MechanismFile) -> None:
    """Puts the quantities of cylinders into `fields.definitions`, as expressions of the slide and
    its effort: `C.length`, `C.force`, positive where it pushes the eyes apart, and `C.pressure`,
    the force by the area on whose side the oil is: positive on that of the piston, negative on the
    ring about the rod."""
    for name, section in file.cylinders.items():
        texts = {"length": f"{name}.{SLIDE}", "force": f"{name}.{SLIDE}.effort"}
        if section.bore is not None:
            bore = _with_unit(fields, section.bore)
            rod = "(0 m)" if section.rod is None else _with_unit(fields, section.rod)
            force = texts["force"]
            area = f"if({force} < 0 N, {bore}^2 - {rod}^2, {bore}^2)"
            texts["pressure"] = f"{force} / (pi/4 * {area})"
        for word, text in texts.items():
            try:
                expression = parse(text)
            except ExpressionError:
                continue  # told where the number is read
            fields.definitions = fields.definitions.adding(f"{name}.{word}", expression)


def _with_unit(fields: Fields, text: str) -> str:
    return f"({text} {fields.units.label(LENGTH)})" if literal(text) is not None else f"({text})"


def build_cylinders(
    fields: Fields,
    cylinders: Mapping[str, Cylinder],
    points: Mapping[str, Attached],
) -> tuple[dict[str, RigidLink], dict[str, Joint]]:
    """Links and joints of all cylinders, by name, drawn between their named points (m); errors are
    noted in `fields`, and the names of such cylinders in `fields.refused`."""
    links: dict[str, RigidLink] = {}
    joints: dict[str, Joint] = {}
    for name, section in cylinders.items():
        path: Path = ("cylinders", name)
        _check_sizes(fields, path, section)
        ends = list(_ends(fields, path, section, points))
        if len(ends) < 2 or not _are_apart(fields, path, *ends):
            fields.refused.add(name)
            continue
        tube, rod = f"{name}.tube", f"{name}.rod"
        links |= {tube: RigidLink(tube), rod: RigidLink(rod)}
        foot, head = ends
        joints[f"{name}.foot"] = _eye(fields, f"{name}.foot", foot.link, tube, foot)
        joints[name] = _slide(fields, name, tube, rod, foot, head)
        joints[f"{name}.head"] = _eye(fields, f"{name}.head", rod, head.link, head)
    return links, joints


def _ends(
    fields: Fields, path: Path, section: Cylinder, points: Mapping[str, Attached]
) -> Iterator[Attached]:
    for key, name in (("from", section.first), ("to", section.last)):
        if name in points:
            yield points[name]
        elif not fields.is_refused(name):
            hint = nearest_hint(name, list(points)) or "name it under points"
            fields.error("unknown-point", (*path, key), f"there is no point {name}", hint)


def _are_apart(fields: Fields, path: Path, foot: Attached, head: Attached) -> bool:
    if foot.link == head.link:
        text = f"both points of this cylinder are fixed in {foot.link}"
        fields.error("same-link", (*path, "to"), text, "name points of two links")
        return False
    apart = norm(subtract(head.vector, foot.vector))
    if not apart >= SMALLEST_SIZE:
        text = "the points of this cylinder are drawn at one place, which gives it no direction"
        fields.error("no-length", (*path, "to"), text, "draw them apart")
        return False
    return True


def _check_sizes(fields: Fields, path: Path, section: Cylinder) -> None:
    """Notes a piston or a rod that is none; a rod is thinner than its piston."""
    sizes: dict[str, float] = {}
    errors = fields.error_count
    for key, text in (("bore", section.bore), ("rod", section.rod)):
        if text is None:
            continue
        sizes[key] = fields.number((*path, key), text, LENGTH)
        if fields.error_count == errors and not sizes[key] > tolerances.SMALLEST_DIVISOR:
            text = f"the {key} of a cylinder is a diameter above zero"
            fields.error("no-diameter", (*path, key), text, "write its diameter")
    if "rod" in sizes and fields.error_count == errors and not sizes["rod"] < sizes["bore"]:
        text = "the rod is no thinner than the piston"
        fields.error("thick-rod", (*path, "rod"), text, "check both diameters")


def _eye(fields: Fields, name: str, first: str, second: str, at: Attached) -> Joint:
    """The ball, in a plane the pin, of an eye."""
    kind = joint_type("R" if fields.plane else "S", fields.plane)
    frame = frame_about(GROUND.z, GROUND.x, at.vector) if fields.plane else upright(at.vector)
    parts = parts_of(kind, Halves(frame, frame, (frame, frame)))
    return Joint(name, kind.letter, first, second, frame, frame, parts, plane=fields.plane)


def _slide(fields: Fields, name: str, tube: str, rod: str, foot: Attached, head: Attached) -> Joint:
    """The slide of the rod, whose coordinate as drawn is the distance of the eyes."""
    kind = joint_type("P", fields.plane)
    span = subtract(head.vector, foot.vector)
    length = norm(span)
    along = scale(1.0 / length, span)
    across = GROUND.z if fields.plane else perpendicular(along)
    before = frame_about(along, across, foot.vector)
    after = Frame(before.x, before.y, before.z, head.vector)
    parts = (Part("P", before, after, length),)
    return Joint(name, kind.letter, tube, rod, before, after, parts, plane=fields.plane)
