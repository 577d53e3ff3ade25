"""Scalar relations between two links and their rates: what joints demand, and their coordinates.

With x_i, R_i, v_i, w_i the mass centre, rotation and velocities of link i, all in ground axes, P a
point and u, v, a unit vectors carried along, and W = w_j - w_i, every relation is one of

    angle   c = u.v                       c' = (w_a - w_b).(u x v)
    gap     c = u.(P_j - P_i)             c' = u.(P_j' - P_i') + (w_u x u).(P_j - P_i)
    turn    c' = W.h, h = p a_i + q a_j   c by the arctangent of two directions

c' = G V with V all velocities, and c'' = G V' + g: `jacobian` is G, `bias` is g.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass
class Posture:
    """Where all links are and how they move; the last one is ground, which rests."""

    x: Array
    """(links + 1, 3) mass centres."""
    R: Array
    """(links + 1, 3, 3) rotations from the drawing."""
    v: Array
    w: Array


@dataclass
class Relations:
    """Lists while a mechanism is read, arrays afterwards (`freeze`); numbered in their order."""

    angle: list[tuple[Any, ...]] = field(default_factory=list)
    """(a, b, u, v, constant)"""
    gap: list[tuple[Any, ...]] = field(default_factory=list)
    """(i, j, link that carries u, P on i, P on j, u)"""
    turn: list[tuple[Any, ...]] = field(default_factory=list)
    """(i, j, axis on i, p, axis on j, q, cosine and sine directions on one link, pointer on the
    other, whether the pointer is on j)"""

    def freeze(self) -> None:
        def columns(rows: list[tuple[Any, ...]], width: int) -> list[Array]:
            return [np.array(c) for c in zip(*rows, strict=True)] if rows else [np.zeros(0)] * width

        self._a = columns(self.angle, 5)
        self._g = columns(self.gap, 6)
        self._t = columns(self.turn, 10)

    @property
    def count(self) -> int:
        return len(self.angle) + len(self.gap) + len(self.turn)

    def values(self, at: Posture, turns: Array) -> Array:
        """Values in the order angle, gap, turn; a turn is the one nearest to those given."""
        found = np.empty(self.count)
        first, second = len(self.angle), len(self.angle) + len(self.gap)
        if first:
            a, b, u, v, constant = self._a
            found[:first] = _dot(_turned(at.R[a], u), _turned(at.R[b], v)) - constant
        if second > first:
            i, j, k, p, q, u = self._g
            found[first:second] = _dot(_turned(at.R[k], u), _gap(at, i, j, p, q))
        if self.turn:
            i, j, _, _, _, _, cosine, sine, pointer, on_second = self._t
            fixed, moving = np.where(on_second, i, j), np.where(on_second, j, i)
            hand = _turned(at.R[moving], pointer)
            angle = np.arctan2(
                _dot(_turned(at.R[fixed], sine), hand), _dot(_turned(at.R[fixed], cosine), hand)
            )
            found[second:] = angle + 2 * np.pi * np.round((turns - angle) / (2 * np.pi))
        return found

    def jacobian(self, at: Posture) -> Array:
        """(relations, 6 per link) by (v, w) of each; ground's columns are left out."""
        links = len(at.x)
        found = np.zeros((self.count, links, 6))
        first, second = len(self.angle), len(self.angle) + len(self.gap)
        if first:
            a, b, u, v, _ = self._a
            n = np.cross(_turned(at.R[a], u), _turned(at.R[b], v))
            rows = np.arange(first)
            found[rows, a, 3:] += n
            found[rows, b, 3:] -= n
        if second > first:
            i, j, k, p, q, u = self._g
            u = _turned(at.R[k], u)
            rows = np.arange(first, second)
            found[rows, j, :3] += u
            found[rows, i, :3] -= u
            found[rows, j, 3:] += np.cross(_turned(at.R[j], q), u)
            found[rows, i, 3:] -= np.cross(_turned(at.R[i], p), u)
            found[rows, k, 3:] += np.cross(u, _gap(at, i, j, p, q))
        if self.turn:
            i, j = self._t[:2]
            h = self._leading(at)[0]
            rows = np.arange(second, self.count)
            found[rows, j, 3:] += h
            found[rows, i, 3:] -= h
        return found[:, :-1].reshape(self.count, -1)

    def bias(self, at: Posture) -> Array:
        found = np.empty(self.count)
        first, second = len(self.angle), len(self.angle) + len(self.gap)
        if first:
            a, b, u, v, _ = self._a
            u, v = _turned(at.R[a], u), _turned(at.R[b], v)
            changing = np.cross(np.cross(at.w[a], u), v) + np.cross(u, np.cross(at.w[b], v))
            found[:first] = _dot(at.w[a] - at.w[b], changing)
        if second > first:
            i, j, k, p, q, u = self._g
            u, d = _turned(at.R[k], u), _gap(at, i, j, p, q)
            p, q = _turned(at.R[i], p), _turned(at.R[j], q)
            rate = at.v[j] + np.cross(at.w[j], q) - at.v[i] - np.cross(at.w[i], p)
            centripetal = np.cross(at.w[j], np.cross(at.w[j], q)) - np.cross(
                at.w[i], np.cross(at.w[i], p)
            )
            turning = np.cross(at.w[k], u)
            found[first:second] = (
                _dot(u, centripetal) + 2 * _dot(turning, rate) + _dot(np.cross(at.w[k], turning), d)
            )
        if self.turn:
            i, j = self._t[:2]
            found[second:] = _dot(at.w[j] - at.w[i], self._leading(at)[1])
        return found

    def _leading(self, at: Posture) -> tuple[Array, Array]:
        """h and its rate."""
        i, j, a, p, b, q = self._t[:6]
        a, b = p[:, None] * _turned(at.R[i], a), q[:, None] * _turned(at.R[j], b)
        return a + b, np.cross(at.w[i], a) + np.cross(at.w[j], b)


def _turned(R: Array, u: Array) -> Array:
    return np.einsum("kij,kj->ki", R, u)


def _dot(a: Array, b: Array) -> Array:
    return np.einsum("ki,ki->k", a, b)


def _gap(at: Posture, i: Array, j: Array, p: Array, q: Array) -> Array:
    return at.x[j] + _turned(at.R[j], q) - at.x[i] - _turned(at.R[i], p)
