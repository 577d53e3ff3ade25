"""Single loops whose mobility is known, from the conditions that their authors published.

Conditions of overconstrained linkages by Denavit and Hartenberg's parameters as in Baker (1980) and
Chen, You (2009); `Bricard` (1897, 1927), `Bennett` (1903), `Goldberg` (1943), `Myard` (1931),
`Altmann` (1954), `Schatz` (1942), `Waldron` (1968), `Delassus` (1922), `Sarrus` (1853).
"""

from __future__ import annotations

from math import asin, cos, pi, sin, sqrt

import numpy as np

from classics.denavit import closed_loop, hinges
from classics.drawing import Classic, Z, circle, planar, ring, rotation

HALF = pi / 2
POINTS = np.array(
    [
        (0.1, 0.2, -0.3), (0.9, -0.1, 0.2), (1.1, 0.8, 0.4), (0.4, 1.2, -0.2),
        (-0.5, 0.9, 0.3), (-0.8, 0.1, 0.6), (-0.3, -0.6, 0.1), (0.2, -0.9, 0.5),
    ]
)  # fmt: skip
AXES = np.array(
    [
        (0.2, 0.9, -0.4), (-0.7, 0.3, 0.6), (0.5, 0.5, 0.8), (0.9, -0.2, 0.3),
        (-0.1, 0.6, 0.7), (0.4, -0.8, 0.5), (0.3, 0.2, 0.9), (-0.6, 0.1, 0.4),
    ]
)  # fmt: skip


def bennett_rows(a: float, alpha: float, b: float):
    """Rows of Bennett's loop: lengths and twists; sin(alpha)/a = sin(beta)/b."""
    beta = asin(b * sin(alpha) / a)
    return [a, b, a, b], [alpha, beta, alpha, beta]


def bennett(a: float = 1.0, alpha: float = 0.9, b: float = 0.7, seed: int = 1):
    """Points and axes of Bennett's loop."""
    return closed_loop(*bennett_rows(a, alpha, b), [0.0] * 4, seed)


def fitted(points, axes, frame_from, frame_to):
    """A drawing moved so that one frame comes to lie on another."""
    (origin, turn), (to, by) = frame_from, frame_to
    move = by @ turn.T
    return (points - origin) @ move.T + to, axes @ move.T


def frame_of(points, axes, k: int, m: int):
    """Frame of the link between two hinges: the foot on axis k, axis k, the line to axis m."""
    normal = np.cross(axes[k], axes[m])
    normal /= np.linalg.norm(normal)
    normal *= np.sign(normal @ (points[m] - points[k]))
    return points[k], np.stack([normal, np.cross(axes[k], normal), axes[k]], axis=1)


def goldberg5() -> str:
    """Two Bennett loops with a common link C-D, which is taken away after the links that meet at D
    have been joined."""
    one = bennett()
    two = bennett(b=0.45, seed=2)
    two = fitted(*two, frame_of(*two, 2, 3), frame_of(*one, 2, 3))
    points = [*one[0][:3], two[0][1], two[0][0]]
    axes = [*one[1][:3], two[1][1], two[1][0]]
    return ring("RRRRR", points, axes)


def goldberg6() -> str:
    """Three Bennett loops in a row, each with a common link with the next, those taken away."""
    one = bennett()
    two = bennett(b=0.45, seed=2)
    two = fitted(*two, frame_of(*two, 2, 3), frame_of(*one, 2, 3))
    # the third shares the link of hinges F and C of the second, and is joined at F
    third_alpha = asin(0.45 * sin(0.9))
    three = bennett(a=0.45, alpha=third_alpha, b=0.8, seed=2)
    three = fitted(*three, frame_of(*three, 2, 3), frame_of(*two, 1, 2))
    points = [*one[0][:3], three[0][0], three[0][1], two[0][0]]
    axes = [*one[1][:3], three[1][0], three[1][1], two[1][0]]
    return ring("RRRRRR", points, axes)


