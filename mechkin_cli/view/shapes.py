"""Shapes of links: a rod, a thin plate, rods from a middle (a star), or nothing.

A link goes through its joints and its named points. Two of them, or more in a line, make a rod;
three or more in a plane a plate; others rods to their centroid. Ground is told by its joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.mechanism.model import GROUND_NAME, Mechanism
from mechkin_cli.view.limits import FLATNESS, POINTS_APART

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.vectors import Vector
    from mechkin_cli.view.settings import Kind, ShapeSetting


class Shape(NamedTuple):
    """A link as it is drawn (m, in the drawing): the `points` it goes through (n, 3), of a plate
    the `normal`, of a star the `centre`."""

    kind: Kind
    points: Floats
    normal: Floats | None = None
    centre: Floats | None = None


def link_shape(
    mechanism: Mechanism, link: str, size: float, setting: ShapeSetting | None = None
) -> Shape:
    """The shape of a link of a mechanism of some `size` (m); what `setting` says goes first."""
    given = None if setting is None else setting.points
    points = distinct(drawn_points(mechanism, link) if given is None else given, size)
    kind = None if setting is None else setting.kind
    if kind is None and link == GROUND_NAME and given is None:
        kind = "none"
    return shape_through(points, kind)


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
