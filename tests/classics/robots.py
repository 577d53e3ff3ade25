"""Parallel robots, coupled shafts and assemblies of several linkages."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from classics.drawing import GROUND, Classic, Drawn, Z, circle, planar, rotation, spatial
from classics.platforms import ANGLES

THIRDS = [0.1, 0.1 + 2 * pi / 3, 0.1 + 4 * pi / 3]


def upu(first, second, top_points) -> str:
    """Three U-P-U legs from a unit circle, their hinges parallel in pairs: `first` on base and top,
    `second` along the leg."""
    drawn = Drawn()
    for k, (foot, head) in enumerate(zip(circle(THIRDS), top_points, strict=True)):
        one, two = first(THIRDS[k]), second(THIRDS[k], head - foot)
        drawn.add("U", GROUND, f"a{k}", foot, axis=one, axis2=two)
        drawn.add("P", f"a{k}", f"b{k}", (foot + head) / 2, axis=head - foot)
        drawn.add("U", f"b{k}", "top", head, axis=two, axis2=one)
    return drawn.text


def tangent(angle: float) -> np.ndarray:
    return np.array([-sin(angle), cos(angle), 0.0])


def radial(angle: float) -> np.ndarray:
    return np.array([cos(angle), sin(angle), 0.0])


def tsai() -> str:
    """Tsai's translational 3-UPU, the axes of whose constraint moments are independent."""
    top = 0.5 * circle(THIRDS) + np.array([0.05, -0.1, 1.2])
    return upu(tangent, lambda angle, leg: np.cross(tangent(angle), leg), top)


def seoul() -> str:
    """The 3-UPU of Seoul in its home position: legs upright, three moments about one direction
    constrain it once (Walter, Husty, Pfurner 2009: all its modes of operation have dimension 3)."""
    top = circle(THIRDS) + np.array([0.0, 0.0, 1.2])
    return upu(tangent, lambda angle, _: radial(angle), top)


def delta() -> str:
    """Clavel's Delta with spheres at the ends of the rods of its three parallelograms."""
    drawn = Drawn()
    for k, angle in enumerate(THIRDS):
        out, side = radial(angle), tangent(angle)
        elbow = 1.4 * out + np.array([0.0, 0.0, -0.3])
        head = 0.3 * out + np.array([0.05, 0.08, -1.7])
        drawn.add("R", GROUND, f"arm{k}", 0.8 * out, axis=side)
        for sign in (-1, 1):
            rod = f"rod{k}{'ab'[sign > 0]}"
            drawn.add("S", f"arm{k}", rod, elbow + 0.2 * sign * side)
            drawn.add("S", rod, "top", head + 0.2 * sign * side)
    return drawn.text


def delta_of_hinges() -> str:
    """Tsai and Stamper's manipulator: hinged arms, parallelograms of four hinges."""
    drawn = Drawn()
    for k, angle in enumerate(THIRDS):
        out, side = radial(angle), tangent(angle)
        elbow = 1.4 * out + np.array([0.0, 0.0, -0.3])
        head = 0.3 * out + np.array([0.05, 0.08, -1.7])
        # the rods lie in the plane of `side` and the way from elbow to head
        middle = elbow + 0.1 * (head - elbow) + 0.1 * side
        ending = middle + 0.7 * (head - elbow) + 0.15 * side
        normal = np.cross(side, ending - middle)
        drawn.add("R", GROUND, f"arm{k}", 0.8 * out, axis=side)
        drawn.add("R", f"arm{k}", f"bar{k}", elbow, axis=side)
        for sign in (-1, 1):
            rod = f"rod{k}{'ab'[sign > 0]}"
            drawn.add("R", f"bar{k}", rod, middle + 0.2 * sign * side, axis=normal)
            drawn.add("R", rod, f"end{k}", ending + 0.2 * sign * side, axis=normal)
        drawn.add("R", f"end{k}", "top", ending + 0.1 * side, axis=side)
    return drawn.text


def rps() -> str:
    drawn = Drawn()
    for k, angle in enumerate(THIRDS):
        foot, head = radial(angle), 0.6 * radial(angle) + np.array([0.0, 0.0, 1.1 + 0.1 * k])
        drawn.add("R", GROUND, f"a{k}", foot, axis=tangent(angle))
        drawn.add("P", f"a{k}", f"b{k}", (foot + head) / 2, axis=head - foot)
        drawn.add("S", f"b{k}", "top", head)
    return drawn.text


def three_rrr(*, spherical: bool) -> str:
    """A platform on three chains of three hinges: all parallel, or through one point."""
    drawn = Drawn()
    for k, angle in enumerate(THIRDS):
        names = [GROUND, f"a{k}", f"b{k}", "top"]
        for j, radius in enumerate((2.0, 1.5, 0.6)):
            place = radius * radial(angle + (0.0, 0.4, 0.2)[j])
            if spherical:
                lift = place + np.array([0.0, 0.0, (0.4, 1.0, 0.9)[j]])
                drawn.add("R", names[j], names[j + 1], lift, axis=lift)
            else:
                drawn.add("R", names[j], names[j + 1], place, axis=Z)
    return drawn.text


