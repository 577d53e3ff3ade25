"""Circuits of planar four-bars against closed forms; thousands with MECHKIN_RANDOM=100.

Crank a on the ground d, coupler b, rocker c: the diagonal from the crank's pin to the rocker's
pivot is L^2 = a^2 + d^2 - 2 a d cos(theta), and assembles where |b - c| <= L <= b + c. At either
end coupler and rocker lie in line, so that both assemblies are the same there: the modes of one
input are one circuit where their range has ends, and two where the crank turns fully.
"""

from __future__ import annotations

import math
import os
import random
from fractions import Fraction
from typing import NamedTuple

import pytest
from mpmath import mp, mpf

import mechkin_cli as mk
from mechkin_cli.modes.circuits import End, Passage, Walker, joined, undecided

COUNT = 60 * int(os.environ.get("MECHKIN_RANDOM", "1"))
DEAD_CENTRE = 1e-9
"""Degrees that a dead centre may be off, but for what a rounding of the cosine moves it."""


class Bar(NamedTuple):
    """Lengths as the file writes them: crank, coupler, rocker, ground; the input in degrees."""

    a: str
    b: str
    c: str
    d: str
    at: float

    @property
    def lengths(self) -> tuple[Fraction, Fraction, Fraction, Fraction]:
        return Fraction(self.a), Fraction(self.b), Fraction(self.c), Fraction(self.d)

    @property
    def cosines(self) -> tuple[Fraction, Fraction]:
        """Between which the input's lies: those with the diagonal stretched and folded."""
        a, b, c, d = self.lengths
        stretched, folded = (a * a + d * d - s * s for s in (b + c, b - c))
        return stretched / (2 * a * d), folded / (2 * a * d)

    @property
    def turns_fully(self) -> bool:
        low, high = self.cosines
        return low < -1 and high > 1

    @property
    def ends(self) -> tuple[float, float]:
        """Of the range about the input, in degrees."""
        with mp.workdps(40):
            low, high = (mpf(x.numerator) / x.denominator for x in self.cosines)
            most = mp.degrees(mp.acos(low)) if low >= -1 else None
            least = mp.degrees(mp.acos(high)) if high <= 1 else None
            if least is None:
                assert most is not None
                return float(-most), float(most)
            if most is None:
                return float(least), float(360 - least)
            return float(least), float(most)

    def shift(self, end: float) -> float:
        """How far roundings of the lengths move an end, in degrees."""
        a, b, c, d = (float(x) for x in self.lengths)
        size = (a * a + d * d + (b + c) ** 2) / (2 * a * d)
        return math.degrees(5e-15 * size / abs(math.sin(math.radians(end))))

    def file(self) -> dict[str, object]:
        return {
            "format": 1,
            "plane": "xy",
            "units": {"length": "m"},
            "links": {"crank": {}, "coupler": {}, "rocker": {}},
            "joints": {
                "A": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]},
                "B": {"type": "R", "links": ["crank", "coupler"], "point": [f"{self.a} m", 0]},
                "C": {
                    "type": "R",
                    "links": ["coupler", "rocker"],
                    "point": {
                        "coupler": [f"{self.a} m + {self.b} m", 0],
                        "rocker": [f"{self.d} m", f"{self.c} m"],
                    },
                },
                "D": {"type": "R", "links": ["ground", "rocker"], "point": [f"{self.d} m", 0]},
            },
            "motion": {"inputs": {"A.theta": {"at": self.at}}},
        }


def bar(number: int) -> Bar:
    """One that depends on its number alone, of four kinds: any; coupler and rocker nearly the same;
    near a change point; with a narrow range about the crank along the ground."""
    rng = random.Random(number * 1_000_003 + 16)
    while True:
        a, b, c, d = (10 ** rng.uniform(-0.7, 0.7) for _ in range(4))
        gap = rng.choice([-1, 1]) * 10 ** rng.uniform(-12, -1)
        if number % 4 == 1:
            b = c + gap
        elif number % 4 == 2:
            d = rng.choice([a + b - c, a - b + c, b + c - a]) + gap
        elif number % 4 == 3:
            d = a + b + c - abs(gap)
        if min(a, b, c, d) < 0.1:
            continue
        one = Bar(*(f"{x:.12f}" for x in (a, b, c, d)), 0.0)
        low, high = one.cosines
        if low >= 1 or high <= -1 or low in (-1, 1) or high in (-1, 1):
            continue
        ends = (0.0, 360.0) if one.turns_fully else one.ends
        return one._replace(at=ends[0] + rng.uniform(0.05, 0.95) * (ends[1] - ends[0]))


