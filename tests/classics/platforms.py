"""Platforms on legs: bodies whose mobility is known from the literature on their geometry."""

from __future__ import annotations

import numpy as np

from classics.drawing import Classic, Drawn, circle, platform, rotation

ANGLES = np.array([0.0, 0.9, 2.1, 3.0, 4.2, 5.1])
FREE = np.array(  # points of no meaning
    [
        [1.0, 0.1, 0.05], [0.4, 0.9, -0.1], [-0.5, 0.8, 0.1],
        [-0.9, -0.2, 0.0], [-0.3, -1.0, 0.15], [0.7, -0.8, -0.05],
    ]
)  # fmt: skip
LEG = np.array([0.3, -0.2, 1.1])


def parallel_legs(count: int, *, spin: bool = False) -> str:
    """Equal parallel legs: two translations on a sphere; the turn about the legs' direction is of
    first order only, where the feet are not on a circle as seen along the legs."""
    return platform(FREE[:count], FREE[:count] + LEG, spin=spin)


def wren(count: int) -> str:
    """Equal parallel legs square to the circle of their feet (wren platform): beside the two
    translations a screw motion about the circle's axis. It is a component of its own where five
    legs or more leave no second freedom (four always leave two)."""
    feet = circle(ANGLES[:count])
    return platform(feet, feet + np.array([0.0, 0.0, 1.3]))


def wren_inclined(count: int) -> str:
    """The same of legs that are not square to the plane of their feet: those lie on a circle as
    seen along the legs."""
    feet = circle(ANGLES[:count])
    feet[:, 2] = 0.3 * feet[:, 0] + 0.1 * feet[:, 1] ** 2
    return platform(feet, feet + np.array([0.0, 0.0, 1.3]))


def similar(points: np.ndarray, angle: float = np.pi / 2) -> str:
    """A platform with a smaller copy of the base, turned about the axis."""
    top = 0.5 * points @ rotation((0, 0, 1), angle).T + np.array([0.0, 0.0, 0.8])
    return platform(points, top)


def plane_points() -> np.ndarray:
    """Six points of a plane that lie on no conic."""
    points = FREE.copy()
    points[:, 2] = 0.0
    points[5] *= 0.4
    return points


def griffis_duffy() -> str:
    """Griffis and Duffy's platform: feet at the corners and on the edges of a triangle, heads on
    the edges and at the corners of another, in order: architecturally singular."""
    base = circle([0.3, 2.4, 4.4])
    top = (0.7 * circle([0.4, 2.5, 4.3]) + np.array([0.1, 0.05, 0.9])) @ rotation(
        (1, 2, 0.5), 0.3
    ).T
    middles = [(base[k] + base[(k + 1) % 3]) / 2 for k in range(3)]
    edges = [(top[k] + top[(k + 1) % 3]) / 2 for k in range(3)]
    feet = [p for k in range(3) for p in (base[k], middles[k])]
    heads = [p for k in range(3) for p in (edges[k], top[(k + 1) % 3])]
    return platform(feet, heads)


def projective() -> str:
    """Feet and heads on conics, in projective correspondence: architecturally singular (Karger)."""
    t = np.array([-1.6, -0.9, -0.2, 0.4, 1.1, 2.3])
    u = (1.3 * t + 0.4) / (0.2 * t + 1.1)
    base = np.stack([(1 - t**2) / (1 + t**2), 2 * t / (1 + t**2), 0 * t], axis=1)
    top = np.stack([0.6 * u / (1 + 0.3 * u**2), 0.5 / (1 + 0.3 * u**2), 0 * u], axis=1)
    top = top @ rotation((1, -0.4, 0.8), 0.7).T + np.array([0.1, 0.0, 1.0])
    return platform(base, top)


def on_a_line() -> str:
    """Four feet on a line, their heads on another in projective correspondence: four legs of a
    regulus are dependent."""
    t = np.array([-1.0, -0.3, 0.4, 1.2])
    feet = np.stack([t, 0.0 * t, 0.0 * t], axis=1)
    u = t / (1 + 0.3 * t)
    heads = np.stack([0.6 * u + 0.1, 0.4 * u + 0.2, 0.3 * u + 1.0], axis=1)
    return platform([*feet, FREE[1], FREE[4]], [*heads, 0.6 * FREE[1] + LEG, 0.6 * FREE[4] + LEG])