def cardan_shaft() -> str:
    """Two universal joints between shafts whose axes meet, the shafts in bearings, the intermediate
    one of fixed length symmetric to both: it keeps moving."""
    lean = 0.5
    one, two = np.array([1.0, 0.0, 0.0]), np.array([cos(lean), sin(lean), 0.0])
    near, far = -one * 1.0, two * 1.0
    middle = far - near
    drawn = Drawn()
    drawn.add("R", GROUND, "in", near - one, axis=one)
    drawn.add("U", "in", "shaft", near, axis=Z, axis2=np.cross(middle, Z))
    drawn.add("U", "shaft", "out", far, axis=np.cross(middle, Z), axis2=Z)
    drawn.add("R", "out", GROUND, far + two, axis=two)
    return drawn.text


def two_wrens() -> str:
    """Two wren platforms, one on the other: every sum of their dimensions."""
    drawn = Drawn()
    for level, (below, above) in enumerate([(GROUND, "low"), ("low", "top")]):
        for k, foot in enumerate(circle(ANGLES[:5], height=1.5 * level)):
            head = foot + np.array([0.0, 0.0, 1.2])
            drawn.add("U", below, f"leg{level}{k}", foot, axis=(1, 0, 0), axis2=(0, 1, 0))
            drawn.add("S", f"leg{level}{k}", above, head)
    return drawn.text


def double_watt() -> str:
    """Connelly and Servatius' cusp: coupler points of two Watt linkages, which trace curves with
    inflections, on a bar square to them. It has a finite motion, but none that can be reversed
    through the drawing."""
    pins = {}
    for x, arm, half, (o, b, m, c, q) in (
        (0.0, 1.0, 0.5, "OBMCQ"),
        (2.0, -0.7, 0.4, "obmcq"),
    ):
        pins |= {o: (x - arm, half), b: (x, half), m: (x, 0.0), c: (x, -half), q: (x + arm, -half)}
    return planar(pins, ["OQoq", "OB", "BMC", "CQ", "ob", "bmc", "cq", "Mm"])


def lazy_tongs(*, flat: bool) -> str:
    """Crossed bars hinged in their middles and at their ends; flat, every cell may also fold."""
    height = 0.0 if flat else 0.6
    pins = {}
    for k in range(3):
        pins["abc"[k]], pins["ABC"[k]] = (2.0 * k, -height), (2.0 * k, height)
    pins["x"], pins["y"] = (1.0, 0.0), (3.0, 0.0)
    return planar(pins, ["axB", "Axb", "byC", "Byc"])


def gimbal() -> str:
    """A rotor in two rings and a frame: three hinges in a row, and a spring leg that needs none."""
    drawn = Drawn()
    drawn.add("R", GROUND, "outer", (1, 0, 0), axis=(1, 0, 0))
    drawn.add("R", "outer", "inner", (0, 1, 0), axis=(0, 1, 0))
    drawn.add("R", "inner", "rotor", (0, 0, 1), axis=(0, 0, 1))
    return drawn.text


def tetrahedron() -> str:
    """Bars from three points of ground to a point: rigid, every bar spins."""
    points = {"A": (0, 0, 0), "B": (1, 0, 0), "C": (0.2, 1, 0), "D": (0.4, 0.3, 1.1)}
    return spatial(points, ["ABC", "AD", "BD", "CD"])


def flat_tetrahedron() -> str:
    """The same with the point in the plane of the three: it shakes."""
    points = {"A": (0, 0, 0), "B": (1, 0, 0), "C": (0.2, 1, 0), "D": (0.4, 0.3, 0.0)}
    return spatial(points, ["ABC", "AD", "BD", "CD"])


def bipyramid() -> str:
    """A point on three bars and another one over it, on two bars and a bar between them."""
    points = {"A": (0, 0, 0), "B": (1, 0, 0), "C": (0.2, 1, 0), "D": (0.4, 0.3, 0.9)}
    points["E"] = tuple((rotation((1, 0.3, 0), 0.4) @ np.array([0.5, 0.4, 1.4])).tolist())
    return spatial(points, ["ABC", "AD", "BD", "CD", "AE", "BE", "DE"])


CASES = [
    Classic("Tsai 3-UPU", tsai(), (3,), 3),
    Classic("Seoul 3-UPU at home", seoul(), (3,), 5),
    Classic("Delta", delta(), (9,), 9, 6),
    Classic("Delta of hinges", delta_of_hinges(), (3,), 3),
    Classic("3-RPS", rps(), (3,), 3),
    Classic("3-RRR planar", three_rrr(spherical=False), (3,), 3),
    Classic("3-RRR spherical", three_rrr(spherical=True), (3,), 3),
    Classic("Cardan shaft", cardan_shaft(), (1,), 1),
    Classic("two wren platforms", two_wrens(), (4, 3, 2), 6),
    Classic("double Watt at its cusp", double_watt(), (1,), 2),
    Classic("lazy tongs", lazy_tongs(flat=False), (1,), 1),
    Classic("lazy tongs, flat", lazy_tongs(flat=True), (1,), 2),
    Classic("gimbal", gimbal(), (3,), 3),
    Classic("point on three bars", tetrahedron(), (3,), 3, 3),
    Classic("point on three bars, flat", flat_tetrahedron(), (3,), 4, 3),
    Classic("two points on six bars", bipyramid(), (6,), 6, 6),
]
