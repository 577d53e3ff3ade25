"""Links and joints of the file to those of the mechanism: bodies, links checked, frames drawn on
both links; the joints of `joints:` and `chain:`, and the way to ground.

A vector may be given for either link; one vector stands for both. Pairs with two turns turn about a
direction of the first link, then about one of the second: both frames have x square to the two
directions as drawn (the first cross the second) and z along their own; slides come before the turns
or after them.

Rows (theta, s, alpha, a) of a chain become joints and links of the mechanism. With Z(theta, s) a
screw about and along z, and X(alpha, a) one about and along x, the frame behind row i is F_i =
F_(i-1) Z(theta_i, s_i) X(alpha_i, a_i), from F_0, the ground axes, on; a loop closes with F_n =
F_0. Joint i lies on z of F_(i-1); its point is the foot of the common normal behind it, which is
the origin of F_(i-1) Z(theta_i, s_i). That is the drawing, where all coordinates are zero: the
angle from x to x about the axis is theta_i plus the joint's coordinate. Row n is drawn twice,
behind the rows before it and in front of the ground axes, X(alpha_n, a_n)^-1: where the two differ,
the drawing is not assembled. Source: J. Denavit, R. S. Hartenberg, A kinematic notation for
lower-pair mechanisms, 1955.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path, place_at
from mechkin_cli.building.tracks import along_line, carried_joint, is_carried
from mechkin_cli.diagnostics import Diagnostic, Number, nearest_hint
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    ZERO,
    Drawing,
    DrawnDirection,
    Frame,
    Joint,
    JointType,
    Part,
    RigidLink,
    Tensor,
    Vector,
    add,
    cross,
    dot,
    frame_about,
    joint_type,
    norm,
    perpendicular,
    scale,
    subtract,
    turned_shortest,
    unit,
    upright,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import (
    AnyAxisJoint,
    AnyJoint,
    AxisJoint,
    ChainRow,
    CylinderPlaneJoint,
    HelicalJoint,
    MechanismFile,
    PlanarJoint,
    PointJoint,
    SlottedSphereJoint,
    SphereCylinderJoint,
    SphereGrooveJoint,
    SpherePlaneJoint,
    UniversalJoint,
    links_joints as written,
)
from mechkin_cli.tape import (
    Recorded,
    TraceLost,
    advice,
    by_rounding,
    cos,
    either,
    is_settled,
    largest,
    sin,
)
from mechkin_cli.tolerances import AXES_SQUARE, PARALLEL
from mechkin_cli.units import ANGLE, INERTIA, LENGTH, MASS


class Halves(NamedTuple):
    """A pair's frames as drawn on its two links.

    `meeting`: frames, one on either drawing, that coincide where the coordinates are zero, of the
    part that leads from one drawing to the other; `own`: a frame beside them.
    """

    on_first: Frame
    on_second: Frame
    meeting: tuple[Frame, Frame]
    own: Frame | None = None

    def along(self, direction: DrawnDirection) -> Frame:
        """The frame of a part that is drawn on one link, z along the direction."""
        frame = (self.on_first, self.on_second)[direction.side]
        if direction.axis == "own":
            assert self.own is not None
            return self.own
        if direction.axis == "z" and not direction.reverse:
            return frame
        along: Vector = getattr(frame, direction.axis)
        across = frame.x if direction.axis == "z" else frame.z
        return frame_about(scale(-1.0, along) if direction.reverse else along, across, frame.o)


def points_of(fields: Fields, path: Path, section: PointJoint) -> tuple[Vector, Vector]:
    """The joint's point on either link, in m."""
    read = partial(place_at, fields)
    return _per_link(read, (*path, "point"), section.point, section.links)


def directions_of(
    fields: Fields, path: Path, section: PointJoint, key: str
) -> tuple[Vector, Vector]:
    """The unit vector under `key` on either link."""
    return _per_link(fields.direction, (*path, key), getattr(section, key), section.links)


def place_of(path: Path, section: PointJoint, key: str, side: int) -> Path:
    """The path in the file of the vector for the first (0) or second (1) link."""
    value = getattr(section, key)
    return (*path, key, section.links[side]) if isinstance(value, Mapping) else (*path, key)


