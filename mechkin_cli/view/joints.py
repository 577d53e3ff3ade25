"""Joints, links and poses for the page: halves of joints, shapes of links, poses, the plane.

A link goes through its joints and its named points. Two of them, or more in a line, make a rod;
three or more in a plane a plate; others rods to their centroid (a star); cylinders and wheels are
asked for. Ground is shown by its joints. The columns of a link's rotation are the ground axes as
drawn on it, its shift is that of one of its joint points: x = R x0 + t with t = p - R p0. Where a
mechanism moves in a plane square to a ground axis, and is drawn in it, the page looks along that
axis first.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import ShapeSetting
from mechkin_cli.derived import displacement, quaternion, rotation_of, vector_of
from mechkin_cli.mechanism import (
    FIRST,
    GROUND_NAME,
    SECOND,
    Frame,
    Joint,
    Mechanism,
    Vector,
    is_written,
    reference_point,
    scale,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.view.page import FLATNESS, POINTS_APART
from mechkin_cli.view.tracks import drawn_track

if TYPE_CHECKING:
    from mechkin_cli.building import Kind
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Result
    from mechkin_cli.view.page import Lengths, Plain


def drawn_joints(mechanism: Mechanism) -> list[Joint]:
    """The joints that are drawn: those of the machine that have a place, between its own links."""
    return [
        joint
        for joint in mechanism.joints.values()
        if all(map(is_written, (joint.name, joint.first, joint.second)))
        and joint.type.has_point
        and not joint.type.is_free
    ]


def sliding_coordinate(joint: Joint) -> str | None:
    """The full name of the slide of a joint that has one alone; None of others."""
    slides = [known.name for known in joint.type.named if not known.is_angle]
    return f"{joint.name}.{slides[0]}" if len(slides) == 1 else None


def turning_coordinate(joint: Joint) -> str | None:
    """The full name of the angle of a joint that has one alone; None of others."""
    angles = [known.name for known in joint.type.named if known.is_angle]
    return f"{joint.name}.{angles[0]}" if len(angles) == 1 else None


def stops_of(problem: Problem, joint: Joint) -> dict[str, tuple[float, float]]:
    """Where `limits:` end the one angle of a joint (`turn`, rad) and its one slide (`slide`, m);
    infinite on a side without a limit."""
    ends = {limit.name: (limit.low, limit.high) for limit in problem.limits}
    names = {"turn": turning_coordinate(joint), "slide": sliding_coordinate(joint)}
    return {kind: ends[name] for kind, name in names.items() if name in ends}


def joint_records(
    problem: Problem,
    links: Sequence[str],
    travels: Mapping[str, tuple[float, float]],
    joint_radius: float | None,
    lengths: Lengths,
) -> list[Plain]:
    """The joints for the page; `travels` of slides by joint, in the file's unit of length.

    The radius is that of the `view:` section, else that at which the joint rubs.
    """
    mechanism = problem.mechanism
    rubs = {one.joint: one.radius for one in mechanism.frictions}
    found: list[Plain] = []
    for joint in drawn_joints(mechanism):
        radius = joint_radius if joint_radius is not None else rubs.get(joint.name)
        travel = travels.get(joint.name)
        found.append(
            {
                "name": joint.name,
                "type": joint.type.shape or joint.letter,
                "links": [links.index(joint.first), links.index(joint.second)],
                "halves": [_half(joint, side, lengths) for side in (FIRST, SECOND)],
                "lead": lengths.one(joint.lead) if joint.type.is_threaded else None,
                "travel": None if travel is None else list(travel),
                "radius": None if radius is None else lengths.one(radius),
                "track": _track(joint, lengths),
                "stops": _stops(problem, joint, lengths),
            }
        )
    return found


def _stops(problem: Problem, joint: Joint, lengths: Lengths) -> Plain:
    """Ends by `limits:`, of slides in the file's unit; None on a side without one."""
    found: Plain = {"turn": None, "slide": None}
    for kind, ends in stops_of(problem, joint).items():
        unit = lengths.one if kind == "slide" else float
        found[kind] = [unit(end) if np.isfinite(end) else None for end in ends]
    return found


def _track(joint: Joint, lengths: Lengths) -> Plain | None:
    """The curve or surface of a joint, on its second link: rows of places, one row of a curve."""
    track = drawn_track(joint)
    if track is None:
        return None
    rows = track.places if track.is_surface else track.places[None]
    return {"rows": lengths.array(rows).tolist(), "closed": track.closed}


