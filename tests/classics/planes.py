"""Planar linkages: bodies with pins, from the geometry that makes them move."""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np

from classics.drawing import Classic, planar


def complete(ones, twos) -> str:
    """Bars from each of `ones` to each of `twos` (a complete bipartite framework)."""
    pins = {chr(65 + k): tuple(p) for k, p in enumerate([*ones, *twos])}
    names = list(pins)
    bars = [a + b for a in names[: len(ones)] for b in names[len(ones) :]]
    return planar(pins, bars)


def on_ellipse(angles):
    return [(1.3 * cos(a), 0.8 * sin(a)) for a in angles]


def general_points(number: int):
    return [(cos(2.4 * k) + 0.13 * k, sin(1.7 * k) - 0.05 * k * k) for k in range(number)]


def quadrilateral(*places: float) -> str:
    """A four-bar whose pins lie on a line."""
    pins = {name: (x, 0.0) for name, x in zip("ABCD", places, strict=True)}
    return planar(pins, ["DA", "AB", "BC", "CD"])


def polygon(*places) -> str:
    names = [chr(65 + k) for k in range(len(places))]
    bars = [names[k - 1] + names[k] for k in range(len(names))]
    return planar(dict(zip(names, places, strict=True)), bars)


def legs(feet, heads) -> str:
    """A plate on bars in the plane."""
    pins = {}
    for k, (foot, head) in enumerate(zip(feet, heads, strict=True)):
        pins[chr(65 + k)], pins[chr(97 + k)] = foot, head
    bars = [chr(65 + k) + chr(97 + k) for k in range(len(feet))]
    ends = "".join(chr(65 + k) for k in range(len(feet)))
    return planar(pins, [ends, ends.lower(), *bars])


def concurrent() -> str:
    """Three bars whose lines meet in a point: shaky."""
    centre = np.array([0.2, 0.3])
    feet = [centre + 2.0 * np.array([cos(a), sin(a)]) for a in (0.3, 2.0, 4.4)]
    heads = [centre + r * (f - centre) for r, f in zip((0.5, 0.4, 0.6), feet, strict=True)]
    return legs(feet, heads)


FEET = [(0.0, 0.0), (1.0, 0.2), (1.8, -0.3)]


def shifted(*lengths: float):
    return [(x + 0.3 * a, y + 0.95 * a) for (x, y), a in zip(FEET, lengths, strict=True)]


def watt() -> str:
    pins = {"A": (0, 0), "B": (0.2, 1), "C": (2, 1.6), "D": (2.3, 0), "E": (1.1, 2.1)}
    pins |= {"F": (3.4, 1.9), "G": (4.1, 0.1), "C": (2, 1.6)}
    return planar(pins, ["ADG", "AB", "BC", "CDE", "EF", "FG"])


def stephenson(ternary: bool) -> str:
    """Stephenson's six-bars: the floating ternary on the coupler, or on ground."""
    pins = {"A": (0, 0), "B": (0.2, 1), "C": (2, 1.6), "D": (2.3, 0), "E": (1.1, 2.1)}
    pins |= {"F": (3.0, 2.4), "G": (4.1, 0.1)}
    bars = ["ADG", "AB", "BCE", "CD", "EF", "FG"]
    return planar(pins, bars if ternary else ["BCE", "AB", "ADG", "CD", "EF", "FG"])


def peaucellier(*, crank: bool = True) -> str:
    """Peaucellier's cell: O with two long bars to the corners of a rhombus."""
    q, r = 0.45, 0.8  # half diagonals
    u = np.array([cos(0.3), sin(0.3)])
    v = np.array([-u[1], u[0]])
    middle = 1.6 * u
    pins = {
        "O": (0.0, 0.0), "A": middle + r * v, "B": middle - r * v,
        "P": middle - q * u, "Q": middle + q * u,
    }  # fmt: skip
    inner = pins["P"]
    pins["C"] = inner / 2 + np.array([-inner[1], inner[0]]) * 0.4
    return planar(pins, ["OC", "CP", "OA", "OB", "AP", "BP", "AQ", "BQ"])


