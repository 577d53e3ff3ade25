"""Planar four-bars in closed form at 50 digits, and their files; no code of the package.

The crank a turns about A at the origin, the rocker c about D at (d, 0), the rod b joins them.
Assembled where e, the distance of the crank's pin from D, lies between |b - c| and b + c.
"""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mp, mpf

mp.dps = 50
PLANAR = "axis: [0, 0, 1]"


@dataclass(frozen=True)
class FourBar:
    """Lengths as texts of decimals, and the side of the rod's joint: 1 or -1."""

    a: str
    b: str
    c: str
    d: str
    side: int

    def rocker(self, degrees: mpf) -> mpf | None:
        """The rocker's direction in degrees; None where it cannot be assembled."""
        a, b, c, d = (mpf(x) for x in (self.a, self.b, self.c, self.d))
        t = mp.radians(degrees)
        x, y = a * mp.cos(t) - d, a * mp.sin(t)
        square = x * x + y * y
        cosine = (square + c * c - b * b) / (2 * mp.sqrt(square) * c)
        if abs(cosine) >= 1:
            return None
        return mp.degrees(mp.atan2(y, x) + self.side * mp.acos(cosine))

    def dead_centres(self) -> list[mpf]:
        """Crank angles from 0 to 180 degrees where rod and rocker are in line."""
        a, b, c, d = (mpf(x) for x in (self.a, self.b, self.c, self.d))
        cosines = [(a * a + d * d - e * e) / (2 * a * d) for e in (b + c, b - c)]
        return sorted(mp.degrees(mp.acos(x)) for x in cosines if abs(x) < 1)


def decimals(x: mpf) -> str:
    return mp.nstr(x, 25)


def joints_of(bar: FourBar, at: str, suffix: str, pairs: str, crank: str, x: str = "0") -> str:
    """Rod and rocker on a crank that stands at `at` degrees; the frame begins at `x`."""
    t, r = mp.radians(mpf(at)), mp.radians(bar.rocker(mpf(at)))
    px, py = mpf(x) + mpf(bar.a) * mp.cos(t), mpf(bar.a) * mp.sin(t)
    dx = mpf(x) + mpf(bar.d)
    qx, qy = dx + mpf(bar.c) * mp.cos(r), mpf(bar.c) * mp.sin(r)
    rod, rocker = f"rod{suffix}", f"rocker{suffix}"

    def axis(kind: str) -> str:
        return "" if kind == "S" else f", {PLANAR}"

    return (
        f"  P{suffix}: {{type: {pairs[0]}, links: [{crank}, {rod}], "
        f"point: [{decimals(px)}, {decimals(py)}, 0]{axis(pairs[0])}}}\n"
        f"  Q{suffix}: {{type: {pairs[1]}, links: [{rod}, {rocker}], "
        f"point: [{decimals(qx)}, {decimals(qy)}, 0]{axis(pairs[1])}}}\n"
        f"  D{suffix}: {{type: R, links: [ground, {rocker}], "
        f"point: [{decimals(dx)}, 0, 0], {PLANAR}}}\n"
    )


def file_of(links: list[str], joints: str, motion: str, more: str = "") -> str:
    """A file in metres and degrees whose crank turns about the origin."""
    return (
        "format: 1\nname: near a change point\nunits: {length: m, angle: deg}\n"
        f"links: {{{', '.join(f'{link}: {{}}' for link in links)}}}\njoints:\n"
        f"  A: {{type: R, links: [ground, crank], point: [0, 0, 0], {PLANAR}}}\n"
        f"{joints}motion: {motion}\n{more}"
    )


def apart(one: float, other: float) -> float:
    """The angle between two angles in degrees."""
    return abs((one - other + 180) % 360 - 180)