def _per_link(
    read: Callable[[Path, Any], Vector], path: Path, value: Any, links: Sequence[str]
) -> tuple[Vector, Vector]:
    if isinstance(value, Mapping):
        return read((*path, links[0]), value[links[0]]), read((*path, links[1]), value[links[1]])
    both = read(path, value)
    return both, both


def build_joints(
    fields: Fields, sections: Mapping[str, AnyJoint], links: Mapping[str, object]
) -> dict[str, Joint]:
    """All joints whose links exist; errors are noted in `fields`."""
    joints = {}
    for name, section in sections.items():
        unknown = [link for link in section.links if link != GROUND_NAME and link not in links]
        for i, link in enumerate(section.links):
            if link in unknown:
                hint = nearest_hint(link, [GROUND_NAME, *links])
                path = ("joints", name, "links", i)
                fields.error("unknown-link", path, f"there is no link {link}", hint)
        joint = _build(fields, name, section)
        if unknown:
            fields.refused.add(name)
        else:
            joints[name] = joint
    return joints


def _build(fields: Fields, name: str, section: AnyJoint) -> Joint:
    path: Path = ("joints", name)
    first, second = section.links
    if is_carried(section):
        assert isinstance(section, PointJoint)
        return carried_joint(fields, name, section, points_of(fields, path, section))
    kind = joint_type(section.type, fields.plane)
    halves = DRAWINGS[kind.drawing.kind](fields, path, section, kind.drawing)
    lead = 0.0
    if isinstance(section, HelicalJoint):
        lead = lead_of(fields, (*path, "lead"), section.lead)
    parts = parts_of(kind, halves)
    frames = halves.on_first, halves.on_second
    return Joint(name, kind.letter, first, second, *frames, parts, lead, fields.plane)


def parts_of(kind: JointType, halves: Halves) -> tuple[Part, ...]:
    """The chain of a pair as drawn."""
    parts = []
    for step in kind.steps:
        still = halves.along(step.along) if step.along else None
        parts.append(Part(step.letter, *((still, still) if still else halves.meeting)))
    return tuple(parts)


def lead_of(fields: Fields, path: Path, text: str) -> float:
    """The lead of a helical joint in m; zero is noted in `fields`."""
    errors = fields.error_count
    lead = fields.number(path, text, LENGTH)
    if lead == 0.0 and fields.error_count == errors:
        fields.error("zero-lead", path, "the lead is zero", "use type R for no slide")
    return lead


def _axis(fields: Fields, path: Path, section: AnyAxisJoint, drawing: Drawing) -> Halves:
    """z along the axis on either link."""
    points = points_of(fields, path, section)
    errors = fields.error_count
    axes = directions_of(fields, path, section, *drawing.keys)
    x_first, x_second = _zero_directions(fields, path, section, axes, errors)
    on_first = frame_about(axes[0], x_first, points[0])
    on_second = frame_about(axes[1], x_second, points[1])
    return Halves(on_first, on_second, (on_first, on_second))


def _ball(fields: Fields, path: Path, section: PointJoint, _: Drawing) -> Halves:
    """Ground axes at the sphere's centre."""
    first, second = points_of(fields, path, section)
    meeting = upright(first), upright(second)
    return Halves(*meeting, meeting)


def _ball_on(
    fields: Fields, path: Path, section: SpherePlaneJoint | SphereGrooveJoint, drawing: Drawing
) -> Halves:
    """Ground axes at the sphere's centre; on the second link z along its normal or groove."""
    first, second = points_of(fields, path, section)
    if getattr(section, "curve", None) is None:
        z = directions_of(fields, path, section, *drawing.keys)[1]
    else:
        z = along_line(fields, path, section)
    on_second = frame_about(z, perpendicular(z), second)
    return Halves(upright(first), on_second, (upright(first), upright(second)))


