"""Denavit-Hartenberg numbers of a closed polygon of lines, and frames from them, at 40 digits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import mpmath as mp

Line = tuple[Sequence[float], Sequence[float]]


class Row(NamedTuple):
    """(theta, s) about z, then (alpha, a) about the next x; rad and lengths."""

    theta: mp.mpf
    s: mp.mpf
    alpha: mp.mpf
    a: mp.mpf


def dot(p: mp.matrix, q: mp.matrix) -> mp.mpf:
    return (p.T * q)[0]


def cross(p: mp.matrix, q: mp.matrix) -> mp.matrix:
    return mp.matrix([p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3)])


def angle(p: mp.matrix, q: mp.matrix, about: mp.matrix) -> mp.mpf:
    """From p to q about a unit vector square to both."""
    return mp.atan2(dot(about, cross(p, q)), dot(p, q))


def rows_of(lines: Sequence[Line]) -> list[Row]:
    """The rows of a loop whose joints lie on these lines (point, direction), none parallel."""
    points = [mp.matrix(point) for point, _ in lines]
    z = [mp.matrix(axis) / mp.norm(mp.matrix(axis)) for _, axis in lines]
    count = len(lines)
    x, leaves, arrives = [], [], [None] * count
    for i in range(count):
        j = (i + 1) % count
        normal = cross(z[i], z[j])
        gap = points[j] - points[i]
        square = dot(normal, normal)
        leaves.append(points[i] + z[i] * (dot(cross(gap, z[j]), normal) / square))
        arrives[j] = points[j] + z[j] * (dot(cross(gap, z[i]), normal) / square)
        x.append(normal / mp.sqrt(square))
    rows = []
    for i in range(count):
        j = (i + 1) % count
        theta, s = angle(x[i - 1], x[i], z[i]), dot(z[i], leaves[i] - arrives[i])
        a = dot(x[i], arrives[j] - leaves[i])
        rows.append(Row(theta, s, angle(z[i], z[j], x[i]), a))
    return rows


def screw_z(turn: mp.mpf, slide: mp.mpf) -> mp.matrix:
    c, s = mp.cos(turn), mp.sin(turn)
    return mp.matrix([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, slide], [0, 0, 0, 1]])


def screw_x(turn: mp.mpf, slide: mp.mpf) -> mp.matrix:
    c, s = mp.cos(turn), mp.sin(turn)
    return mp.matrix([[1, 0, 0, slide], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def frames(rows: Sequence[Row], moved: Sequence[tuple[float, float]]) -> list[mp.matrix]:
    """The frame at every joint, x and origin along and at the normal behind it, then that behind
    the last row; `moved` adds each joint's own (theta, s)."""
    here, found = mp.eye(4), []
    for row, (turn, slide) in zip(rows, moved, strict=True):
        here = here * screw_z(row.theta + turn, row.s + slide)
        found.append(here)
        here = here * screw_x(row.alpha, row.a)
    return [*found, here]