def half_axis(joint: Joint, side: int) -> Vector:
    """The axis of the half on one link, as drawn: that of the pair where this link carries it, else
    z of the pair's frame."""
    carries_axis = joint.type.axis is not None and joint.type.axis.side == side
    return joint.axis.vector if carries_axis else half_frame(joint, side).z


def half_frame(joint: Joint, side: int) -> Frame:
    """The frame of the half on one link, as drawn."""
    return joint.on_first if side == FIRST else joint.on_second


def _half(joint: Joint, side: int, lengths: Lengths) -> Plain:
    """The half on one link; `axis2` is the pin that stands square to, or askew of, an axis of its
    own."""
    frame, axis = half_frame(joint, side), half_axis(joint, side)
    has_pin = joint.type.parameter == "from axis to pin" and side == FIRST
    return {
        "point": lengths.vector(frame.o),
        "axis": list(axis),
        "x": list(frame.z if axis == frame.x else frame.x),
        "axis2": list(scale(-1.0, frame.y)) if has_pin else None,
    }


class Shape(NamedTuple):
    """A link as it is drawn (m, in the drawing): the `points` it goes through (n, 3), of a plate
    the `normal`, of a star the `centre`; of a wheel its centre alone, its axis as `normal` and its
    `width`; the `radius` of a rod, cylinder or wheel, None: the page's choice."""

    kind: Kind
    points: Floats
    normal: Floats | None = None
    centre: Floats | None = None
    radius: float | None = None
    width: float = 0.0

    @property
    def outline(self) -> Floats:
        """Points (n, 3) whose hull is the shape, without the thickness of what is thin."""
        if self.kind != "wheel" or self.normal is None or self.radius is None:
            return self.points
        _, _, (along, x, y) = np.linalg.svd(self.normal[None])
        turns = np.linspace(0.0, 2.0 * np.pi, RIM_POINTS, endpoint=False)[:, None]
        rim = self.points[0] + self.radius * (np.cos(turns) * x + np.sin(turns) * y)
        return np.concatenate([rim - 0.5 * self.width * along, rim + 0.5 * self.width * along])


def link_shape(
    mechanism: Mechanism, link: str, size: float, setting: ShapeSetting | None = None
) -> Shape:
    """The shape of a link of a mechanism of some `size` (m); what `setting` says goes first."""
    chosen = setting or ShapeSetting()
    kind = chosen.kind
    if kind is None and link == GROUND_NAME and chosen.points is None:
        kind = "none"
    if kind == "wheel" and chosen.radius is not None:
        width = chosen.radius / 4.0 if chosen.width is None else chosen.width
        normal = np.array(chosen.axis)
        return Shape(kind, np.array(chosen.points), normal, radius=chosen.radius, width=width)
    points = drawn_points(mechanism, link) if chosen.points is None else chosen.points
    apart = distinct(points, size)
    if kind == "cylinder" and len(apart) > 1:
        return Shape(kind, apart[[0, -1]], radius=chosen.radius)
    shape = shape_through(apart, None if kind == "cylinder" else kind)
    return shape._replace(radius=chosen.radius)


def drawn_points(mechanism: Mechanism, link: str) -> list[Vector]:
    """A link's joint points, then its named points; where these are one, its mass centre, too."""
    found = [at.vector for _, at in mechanism.joint_points() if at.link == link]
    found += [at.vector for at in mechanism.points.values() if at.link == link]
    body = mechanism.links.get(link)
    if len(set(found)) == 1 and body is not None and body.mass:
        found.append(body.center_of_mass)
    return found


def distinct(points: Sequence[Vector], size: float) -> Floats:
    """Points (n, 3) without those that are as good as one before them."""
    found: list[Floats] = []
    for point in points:
        place = np.asarray(point, dtype=np.float64)
        if all(np.linalg.norm(place - other) > POINTS_APART * size for other in found):
            found.append(place)
    return np.array(found).reshape(-1, 3)