def _plane(fields: Fields, path: Path, section: PlanarJoint, drawing: Drawing) -> Halves:
    """z and x along the two directions given on either link."""
    along_z, along_x = drawing.keys
    points = points_of(fields, path, section)
    errors = fields.error_count
    normals = directions_of(fields, path, section, along_z)
    if getattr(section, "curve", None) is None:
        x = directions_of(fields, path, section, along_x)
    else:
        x = (along_line(fields, path, section),) * 2
    directions: list[Vector] = []
    for i in range(2):
        if i == 1 and (normals[1], x[1]) == (normals[0], x[0]):
            directions.append(directions[0])
            continue
        place = place_of(path, section, along_x, i)
        directions.append(_square(fields, place, normals[i], x[i], along_x, along_z, errors))
    frames = [frame_about(n, d, p) for n, d, p in zip(normals, directions, points, strict=True)]
    on_first, on_second = frames
    return Halves(on_first, on_second, (on_first, on_second))


def _zero_directions(
    fields: Fields, path: Path, section: AxisJoint, axes: tuple[Vector, Vector], errors: int
) -> tuple[Vector, Vector]:
    """Directions on either link that are in line, seen along the axis, at coordinate zero.

    `errors` as in `_square`.
    """
    if section.zero is None:
        x = perpendicular(axes[0])
        turned = turned_shortest(axes[0], axes[1], x)
        if axes[1] is axes[0] and is_settled(*axes[0]):
            # written once: exact numbers are not turned at all, where doubles round the turn
            same = by_rounding(dot(*axes) > 0.0)
            return x, either(same, lambda: turned, lambda: x)
        return x, turned
    given = directions_of(fields, path, section, "zero")
    first, second = (
        _square(fields, (*path, "zero", link), axis, vector, "this direction", "axis", errors)
        for link, axis, vector in zip(section.links, axes, given, strict=True)
    )
    return first, second


def _square(
    fields: Fields, path: Path, axis: Vector, vector: Vector, what: str, line: str, errors: int
) -> Vector:
    """A reference direction, refused where it is parallel to the axis it should be square to.

    `errors` counts those before the two were read: one that replaces a wrong one is not checked.
    """
    if norm(cross(axis, vector)) > PARALLEL:
        return vector
    if fields.error_count == errors:
        text = f"{what} is parallel to the joint's {line}"
        fields.error("zero-parallel", path, text, "give one that is square to it, or nearly so")
    return perpendicular(axis)


def _oblique(fields: Fields, path: Path, section: UniversalJoint, drawing: Drawing) -> Halves:
    """About one axis, then about another, at the angle drawn between them."""
    keys = drawing.keys
    at = points_of(fields, path, section)
    errors = fields.error_count
    one, two = (fields.direction((*path, key), getattr(section, key)) for key in keys)
    if norm(cross(one, two)) <= PARALLEL:
        if fields.error_count == errors:
            text = "the two axes of a universal joint are parallel"
            hint = "turn one of them, or use type R"
            fields.error("parallel-axes", (*path, keys[1]), text, hint)
        one = perpendicular(two)
    return _turns((one, one), (two, two), at)


def _two_turns_square(
    fields: Fields, path: Path, section: SlottedSphereJoint | CylinderPlaneJoint, drawing: Drawing
) -> Halves:
    """About the first of two square directions, then about the other."""
    at = points_of(fields, path, section)
    return _turns(*_square_pairs(fields, path, section, drawing), at)


def _slotted(fields: Fields, path: Path, section: SphereCylinderJoint, drawing: Drawing) -> Halves:
    """Along the cylinder, then about the slot's normal, then about the pin."""
    axis_key, pin_key = drawing.keys
    at = points_of(fields, path, section)
    errors = fields.error_count
    axes = directions_of(fields, path, section, axis_key)
    pins = directions_of(fields, path, section, pin_key)
    normals: list[Vector] = []
    for side, (axis, pin) in enumerate(zip(axes, pins, strict=True)):
        normal = cross(pin, axis)
        if norm(normal) <= PARALLEL:
            if fields.error_count == errors:
                text = "the pin is parallel to the cylinder's axis: they define no plane of a slot"
                hint = "draw the pin where it comes out of the slot"
                place = place_of(path, section, pin_key, side)
                fields.error("pin-parallel", place, text, hint)
            normal = perpendicular(pin)
        normals.append(unit(normal))
    own = frame_about(axes[0], normals[0], at[0])
    return _turns((normals[0], normals[1]), pins, at)._replace(own=own)


