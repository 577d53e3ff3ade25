"""RSSR: the rocker's sphere on its circle, at one distance from the crank's."""

from __future__ import annotations

import random
from collections.abc import Sequence
from decimal import Decimal
from typing import Any

import numpy as np
from oracle.numerics import mp
from random_families.proofs.linkage import Assemblies, Linkage, decimal, decimals, frame
from random_families.proofs.planar import HEAD

Vector = tuple[Any, Any, Any]


def rssr(rng: random.Random) -> Linkage:
    """Axes of any directions; the rod's turn about its spheres is left alone."""
    place = frame(rng)
    crank, rocker = decimals(rng), decimals(rng)
    foot = (Decimal(0), Decimal(0), Decimal(0))
    far = (decimal(rng, 0.8, 2.0), *decimals(rng, 2))
    one = decimals(rng)
    two = tuple(x + y for x, y in zip(far, decimals(rng), strict=True))
    body = (
        f"{HEAD}links: {{crank: {{}}, rod: {{}}, rocker: {{}}}}\njoints:\n"
        f"  A: {{type: R, links: [ground, crank], point: {place.point(*foot)}, "
        f"axis: {place.direction(*crank)}}}\n"
        f"  B: {{type: S, links: [crank, rod], point: {place.point(*one)}}}\n"
        f"  C: {{type: S, links: [rod, rocker], point: {place.point(*two)}}}\n"
        f"  D: {{type: R, links: [ground, rocker], point: {place.point(*far)}, "
        f"axis: {place.direction(*rocker)}}}\n"
    )

    def terms(turn: Any, of: Any) -> tuple[Any, Any, Any]:
        """a, b, c of a cos(theta) + b sin(theta) = c for the rocker's angle."""
        axis, end, pivot = of(rocker), _turned(of(one), of(crank), turn), of(far)
        arm, length = _minus(of(two), pivot), _minus(of(two), of(one))
        part = _dot(arm, axis) / _dot(axis, axis)
        along = tuple(part * x for x in axis)
        across = _minus(arm, along)
        beside = tuple(x / of.root(_dot(axis, axis)) for x in _cross(axis, across))
        off = tuple(p + a - e for p, a, e in zip(pivot, along, end, strict=True))
        rest = _dot(length, length) - _dot(off, off) - _dot(across, across)
        return 2 * _dot(off, across), 2 * _dot(off, beside), rest

    def assemblies(inputs: Sequence[Any]) -> Assemblies:
        a, b, c = terms(inputs[0], _Exact())
        size = mp.sqrt(a * a + b * b)
        if abs(c) > size:
            return {}
        middle, half = mp.atan2(b, a), mp.acos(c / size)
        return {side: {"D.theta": middle + side * half} for side in (1, -1)}

    def margin(inputs: Sequence[Any]) -> Any:
        a, b, c = terms(inputs[0], _Floats())
        return 1.0 - c * c / (a * a + b * b)

    with mp.workdps(60):
        home = -1 if terms(mp.zero, _Exact())[1] > 0 else 1
    return Linkage(body, ("A.theta",), assemblies, margin, home)


class _Exact:
    root = staticmethod(mp.sqrt)

    def __call__(self, v: Any) -> Vector:
        x, y, z = (mp.mpf(str(c)) for c in v)
        return x, y, z


class _Floats:
    root = staticmethod(np.sqrt)

    def __call__(self, v: Any) -> Vector:
        x, y, z = (float(c) for c in v)
        return x, y, z


def _turned(v: Vector, axis: Vector, angle: Any) -> Vector:
    of = np if isinstance(angle, np.ndarray) else mp
    size = _dot(axis, axis)
    part, cross = _dot(v, axis) / size, _cross(axis, v)
    c, s = of.cos(angle), of.sin(angle) / of.sqrt(size)
    x, y, z = (c * a + (1 - c) * part * u + s * w for a, u, w in zip(v, axis, cross, strict=True))
    return x, y, z


def _minus(v: Any, w: Any) -> Vector:
    return v[0] - w[0], v[1] - w[1], v[2] - w[2]


def _dot(v: Any, w: Any) -> Any:
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2]


def _cross(v: Any, w: Any) -> Vector:
    return (
        v[1] * w[2] - v[2] * w[1],
        v[2] * w[0] - v[0] * w[2],
        v[0] * w[1] - v[1] * w[0],
    )