def hart() -> str:
    """Hart's inversor: an antiparallelogram, pins O, P, Q on its bars on a line parallel to the
    diagonals; O fixed, P on a crank."""
    # isosceles trapezium with diagonals AC, BD as the long bars and legs AD, BC as the short ones
    a, b, h = 1.4, 0.5, 0.9
    pins = {"A": (-a, 0.0), "B": (a, 0.0), "C": (b, h), "D": (-b, h)}
    part = 0.4

    def on(one, two):
        (x, y), (u, v) = pins[one], pins[two]
        return (x + part * (u - x), y + part * (v - y))

    pins["O"], pins["P"], pins["Q"] = on("A", "D"), on("A", "C"), on("B", "D")
    pins["R"] = (pins["O"][0] + 0.5, pins["O"][1] - 0.8)
    return planar(pins, ["OR", "AOD", "APC", "BQD", "BC", "RP"])


def chebyshev() -> str:
    """Chebyshev's lambda linkage with a slider of bars: an ordinary four-bar."""
    return polygon((0.0, 0.0), (0.5, 1.2), (2.5, 1.4), (2.0, 0.0))


def meet(one, two, radius: float, other: float, side: float) -> np.ndarray:
    """Where two circles about `one` and `two` meet, left (side 1) or right (-1) of the line."""
    one, two = np.asarray(one), np.asarray(two)
    apart = np.linalg.norm(two - one)
    along = (two - one) / apart
    x = (apart**2 + radius**2 - other**2) / (2 * apart)
    return one + x * along + side * sqrt(radius**2 - x**2) * np.array([-along[1], along[0]])


def burmester() -> str:
    """Burmester's focal mechanism: pins P, Q, R, S on the sides AB, BC, CD, DA of a four-bar, each
    joined to F. The loops APFS and FRCQ are similar (ratio m), BQFP and FSDR, too (n); then the
    angles at P and S in one loop and in its neighbour add up to half a turn all the time if the
    cosine laws over AF and BF agree, which gives FP."""
    ap, pb, bq, sa, m = 1.0, 1.3, 0.9, 1.1, 0.8
    n = m * ap / pb
    fs, fq = n * bq, m * sa
    square = (fs**2 + sa**2 - ap**2) / ap + (fq**2 + bq**2 - pb**2) / pb
    fp = sqrt(square / (1 / ap + 1 / pb))
    a, b, p = np.array([0.0, 0.0]), np.array([ap + pb, 0.0]), np.array([ap, 0.0])
    f = p + fp * np.array([cos(1.4), sin(1.4)])
    s, q = meet(a, f, sa, fs, 1.0), meet(b, f, bq, fq, -1.0)
    d, c = a + (s - a) * (sa + n * fq) / sa, b + (q - b) * (bq + m * fs) / bq
    r = c + (d - c) * m / (m + n)
    assert abs(np.linalg.norm(c - d) - fp * (m + n)) < 1e-14
    assert abs(np.linalg.norm(r - f) - m * ap) < 1e-14
    pins = dict(zip("ABCDFPQRS", (a, b, c, d, f, p, q, r, s), strict=True))
    return planar(pins, ["APB", "BQC", "CRD", "DSA", "FP", "FQ", "FR", "FS"])


def pantograph() -> str:
    """A parallelogram ABCD whose bars go on to O and E in line with D; O is fixed, D on a crank."""
    pins = {"O": (0, 0), "A": (0.6, 0.9), "B": (1.2, 1.8), "C": (1.8, 0.9), "D": (1.2, 0.0)}
    pins |= {"E": (2.4, 0), "G": (1.0, -0.8)}
    return planar(pins, ["OG", "OAB", "BCE", "AD", "CD", "GD"])


def cranks(number: int) -> str:
    """Equal parallel cranks between two plates: a parallelogram, doubled."""
    feet = [(0.0, 0.0), (1.0, 0.2), (1.8, -0.3), (2.5, 0.4)][:number]
    return legs(feet, [(x + 0.3, y + 0.9) for x, y in feet])


def kempe() -> str:
    """Kempe's reversor: two similar antiparallelograms O-A-D-B and O-B-E-C with E on BD."""
    o, a, b = np.zeros(2), np.array([2.0, 0.0]), np.array([cos(0.7), sin(0.7)])
    d = meet(a, b, 1.0, 2.0, 1.0)
    if np.abs(d - a - b).max() < 1e-9:  # the parallelogram
        d = meet(a, b, 1.0, 2.0, -1.0)
    e = b + (d - b) / 4
    c = meet(o, e, 0.5, 1.0, 1.0)
    if np.abs(c + b - e).max() < 1e-9:
        c = meet(o, e, 0.5, 1.0, -1.0)
    pins = dict(zip("OABCDE", (o, a, b, c, d, e), strict=True))
    return planar(pins, ["OA", "OB", "OC", "AD", "DEB", "CE"])