def _turns(
    ones: tuple[Vector, Vector], twos: tuple[Vector, Vector], at: tuple[Vector, Vector]
) -> Halves:
    """Turns about `ones`, then about `twos`, each as drawn on either link; the body between
    stands as drawn on the second."""
    x_first, x_second = (unit(cross(one, two)) for one, two in zip(ones, twos, strict=True))
    on_first = frame_about(ones[0], x_first, at[0])
    between = frame_about(ones[1], x_second, at[1])
    on_second = frame_about(twos[1], x_second, at[1])
    return Halves(on_first, on_second, (on_first, between))


def _square_pairs(
    fields: Fields, path: Path, section: PointJoint, drawing: Drawing
) -> tuple[tuple[Vector, Vector], tuple[Vector, Vector]]:
    """Two directions on either link, the first made exactly square to the second; refused where
    they are not drawn square."""
    keys = drawing.keys
    errors = fields.error_count
    ones, twos = (directions_of(fields, path, section, key) for key in keys)
    squared: list[Vector] = []
    for side, (one, two) in enumerate(zip(ones, twos, strict=True)):
        cosine = dot(one, two)
        if abs(cosine) > AXES_SQUARE:
            if fields.error_count == errors:
                fields.error(
                    "not-square",
                    place_of(path, section, keys[1], side),
                    f"{keys[0]} and {keys[1]} of this joint must be square to each other",
                    drawing.cure,
                    measured=f"cosine of their angle {cosine:.3g}",
                    limit=f"{AXES_SQUARE:g}",
                )
            squared.append(perpendicular(two))
            continue
        squared.append(unit(subtract(one, scale(cosine, two))))
    return (squared[0], squared[1]), twos


DRAWINGS: dict[str, Callable[..., Halves]] = {
    "axis": _axis,
    "ball": _ball,
    "ball on": _ball_on,
    "plane": _plane,
    "two axes": _oblique,
    "square axes": _two_turns_square,
    "slotted": _slotted,
    "weld": lambda *_: Halves(GROUND, GROUND, (GROUND, GROUND)),
}
"""Frames on both links, by the kind of drawing."""


NO_INERTIA: Tensor = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def build_links(
    fields: Fields, sections: Mapping[str, written.Link], accepted: bool
) -> dict[str, RigidLink]:
    """All links; unphysical inertias warn unless the file acknowledges them."""
    links = {}
    for name, section in sections.items():
        path: Path = ("links", name)
        mass, centre, tensor = 0.0, ZERO, NO_INERTIA
        if section.mass is not None and section.center_of_mass is not None:
            mass = fields.number((*path, "mass"), section.mass, MASS)
            if mass < 0.0:
                fields.error("negative-mass", (*path, "mass"), "a mass is not negative")
            centre = place_at(fields, (*path, "center_of_mass"), section.center_of_mass, name)
        if section.inertia is not None:
            tensor = _tensor(fields, (*path, "inertia"), section.inertia)
            if fields.plane:
                # a plane only knows the moment about its normal: that of a ball
                tensor = (tensor[2], tensor[2], tensor[2], 0.0, 0.0, 0.0)
            if not accepted:
                _check_physical(fields, (*path, "inertia"), name, tensor)
        links[name] = RigidLink(name, mass, centre, tensor)
    return links


def _tensor(fields: Fields, path: Path, section: written.LinkInertia) -> Tensor:
    names = ("xx", "yy", "zz", "xy", "xz", "yz")
    texts = [getattr(section, name) for name in names]
    xx, yy, zz, xy, xz, yz = (
        fields.number((*path, name), text, INERTIA) for name, text in zip(names, texts, strict=True)
    )
    if section.axes is None:
        return xx, yy, zz, xy, xz, yz
    x, y = square_axes(fields, (*path, "axes"), section.axes, "an inertia")
    axes = (x, y, cross(x, y))
    matrix = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))

    def entry(p: int, q: int) -> float:
        """Of the sum of I_ij a_i a_j^T over the axes a_i."""
        total = 0.0
        for i in range(3):
            for j in range(3):
                total += matrix[i][j] * (axes[i][p] * axes[j][q])
        return total

    return (entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2))