def waldron() -> str:
    """Two Bennett loops with a common hinge D, whose links are joined in pairs; the hinge is taken
    away."""
    one = bennett()
    points, axes = bennett(a=1.2, alpha=0.6, b=0.8, seed=2)
    turn = rotation(one[1][3], 0.8)
    fit = fitted(points, axes, frame_of(points, axes, 3, 2), frame_of(*one, 3, 2))
    shift = 0.3 * one[1][3]
    points = (fit[0] - one[0][3]) @ turn.T + one[0][3] + shift
    axes = fit[1] @ turn.T
    return ring("RRRRRR", [*one[0][:3], *points[2::-1]], [*one[1][:3], *axes[2::-1]])


def myard() -> str:
    """Myard's plane-symmetric five-bar: two rectangular Bennett loops."""
    alpha, b = 0.8, 1.0
    a = b * sin(alpha)
    return hinges([a, b, 0.0, b, a], [alpha, HALF, pi - 2 * alpha, HALF, pi - alpha])


HALF_TURN, MIRROR = np.array([-1.0, -1.0, 1.0]), np.array([1.0, 1.0, -1.0])


def bricard_line() -> str:
    """Three hinges and what a half turn about z makes of them."""
    points, axes = POINTS[:3], AXES[:3]
    return ring("RRRRRR", [*points, *points * HALF_TURN], [*axes, *axes * HALF_TURN])


def bricard_plane() -> str:
    """Two hinges in the plane xy, two beside it and their images."""
    points, axes = POINTS[1:3], AXES[1:3]
    flat = [(-0.2, 0.1, 0.0), (0.4, 1.5, 0.0)], [(1.0, 0.2, 0.0), (0.3, 1.0, 0.0)]
    images = points[::-1] * MIRROR, axes[::-1] * MIRROR
    return ring(
        "RRRRRR",
        [flat[0][0], *points, flat[0][1], *images[0]],
        [flat[1][0], *axes, flat[1][1], *images[1]],
    )


def octahedral(corners) -> str:
    """Six faces of an octahedron, hinged along the sides of a hexagon of its edges."""
    corners = np.asarray(corners)
    return ring("RRRRRR", corners, np.roll(corners, -1, axis=0) - corners)


def bricard_trihedral() -> str:
    lengths = [0.9, 0.7, 0.8, 1.0, 1.1, 0.0]
    lengths[5] = sqrt(0.9**2 + 0.8**2 + 1.1**2 - 0.7**2 - 1.0**2)
    return hinges(lengths, [HALF, 3 * HALF] * 3)


def schatz() -> str:
    lengths = [0.0, 1.0, 1.0, 1.0, 0.0, sqrt(3.0)]
    return hinges(lengths, [HALF] * 5 + [0.0], [0.4, 0, 0, 0, 0, -0.4])


def altmann() -> str:
    lengths, twists = [1.0, 0.0, 0.7], [HALF, HALF, 3 * HALF]
    return hinges(lengths * 2, twists * 2)


def delassus(leads) -> str:
    """Four parallel threads at the corners of a parallelogram."""
    points = [(0, 0, 0), (0.6, 0.8, 0.1), (2.1, 0.8, -0.2), (1.5, 0, 0)]
    return ring("HHHH", points, [Z] * 4, dict(enumerate(leads)))


def sarrus(tilt: float) -> str:
    """Two chains of three parallel hinges between two plates; `tilt` between their directions."""
    near = np.array([(1.0, -0.5, 0.0), (1.5, -0.4, 0.5), (1.0, -0.5, 1.0)])
    far = near * (1.0, -1.0, 1.0) @ rotation(Z, tilt).T
    axis = np.array([0.0, 1.0, 0.0])
    axes = [axis] * 3 + [rotation(Z, tilt) @ axis] * 3
    return ring("RRRRRR", [*near, *far[::-1]], axes)