DIXON_I = complete([(-1.1, 0.0), (0.4, 0.0), (1.3, 0.0)], [(0.0, -0.7), (0.0, 0.5), (0.0, 1.2)])
DIXON_II = complete(
    [(x, y) for x in (-1.2, 1.2) for y in (-0.5, 0.5)],
    [(x, y) for x in (-0.4, 0.4) for y in (-0.9, 0.9)],
)
DIXON_II_OF_SIX = complete(
    [(-1.2, -0.5), (1.2, -0.5), (1.2, 0.5)], [(-0.4, -0.9), (0.4, -0.9), (0.4, 0.9)]
)

CASES = [
    Classic("parallelogram", polygon((0, 0), (0.4, 0.9), (2.4, 0.9), (2, 0)), (1,), 1),
    Classic("parallelogram, flat", quadrilateral(0.0, 1.0, 3.0, 2.0), (1,), 2),
    Classic("antiparallelogram", polygon((-1.4, 0), (0.5, 0.9), (-0.5, 0.9), (1.4, 0)), (1,), 1),
    Classic("rhombus, folded", quadrilateral(0.0, 1.0, 0.0, 1.0), (1,), 2),
    Classic("rhombus, flat", quadrilateral(0.0, 1.0, 2.0, 1.0), (1,), 2),
    Classic("kite, flat", quadrilateral(0.0, 1.0, 3.0, 1.0), (1,), 2),
    Classic("change point", quadrilateral(0.0, 1.0, 3.5, 2.0), (1,), 2),
    Classic("stretched four-bar", quadrilateral(0.0, 1.0, 2.2, 3.0), (0,), 2),
    Classic("stretched three-bar", polygon((0, 0), (1, 0), (3, 0)), (0,), 1),
    Classic("triangle", polygon((0, 0), (1, 0), (3, 1)), (0,), 0),
    Classic("five-bar on a line", polygon((0, 0), (1, 0), (3, 0), (2.2, 0), (1.5, 0)), (2,), 3),
    Classic("stretched five-bar", polygon((0, 0), (1, 0), (1.7, 0), (2.2, 0), (4, 0)), (0,), 3),
    Classic(
        "K3,3 on a conic",
        complete(on_ellipse([0.1, 2.0, 4.1]), on_ellipse([1.0, 3.1, 5.3])),
        (0,),
        1,
    ),
    Classic("K3,3", complete(general_points(6)[:3], general_points(6)[3:]), (0,), 0),
    Classic("Dixon I", DIXON_I, (1,), 1),
    Classic("Dixon II, K4,4", DIXON_II, (1,), 1),
    Classic("Dixon II, K3,3", DIXON_II_OF_SIX, (1,), 1),
    Classic("three concurrent bars", concurrent(), (0,), 1),
    Classic("three parallel bars", legs(FEET, shifted(1.0, 1.3, 0.8)), (0,), 1),
    Classic("three equal parallel bars", legs(FEET, shifted(1.0, 1.0, 1.0)), (1,), 1),
    Classic("plate on three bars", legs(FEET, [(0.3, 0.9), (1.4, 1.3), (1.6, 0.8)]), (0,), 0),
    Classic("four equal cranks", cranks(4), (1,), 1),
    Classic("Watt six-bar", watt(), (1,), 1),
    Classic("Stephenson six-bar, ternary ground", stephenson(True), (1,), 1),
    Classic("Stephenson six-bar, ternary coupler", stephenson(False), (1,), 1),
    Classic("Peaucellier", peaucellier(), (1,), 1),
    Classic("Hart", hart(), (1,), 1),
    Classic("Chebyshev", chebyshev(), (1,), 1),
    Classic("Burmester focal mechanism", burmester(), (1,), 1),
    Classic("pantograph", pantograph(), (1,), 1),
    Classic("Kempe reversor", kempe(), (1,), 1),
]