def square_axes(
    fields: Fields, path: Path, section: written.InertiaAxes, owner: str
) -> tuple[Vector, Vector]:
    """Two unit vectors; refused where they are not drawn square."""
    x = fields.direction((*path, "x"), section.x)
    y = fields.direction((*path, "y"), section.y)
    cosine = dot(x, y)
    if abs(cosine) > tolerances.AXES_SQUARE:
        fields.error(
            "axes-not-square",
            path,
            f"the axes of {owner} must be square to each other",
            "write them as expressions",
            measured=f"cosine of their angle {cosine:.3g}",
            limit=f"{tolerances.AXES_SQUARE:g}",
            numbers=(Number("cosine", abs(cosine), limit=tolerances.AXES_SQUARE),),
        )
    return x, y


def _is_surely_physical(tensor: tuple[float, ...]) -> bool:
    """Whether the second moments of mass tr(I)/2 - I are those of a body, judged by the pivots of
    their elimination: as `_check_physical` with half its slack, without eigenvalues."""
    xx, yy, zz, xy, xz, yz = tensor
    slack = 0.5 * tolerances.UNPHYSICAL_INERTIA * largest(abs(xx), abs(yy), abs(zz))
    a, b, c = (
        (yy + zz - xx) / 2.0 + slack,
        (xx + zz - yy) / 2.0 + slack,
        (xx + yy - zz) / 2.0 + slack,
    )
    if not advice(a > 0.0):
        return False
    b, yz, c = b - xy * xy / a, -yz - xy * xz / a, c - xz * xz / a
    return advice(b > 0.0) and advice(c - yz * yz / b > 0.0)


def _check_physical(fields: Fields, path: Path, name: str, tensor: tuple[float, ...]) -> None:
    """Principal moments of a real body are not negative and none exceeds the sum of the others."""
    recorded = [entry for entry in tensor if isinstance(entry, Recorded)]
    if recorded:
        if not all(entry.is_settled for entry in recorded) and not _is_surely_physical(tensor):
            raise TraceLost(f"the inertia of {name} belongs to no real body")
        return
    xx, yy, zz, xy, xz, yz = tensor
    moments = np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    slack = tolerances.UNPHYSICAL_INERTIA * float(np.abs(moments).max())
    if moments[0] >= -slack and moments[2] <= moments[0] + moments[1] + slack:
        return
    in_file = [float(fields.units.from_si(float(m), INERTIA)) for m in moments]
    unit = fields.units.label(INERTIA)
    fields.diagnostics.append(
        Diagnostic(
            "unphysical-inertia",
            "warning",
            f"the inertia of {name} belongs to no real body",
            fields.document.place(path),
            measured=f"principal moments {', '.join(f'{m:.6g}' for m in in_file)} {unit}",
            hint="a principal moment is not negative and not above the sum of the other two; "
            "accept: [unphysical-inertia] acknowledges it",
            numbers=tuple(Number("principal moment", m, unit) for m in in_file),
        )
    )


def build_linkage(
    fields: Fields, file: MechanismFile
) -> tuple[dict[str, RigidLink], dict[str, Joint]]:
    """Links and joints by name; a link that only `chain:` names has no mass. Every link must be
    joined to ground."""
    links = build_links(fields, file.links, "unphysical-inertia" in file.accept)
    # each row's joint lies behind the link before
    chain = list(pairwise([GROUND_NAME, *(row.link for row in file.chain)]))
    links |= {
        name: RigidLink(name) for _, name in chain if name != GROUND_NAME and name not in links
    }
    joints = build_joints(fields, file.joints, links)
    if chain:
        joints |= build_chain(fields, file.chain, chain)
    pairs = [(joint.links[0], joint.links[1]) for joint in file.joints.values()]
    _check_connected(fields, links, [*pairs, *chain, *_joined_by_cylinders(file)])
    return links, joints


def _joined_by_cylinders(file: MechanismFile) -> list[tuple[str, str]]:
    """The links that each cylinder joins, as far as its points are known."""
    ends = ((one.first, one.last) for one in file.cylinders.values())
    return [
        (file.points[first].link, file.points[last].link)
        for first, last in ends
        if first in file.points and last in file.points
    ]