def shape_through(points: Floats, kind: Kind | None = None) -> Shape:
    """A shape through points (n, 3) that differ; `kind` None: by how they lie.

    A rod joins the two ends of points in a line, and others in turn; a plate needs three points
    that are in no line, and is else a rod.
    """
    if kind == "none" or len(points) < 2:
        return Shape("none", points)
    centre = points.mean(axis=0)
    _, extents, axes = np.linalg.svd(points - centre, full_matrices=True)
    spread = np.append(extents, np.zeros(3 - len(extents)))
    in_line = spread[1] <= FLATNESS * spread[0]
    if kind is None:
        flat = spread[2] <= FLATNESS * spread[0]
        kind = "rod" if in_line else "plate" if flat else "star"
    if in_line and kind in ("rod", "plate"):
        along = (points - centre) @ axes[0]
        return Shape("rod", points[[along.argmin(), along.argmax()]])
    if kind == "plate":
        return Shape("plate", points, normal=axes[2])
    return Shape(kind, points, centre=centre if kind == "star" else None)


RIM_POINTS = 32
"""Of each face of a wheel."""

HOME = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
"""The pose of what is where it was drawn."""


def link_poses(result: Result, links: Sequence[str]) -> Floats:
    """Shift (m) and unit quaternion (scalar first) of links, shape (rows, links, 7), of what is
    drawn on them about the mechanism's datum.

    Rows without a solution are nan; ground, and links of loops that were not followed, are at home.
    Quaternions have q0 >= 0; `continuous` joins them.
    """
    poses = np.full((result.rows, len(links), 7), np.nan)
    own = result.problem.mechanism
    poses[result.solved] = (*own.datum, *HOME[3:])
    moving = [name for name in links if name != GROUND_NAME and name in own.links]
    wanted = [quantity for name in moving for quantity in displacement(name)]
    if not (wanted and result.solved.any()):
        return poses
    columns = result.evaluated(wanted)
    for name in moving:
        at, rotation = links.index(name), rotation_of(columns, name)
        drawn = reference_point(own, name).vector
        place = vector_of(columns[f"{name} place"])
        for axis in range(3):
            carried = sum(rotation[k][axis] * drawn[k] for k in range(3))
            poses[:, at, axis] = place[axis] - carried
        poses[:, at, 3:] = np.stack(quaternion(rotation), axis=1)
    poses[~result.solved] = np.nan
    return poses


def continuous(poses: Floats) -> Floats:
    """The same poses (poses, links, 7), each quaternion with the sign that is nearer to the one
    before it."""
    turns = poses[:, :, 3:]
    back = np.einsum("plk,plk->pl", turns[1:], turns[:-1]) < 0.0
    signs = np.cumprod(np.where(back, -1.0, 1.0), axis=0)
    found = poses.copy()
    found[1:, :, 3:] *= signs[:, :, None]
    return found


def carried(poses: Floats, point: Vector | Floats) -> Floats:
    """Where a point as drawn on a link, or one for each pose, is in poses (..., 7): t + R x0 with
    R x0 = x0 + 2 q0 (v x x0) + 2 v x (v x x0), v the vector part."""
    start = np.asarray(point, dtype=np.float64)
    v = poses[..., 4:]
    across = np.cross(v, start)
    moved: Floats = poses[..., :3] + start + 2.0 * (poses[..., 3:4] * across + np.cross(v, across))
    return moved


def plane_of_motion(poses: Sequence[Floats], low: Floats, high: Floats) -> int | None:
    """The ground axis (0, 1, 2) square to the plane in which all points of a box from `low` to
    `high` (m) lie and all `poses` (poses, links, 7) of some branches move; None without one."""
    extents = high - low
    size = float(np.linalg.norm(extents))
    flat = np.flatnonzero(extents <= FLATNESS * size)
    if flat.size != 1 or not poses:
        return None
    axis = int(flat[0])
    others = [k for k in range(3) if k != axis]
    for found in poses:
        leaves = np.abs(found[:, :, axis]) > FLATNESS * size
        tilts = np.abs(found[:, :, [4 + k for k in others]]) > FLATNESS
        if leaves.any() or tilts.any():
            return None
    return axis


def upwards(gravity: Floats, axis: int | None) -> Floats:
    """The unit vector that is up on the page: against gravity, in a plane its part in it; without
    one z, or y where the page looks along z."""
    up = 0.0 - np.asarray(gravity, dtype=np.float64)
    if axis is not None:
        up[axis] = 0.0
    length = float(np.linalg.norm(up))
    if length > FLATNESS * float(np.linalg.norm(gravity)):
        return up / length + 0.0
    return np.array([0.0, 1.0, 0.0] if axis == 2 else [0.0, 0.0, 1.0])
