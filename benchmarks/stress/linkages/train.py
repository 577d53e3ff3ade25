"""Planar four-bars in a row, written as R R R R: the rocker of one is the crank of the next.

Every loop is overconstrained in space and a block of its own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.stress.linkages.moving import Field
from benchmarks.stress.linkages.writing import decimals, document, joint, swept
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Number
from benchmarks.stress.numbers.vectors import Swing
from benchmarks.stress.quantity import Mask, Quantity, Rows
from benchmarks.stress.reach import TURN, Margin

Z = (0.0, 0.0, 1.0)
HOME = 1e-9
"""Rad: so near to its drawing a link's sign does not say on which side of the turn it is."""
Plane = tuple[Number, Number]


@dataclass(frozen=True)
class FourBar:
    """Points A, B, C, D as drawn, (mechanisms, 2) each."""

    points: tuple[Rows, Rows, Rows, Rows]
    field: Field = DoubleDouble

    def _corners(self) -> tuple[Plane, Plane, Plane, Plane]:
        a, b, c, d = ((self.field(p[:, :1]), self.field(p[:, 1:])) for p in self.points)
        return a, b, c, d

    def swing(self, sine: Number, cosine: Number) -> Swing:
        """Of the rocker, at sine and cosine of the crank's angle."""
        a, b, c, d = self._corners()
        arm = _minus(b, a)
        end = (a[0] + cosine * arm[0] - sine * arm[1], a[1] + sine * arm[0] + cosine * arm[1])
        rod, rocker, target = _minus(c, b), _minus(c, d), _minus(end, d)
        along = target[0] * rocker[0] + target[1] * rocker[1]
        across = target[1] * rocker[0] - target[0] * rocker[1]
        d_term = (_square(rocker) + _square(target) - _square(rod)) * 0.5
        far = _square(rocker).sqrt() + _square(target).sqrt()
        radius = (along * along + across * across).sqrt()
        return Swing(along, across, d_term, radius, _square(rod), far)

    def margin(self, angle: Number) -> Margin:
        """The discriminant at the crank's angle in rad."""
        found = self.swing(*angle.sin_cos())
        return Margin(found.discriminant, found.blur())

    def sign(self) -> Rows:
        """Of the drawing's assembly, (mechanisms, 1)."""
        zeros = np.zeros((len(self.points[0]), 1))
        home = self.swing(DoubleDouble(zeros), DoubleDouble(zeros + 1.0))
        return np.where(home.b.high > 0.0, -1.0, 1.0)

    def flat(self) -> list[Margin]:
        """Margins where the crank lies along the line of the frame, one way and the other, which
        are their extremes."""
        a, b, _, d = self._corners()
        arm, frame = _minus(b, a), _minus(d, a)
        # the crank turns from its drawn direction to that of the frame
        length = (_square(arm) * _square(frame)).sqrt()
        sine = (arm[0] * frame[1] - arm[1] * frame[0]) / length
        cosine = (arm[0] * frame[0] + arm[1] * frame[1]) / length
        margins = []
        for way in (1.0, -1.0):
            found = self.swing(sine * way, cosine * way)
            margins.append(Margin(found.discriminant, found.blur()))
        return margins


@dataclass(frozen=True)
class Train:
    """Four-bars whose crank, after the first, is the rocker of the one before."""

    bars: tuple[FourBar, ...]
    whole_turns: bool = False
    """Whether every rocker turns fully with its crank, so that its whole turns are known."""

    def quantities(self, angle: Number) -> tuple[Quantity, ...]:
        """The coordinates at angles of the input in rad."""
        sine, cosine = angle.sin_cos()
        turns = None
        found: list[Quantity] = []
        if self.whole_turns:
            turns = angle.number
        for k, bar in enumerate(self.bars, start=1):
            place, sign = bar.swing(sine, cosine), bar.sign()
            other = _angle(*(x.number for x in place.sine_cosine(-sign)))
            sine, cosine = place.sine_cosine(sign)
            value = sine.arctan2(cosine)
            if turns is None:
                found.append(Quantity(f"D{k}.theta", "angle", value, other))
                continue
            value = value + _whole(value.number, turns)
            turns = value.number
            found.append(Quantity(f"D{k}.theta", "whole turns", value, other))
        return tuple(found)

    def turns_fully(self) -> tuple[Mask, Mask]:
        """Whether every crank turns fully, which its flat places decide, and whether rounding
        leaves that decided, (mechanisms, 1)."""
        exists = np.ones((len(self.bars[0].points[0]), 1), bool)
        decided = exists.copy()
        for bar in self.bars:
            for flat in bar.flat():
                exists &= flat.value.number.high > 0.0
                decided &= np.abs(flat.value.number.high) > flat.blur
        return exists, decided

    def as_written(self) -> Train:
        """The same of the numbers that its files say, in place of their doubles."""
        return replace(self, bars=tuple(replace(bar, field=decimals) for bar in self.bars))

    def size(self) -> Rows:
        """The diagonal of the box of the drawn points, (mechanisms, 1)."""
        spans = np.ptp(np.concatenate([np.stack(bar.points) for bar in self.bars]), axis=0)
        size: Rows = np.sqrt((spans * spans).sum(axis=1, keepdims=True))
        return size

    def margin(self, angle: Number) -> Margin:
        """That of the first four-bar, which is all where there is but one."""
        return self.bars[0].margin(angle)

    def text(self, k: int, name: str, degrees: Rows) -> str:
        """Mechanism k as a file, swept through the degrees."""
        return self.moved(k, name, swept("A.theta", degrees))

    def moved(self, k: int, name: str, motion: str) -> str:
        """Mechanism k as a file with this `motion:`."""
        first = self.bars[0]
        joints = {"A": joint("R", ("ground", "link0"), point=_solid(first.points[0][k]), axis=Z)}
        links = ["link0"]
        for n, bar in enumerate(self.bars, start=1):
            links += [f"rod{n}", f"link{n}"]
            pairs = {
                "B": (f"link{n - 1}", f"rod{n}"),
                "C": (f"rod{n}", f"link{n}"),
                "D": ("ground", f"link{n}"),
            }
            for (letter, pair), point in zip(pairs.items(), bar.points[1:], strict=True):
                joints[f"{letter}{n}"] = joint("R", pair, point=_solid(point[k]), axis=Z)
        return document(name, links, joints, motion)


def _minus(a: Plane, b: Plane) -> Plane:
    return a[0] - b[0], a[1] - b[1]


def _square(a: Plane) -> Number:
    return a[0] * a[0] + a[1] * a[1]


def _angle(sine: Number, cosine: Number) -> Number:
    return sine.arctan2(cosine)


def _whole(value: DoubleDouble, crank: DoubleDouble) -> DoubleDouble:
    """Whole turns (rad) of a link that is at home with its crank, turns as often and never back: it
    is within the crank's turn."""
    turns = np.floor((crank / TURN).high)
    late = (crank - TURN * turns).high > 0.5 * TURN.high
    behind = np.where(np.abs(value.high) < HOME, late, value.high < 0.0)
    return TURN * (turns + behind)


def _solid(point: Rows) -> tuple[float, float, float]:
    return float(point[0]), float(point[1]), 0.0