def contradiction(one: Bar) -> str:
    """What `ranges` says otherwise; "" if nothing."""
    found = mk.load(one.file()).ranges()
    circuits = sorted(len(modes) for modes in found.circuits)
    if circuits != ([1, 1] if one.turns_fully else [2]):
        return f"circuits {found.circuits} {[str(x) for x in found.diagnostics]}"
    for item in found.ranges:
        if one.turns_fully:
            if item.turns != 1:
                return f"mode {item.mode} does not turn fully: {item}"
            continue
        for limit, end in zip((item.lower, item.upper), one.ends, strict=True):
            if limit.kind != "dead-centre":
                return f"mode {item.mode} ends by {limit.kind}"
            if not abs(limit.value - end) <= DEAD_CENTRE + one.shift(end):
                return f"mode {item.mode} ends at {limit.value!r} for {end!r}"
    return ""


def test_modes_are_one_circuit_where_their_range_has_ends() -> None:
    told = [(number, contradiction(bar(number))) for number in range(COUNT)]
    assert not [one for one in told if one[1]]


def test_the_closed_form_agrees_with_grashof() -> None:
    """The crank turns fully where it or the ground is the shortest link and shortest and longest
    together are less than the others."""
    kinds = set()
    for number in range(1000):
        one = bar(number)
        a, b, c, d = one.lengths
        shortest, *_, longest = sorted(one.lengths)
        grashof = 2 * (shortest + longest) < a + b + c + d
        kinds.add(one.turns_fully)
        assert one.turns_fully == (grashof and min(a, d) < min(b, c))
    assert kinds == {True, False}


def test_another_place_of_the_range_tells_the_same() -> None:
    """So does the mirror image, in which the ends change places."""
    for number in range(0, COUNT, 4):
        one = bar(number)
        first, *others = (
            mk.load(other.file()).ranges() for other in (one, moved(one), one._replace(at=-one.at))
        )
        for other in others:
            assert [len(modes) for modes in other.circuits] == [len(m) for m in first.circuits]
            assert [item.turns for item in other.ranges] == [item.turns for item in first.ranges]
        if one.turns_fully:
            continue
        (low, high), (_, mirrored) = one.ends, others
        for item in others[0].ranges:
            assert abs(item.lower.value - low) <= DEAD_CENTRE + one.shift(low)
            assert abs(item.upper.value - high) <= DEAD_CENTRE + one.shift(high)
        for item in mirrored.ranges:
            assert abs(item.lower.value + high) <= DEAD_CENTRE + one.shift(high)
            assert abs(item.upper.value + low) <= DEAD_CENTRE + one.shift(low)


def moved(one: Bar) -> Bar:
    low, high = (0.0, 360.0) if one.turns_fully else one.ends
    return one._replace(at=low + high - one.at)


def test_what_cannot_be_decided_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nothing beyond a dead centre could be followed."""
    climb = Walker._climb

    def stuck(
        walker: Walker, start: Passage, direction: float, first: Passage | None, **more: bool
    ) -> tuple[End, list[Passage]]:
        if first is None:
            return End("branch-lost", start[0]), []
        return climb(walker, start, direction, first, **more)

    swinging = next(one for one in map(bar, range(COUNT)) if not one.turns_fully)
    assert not mk.load(swinging.file()).ranges().diagnostics
    monkeypatch.setattr(Walker, "_climb", stuck)
    monkeypatch.setattr(Walker, "_back_to", lambda *_: [])
    found = mk.load(swinging.file()).ranges()
    assert found.circuits == (("A",), ("B",))
    (note,) = found.diagnostics
    assert (note.code, note.severity) == ("circuits-undecided", "warning")
    assert "whether circuits 1 and 2 are one is not known" in note.message
    turning = next(one for one in map(bar, range(COUNT)) if one.turns_fully)
    assert not mk.load(turning.file()).ranges().diagnostics


def test_a_circuit_that_was_walked_to_its_ends_has_no_part_in_others() -> None:
    first, second, third = ((frozenset(modes), True) for modes in ("A", "B", "CA"))
    assert joined([first]) == [first]
    assert joined([first, second, third]) == [second, (frozenset("AC"), True)]
    assert joined([first, second, (third[0], False)])[1] == (frozenset("AC"), False)
    assert not undecided([first, (second[0], False)], "A.theta")
    assert undecided([first, second], "A.theta")