def _check_connected(
    fields: Fields, links: Mapping[str, object], pairs: Sequence[tuple[str, str]]
) -> None:
    if any(name not in links and name != GROUND_NAME for pair in pairs for name in pair):
        return  # a misspelt link, reported at its joint
    joined: dict[str, list[str]] = {}
    for first, second in pairs:
        joined.setdefault(first, []).append(second)
        joined.setdefault(second, []).append(first)
    reached, front = {GROUND_NAME}, [GROUND_NAME]
    for link in front:
        more = [other for other in joined.get(link, ()) if other not in reached]
        reached.update(more)
        front += more
    for name in links:
        if name not in reached:
            fields.key_error(
                "disconnected-link",
                ("links", name),
                f"link {name} is not joined to ground, nor to a link that is",
                "add a joint, or remove the link",
            )


def build_chain(
    fields: Fields, rows: Sequence[ChainRow], pairs: Sequence[tuple[str, str]]
) -> dict[str, Joint]:
    """The joints of a chain between the links of `pairs`; errors are noted in `fields`."""
    if not _closes_at_ground(fields, rows):
        fields.refused |= {row.joint for row in rows} | {link for _, link in pairs}
        return {}
    joints = {}
    ground = upright(scale(-1.0, fields.origin))
    here = ground
    for i, (row, (first, second)) in enumerate(zip(rows, pairs, strict=True)):
        theta = fields.number(("chain", i, "theta"), row.theta, ANGLE)
        s = fields.number(("chain", i, "s"), row.s, LENGTH)
        alpha = fields.number(("chain", i, "alpha"), row.alpha, ANGLE)
        a = fields.number(("chain", i, "a"), row.a, LENGTH)
        at_joint = _along_z(here, theta, s)
        here = _along_x(at_joint, alpha, a)
        behind = at_joint
        if second == GROUND_NAME:
            behind = _along_x(ground, -alpha, -a)
        parts = (Part(row.type, at_joint, behind),)
        lead = lead_of(fields, ("chain", i, "lead"), row.lead) if row.lead is not None else 0.0
        joints[row.joint] = Joint(row.joint, row.type, first, second, at_joint, behind, parts, lead)
    return joints


def _closes_at_ground(fields: Fields, rows: Sequence[ChainRow]) -> bool:
    """Whether the rows run from ground over differing links back to ground."""
    errors = fields.error_count
    last = len(rows) - 1
    seen: set[str] = set()
    for i, row in enumerate(rows):
        path = ("chain", i, "link")
        if row.link == GROUND_NAME:
            if i < last:
                text = f"the chain is back at ground before its last row ({last + 1})"
                fields.error("chain-ends-early", path, text, "name the link behind this joint")
        elif row.link in seen:
            text = f"the chain comes through link {row.link} twice"
            fields.error("chain-crosses-itself", path, text, "name another link")
        elif i == last:
            text = f"the chain ends at link {row.link}"
            fields.error("open-chain", path, text, "the last row closes the loop: link: ground")
        seen.add(row.link)
    if last == 0 and fields.error_count == errors:
        text = "a chain of one row joins ground to itself"
        fields.error("short-chain", ("chain", 0), text, "a loop has two rows or more")
    return fields.error_count == errors


def _along_z(frame: Frame, angle: float, distance: float) -> Frame:
    """The frame moved by a screw about its own z."""
    x, _ = _turned(frame.x, frame.y, angle)
    return frame_about(frame.z, x, add(frame.o, scale(distance, frame.z)))


def _along_x(frame: Frame, angle: float, distance: float) -> Frame:
    """The frame moved by a screw about its own x."""
    _, z = _turned(frame.y, frame.z, angle)
    return frame_about(unit(z), frame.x, add(frame.o, scale(distance, frame.x)))


def _turned(p: Vector, q: Vector, angle: float) -> tuple[Vector, Vector]:
    """Two square unit vectors turned from p towards q."""
    c, s = cos(angle), sin(angle)
    return add(scale(c, p), scale(s, q)), subtract(scale(c, q), scale(s, p))