def stewart(*, slides: bool) -> str:
    """Stewart's platform of no meaning, its legs U-P-S, or held."""
    top = 0.6 * FREE @ rotation((1, 2, 3), 0.4).T + LEG
    if not slides:
        return platform(FREE, top)
    drawn = Drawn()
    for k in range(6):
        foot, head = FREE[k], top[k]
        along = head - foot
        one = np.cross(along, (1.0, 0.3, 0.2))
        drawn.add("U", "ground", f"a{k}", foot, axis=one, axis2=np.cross(along, one))
        drawn.add("P", f"a{k}", f"b{k}", (foot + head) / 2, axis=along)
        drawn.add("S", f"b{k}", "top", head)
    return drawn.text


def bricard_octahedron() -> str:
    """Bricard's first flexible octahedron: opposite corners change places by a half turn about
    a line; one face is ground, the opposite one a platform on six bars."""
    face = np.array([[1.0, 0.2, 0.3], [-0.2, 0.9, -0.4], [0.3, -0.5, 0.8]])
    other = face * np.array([-1.0, -1.0, 1.0])
    pairs = [(i, j) for i in range(3) for j in range(3) if i != j]
    return platform([face[i] for i, _ in pairs], [other[j] for _, j in pairs])


def bricard_octahedron_plane() -> str:
    """Bricard's second flexible octahedron: two pairs of opposite corners change places in a plane
    that holds the third pair."""
    a, b = np.array([0.9, 0.4, 0.7]), np.array([-0.6, 0.8, 0.5])
    mirror = np.array([1.0, 1.0, -1.0])
    c, d = np.array([0.2, -0.7, 0.0]), np.array([-0.5, 0.1, 0.0])
    face, other = [a, b, c], [a * mirror, b * mirror, d]
    pairs = [(i, j) for i in range(3) for j in range(3) if i != j]
    return platform([face[i] for i, _ in pairs], [other[j] for _, j in pairs])


def octahedron() -> str:
    """An octahedron of no meaning is rigid (Cauchy)."""
    face = np.array([[1.0, 0.2, 0.3], [-0.2, 0.9, -0.4], [0.3, -0.5, 0.8]])
    other = -face + np.array([[0.1, 0.0, 0.2], [0.0, 0.2, 0.1], [-0.1, 0.1, 0.0]])
    pairs = [(i, j) for i in range(3) for j in range(3) if i != j]
    return platform([face[i] for i, _ in pairs], [other[j] for _, j in pairs])


CASES = [
    *(Classic(f"{n} equal parallel legs", parallel_legs(n), (2,), 3) for n in (4, 5, 6)),
    Classic("4 equal parallel S-S legs", parallel_legs(4, spin=True), (6,), 7, 4),
    Classic("3 equal parallel legs", parallel_legs(3), (3,), 3),
    *(Classic(f"wren platform, {n} legs", wren(n), (2, 1), 3) for n in (5, 6)),
    Classic("wren platform, 4 legs", wren(4), (2,), 3),
    Classic("wren platform, inclined", wren_inclined(5), (2, 1), 3),
    Classic("similar hexagons on a circle", similar(circle(ANGLES)), (1,), 3),
    Classic("similar hexagons on no conic", similar(plane_points()), (0,), 2),
    Classic("Griffis-Duffy", griffis_duffy(), (1,), 1),
    Classic("projective conics", projective(), (1,), 1),
    Classic("four feet on a line", on_a_line(), (1,), 1),
    Classic("Stewart, held", stewart(slides=False), (0,), 0),
    Classic("Stewart", stewart(slides=True), (6,), 6),
    Classic("Bricard octahedron, line", bricard_octahedron(), (1,), 1),
    Classic("Bricard octahedron, plane", bricard_octahedron_plane(), (1,), 1),
    Classic("octahedron", octahedron(), (0,), 0),
]
