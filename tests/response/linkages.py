"""Linkages of the tests of responses, as text."""

from __future__ import annotations

import math


def four_bar(
    ground: float,
    crank: float,
    coupler: float,
    rocker: float,
    angle: float,
    response: str,
    loads: str = "  - {type: gravity, g: [0, -9.81, 0]}",
    side: int = 1,
) -> str:
    """A four-bar in the plane z = 0, drawn assembled with its crank at an angle (deg).

    A ground-crank, B crank-coupler, C coupler-rocker, D rocker-ground; all links are rods with
    their mass in proportion to their length. `side` chooses the assembly.
    """
    a = math.radians(angle)
    bx, by = crank * math.cos(a), crank * math.sin(a)
    dx, dy = ground - bx, -by
    distance = math.hypot(dx, dy)
    along = (coupler**2 - rocker**2 + distance**2) / (2 * distance)
    up = side * math.sqrt(coupler**2 - along**2)
    cx, cy = bx + (along * dx - up * dy) / distance, by + (along * dy + up * dx) / distance

    def rod(name: str, x0: float, y0: float, x1: float, y1: float) -> str:
        mass = math.hypot(x1 - x0, y1 - y0)
        mean = (x0 + x1) / 2, (y0 + y1) / 2
        spin = mass**3 / 12
        ex, ey = (x1 - x0) / mass, (y1 - y0) / mass
        inertia = f"xx: {spin * ey * ey!r}, yy: {spin * ex * ex!r}, zz: {spin!r}"
        return (
            f"  {name}: {{mass: {mass!r}, center_of_mass: [{mean[0]!r}, {mean[1]!r}, 0],"
            f" inertia: {{{inertia}, xy: {-spin * ex * ey!r}}}}}"
        )

    def hinge(name: str, links: str, x: float, y: float) -> str:
        return f"  {name}: {{type: R, links: [{links}], point: [{x!r}, {y!r}, 0], axis: [0, 0, 1]}}"

    return "\n".join(
        [
            "format: 1",
            "name: four-bar",
            "units: {angle: rad}",
            "links:",
            rod("crank", 0, 0, bx, by),
            rod("coupler", bx, by, cx, cy),
            rod("rocker", ground, 0, cx, cy),
            "joints:",
            hinge("A", "ground, crank", 0, 0),
            hinge("B", "crank, coupler", bx, by),
            hinge("C", "coupler, rocker", cx, cy),
            hinge("D", "ground, rocker", ground, 0),
            "loads:" if loads else "loads: []",
            *([loads] if loads else []),
            "responses:",
            "  run:",
            response,
            "",
        ]
    )