def spherical(directions, letters: str | None = None) -> str:
    """Hinges through one point."""
    return ring(
        letters or "R" * len(directions), [0.8 * np.array(d) for d in directions], directions
    )


def great_circle(angles) -> str:
    """Hinges through one point and in one plane."""
    return spherical(circle(angles))


def prisms(count: int) -> str:
    return ring("P" * count, POINTS[:count], AXES[:count])


def general(letters: str) -> str:
    leads = {k: 0.3 + 0.1 * k for k, letter in enumerate(letters) if letter == "H"}
    return ring(letters, POINTS[: len(letters)], AXES[: len(letters)], leads)


def kaleidocycle(count: int) -> str:
    """A ring of tetrahedra whose successive hinges are square to each other and as far apart."""
    return hinges([1.0] * count, [HALF, -HALF] * (count // 2), None, 3)


def planes_and_point() -> str:
    """Three hinges through a point and three parallel ones: one freedom (double spherical-planar
    six-bar: Bennett's plano-spherical hybrid)."""
    meet = [(0.2, 0.9, -0.4), (-0.7, 0.3, 0.6), (0.5, 0.5, 0.8)]
    points = [*(0.7 * np.array(d) for d in meet), *POINTS[3:6]]
    return ring("RRRRRR", points, [*meet, Z, Z, Z])


def double_spherical() -> str:
    """Three hinges through a point and three through another (Bennett's double Hooke)."""
    centre = np.array([2.0, 0.3, 0.1])
    points = [*(0.7 * AXES[:3]), *(centre + 0.5 * AXES[3:6])]
    return ring("RRRRRR", points, AXES[:6])


CASES = [
    Classic("Bennett", ring("RRRR", *bennett()), (1,), 1),
    Classic("Bennett, equilateral", hinges([1.0] * 4, [0.8, pi - 0.8] * 2), (1,), 1),
    Classic("Goldberg 5R", goldberg5(), (1,), 1),
    Classic("Goldberg 6R", goldberg6(), (1,), 1),
    Classic("Waldron hybrid", waldron(), (1,), 1),
    Classic("Myard", myard(), (1,), 1),
    Classic("Bricard line-symmetric", bricard_line(), (1,), 1),
    Classic("Bricard plane-symmetric", bricard_plane(), (1,), 1),
    Classic("Bricard trihedral", bricard_trihedral(), (1,), 1),
    Classic("Bricard octahedral line", octahedral([*POINTS[:3], *POINTS[:3] * HALF_TURN]), (1,), 1),
    Classic(
        "Bricard octahedral plane",
        octahedral([*POINTS[1:3], (0.2, -0.7, 0.0), *POINTS[1:3] * MIRROR, (-0.5, 0.4, 0.0)]),
        (1,),
        1,
    ),
    Classic("Schatz", schatz(), (1,), 1),
    Classic("Altmann", altmann(), (1,), 1),
    Classic("kaleidocycle of 6", kaleidocycle(6), (1,), 1),
    Classic("kaleidocycle of 8", kaleidocycle(8), (2,), 2),
    Classic("Delassus, equal leads", delassus([0.4] * 4), (1,), 1),
    Classic("Delassus, parallelogram", delassus([0.4, 0.7, 0.5, 0.2]), (1,), 1),
    Classic("parallel threads of other leads", delassus([0.4, 0.7, 0.5, 0.3]), (0,), 0),
    Classic("Sarrus", sarrus(HALF), (1,), 1),
    Classic("Sarrus, oblique", sarrus(0.8), (1,), 1),
    Classic("Sarrus of parallel hinges", sarrus(pi), (3,), 3),
    Classic(
        "planar four-bar",
        ring("RRRR", [(0, 0, 0), (0, 1, 0), (2, 1.5, 0), (2.5, 0, 0)], [Z] * 4),
        (1,),
        1,
    ),
    Classic(
        "planar five-bar",
        planar(
            {"A": (0, 0), "B": (0, 1), "C": (1, 1.7), "D": (2, 1.5), "E": (2.5, 0)},
            ["EA", "AB", "BC", "CD", "DE"],
        ),
        (2,),
        2,
    ),
    Classic(
        "slider-crank",
        ring("RRRP", [(0, 0, 0), (1, 1, 0), (3, 0, 0), (3, 0, 0)], [Z, Z, Z, (1, 0, 0)]),
        (1,),
        1,
    ),
    Classic(
        "elliptic trammel",
        ring(
            "PRRP", [(0, 0, 0), (0.6, 0, 0), (0, 0.8, 0), (0, 0, 0)], [(1, 0, 0), Z, Z, (0, 1, 0)]
        ),
        (1,),
        1,
    ),
    Classic(
        "Oldham coupling",
        ring(
            "RPPR",
            [(0, 0, 0), (0, 0, 0), (0.3, 0, 0), (0.3, 0, 0)],
            [Z, (0.6, 0.8, 0), (-0.8, 0.6, 0), Z],
        ),
        (1,),
        1,
    ),
    Classic(
        "three wedges", ring("PPP", POINTS[:3], [(1, 0, 0), (0.3, 1, 0), (-0.4, 0.5, 0)]), (1,), 1
    ),
    Classic("four slides", prisms(4), (1,), 1),
    Classic("five slides", prisms(5), (2,), 2),
    Classic("three slides", prisms(3), (0,), 0),
    Classic("spherical four-bar", spherical(AXES[:4]), (1,), 1),
    Classic("spherical five-bar", spherical(AXES[:5]), (2,), 2),
    Classic("spherical triangle", spherical(AXES[:3]), (0,), 0),
    Classic(
        "Cardan joint",
        spherical([(1, 0, 0), (0, 1, 0), (-sin(0.5), 0, cos(0.5)), (cos(0.5), 0, sin(0.5))]),
        (1,),
        1,
    ),
    Classic("spherical four-bar, folded", great_circle([0.0, 0.5, 1.7, 1.3]), (1,), 2),
    Classic("spherical parallelogram, folded", great_circle([0.0, 0.7, 1.9, 1.2]), (1,), 2),
    Classic("spherical triangle, stretched", great_circle([0.0, 0.5, 1.3]), (0,), 1),
    Classic("spherical four-bar, stretched", great_circle([0.0, 0.5, 1.3, 1.9]), (0,), 2),
    Classic("plano-spherical", planes_and_point(), (1,), 1),
    Classic("double spherical", double_spherical(), (1,), 1),
    Classic(
        "differential screw",
        ring("HHP", [(0, 0, 0), (0, 0, 1), (0, 0, 2)], [Z] * 3, {0: 0.4, 1: 0.3}),
        (1,),
        1,
    ),
    Classic(
        "three coaxial threads",
        ring("HHH", [(0, 0, 0), (0, 0, 1), (0, 0, 2)], [Z] * 3, {0: 0.4, 1: 0.3, 2: 0.1}),
        (1,),
        1,
    ),
    Classic(
        "four coaxial hinges", ring("RRRR", [(0, 0, k) for k in range(4)], [Z] * 4), (3,), 3, 3
    ),
    Classic("two coaxial C", ring("CC", [(0, 0, 0), (0, 0, 1)], [Z] * 2), (2,), 2),
    Classic("three parallel C", ring("CCC", POINTS[:3], [Z] * 3), (2,), 2, 2),
    Classic("general RCCC", general("RCCC"), (1,), 1),
    Classic("general 7R", general("RRRRRRR"), (1,), 1),
    Classic("general 8R", general("RRRRRRRR"), (2,), 2),
    Classic("general 6R", general("RRRRRR"), (0,), 0),
    Classic("general 4R", general("RRRR"), (0,), 0),
    Classic("general RSSR", general("RSSR"), (2,), 2, 1),
    Classic("general RHHHHHH", general("RHHHHHH"), (1,), 1),
]
