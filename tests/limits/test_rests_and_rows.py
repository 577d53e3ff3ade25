"""When a rest ends does not go by the rows that are asked for: a mass on a shaken platform, in
closed form."""

from __future__ import annotations

import numpy as np
import pytest
from limits.machines import on_a_platform

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel

G, HERTZ = 8.0, 3.0


def landings(part_of_gravity: float, end: float) -> list[float]:
    """Moments at which it lands, of a platform whose largest acceleration is that part of g: it
    rests until the platform falls faster than it would, and lands where both are at one place."""
    turn = 2.0 * np.pi * HERTZ
    largest = part_of_gravity * G
    amplitude = largest / turn**2
    found, time = [], 0.0
    while True:
        # a w^2 sin w t = g, on the way up
        phase = np.arcsin(1.0 / part_of_gravity) / turn
        leaves = phase + np.ceil((time - phase) * HERTZ) / HERTZ
        inside = part_of_gravity * np.sin(turn * time) > 1.0
        leaves = time if inside else leaves
        place, rate = amplitude * np.sin(turn * leaves), amplitude * turn * np.cos(turn * leaves)

        def apart(t: float, start: float = leaves, at: float = place, fast: float = rate) -> float:
            off = t - start
            return at + fast * off - 0.5 * G * off * off - amplitude * np.sin(turn * t)

        low = leaves + 1e-4
        high = low
        while apart(high) > 0.0:
            low, high = high, high + 1e-4
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if apart(middle) > 0.0 else (low, middle)
        if high > end:
            return found
        found.append(high)
        time = high


def impacts(part_of_gravity: float, time: str) -> list[float]:
    amplitude = part_of_gravity * G / (2.0 * np.pi * HERTZ) ** 2
    drive = f"{{law: sine, amplitude: {amplitude!r} m, frequency: {HERTZ} Hz}}"
    table = mk.loads(on_a_platform(drive=drive, time=time), "platform").respond("run").impacts
    times = np.asarray(table.columns[0].values)
    return times[times > 0.0].tolist()  # it begins at rest


@pytest.mark.parametrize(
    "time",
    [
        "{from: 0, to: 5, count: 2}",
        "{from: 0, to: 5, count: 3}",
        "{from: 0, to: 5, count: 11}",
        "{from: 0, to: 5, count: 1001}",
        "{values: [0, 0.001, 0.002, 0.0025, 2.5, 2.6, 5]}",
    ],
)
@pytest.mark.parametrize("part", [1.026, 1.05, 1.2])
def test_lands_once_in_each_period(part: float, time: str) -> None:
    expected = landings(part, 5.0)
    assert 13 <= len(expected) <= 15
    assert impacts(part, time) == pytest.approx(expected, abs=1e-7)


@pytest.fixture
def edges(monkeypatch: pytest.MonkeyPatch) -> list[list[float]]:
    """The moments that every step of a motion looks at, of each motion."""
    given: list[list[float]] = []
    made = _kernel.DrivenLaws

    def laws(*arguments):
        given.append(arguments[1])
        return made(*arguments)

    monkeypatch.setattr(_kernel, "DrivenLaws", laws)
    return given


def test_turning_points_of_a_law_are_no_bends(edges: list[list[float]]) -> None:
    """What is looked at in every step does not grow with the periods of a sine."""
    impacts(0.5, "{from: 0, to: 50, count: 101}")
    assert edges
    assert all(each == [] for each in edges)


def test_ends_of_a_laws_pieces_are_bends(edges: list[list[float]]) -> None:
    rise, back = (f"{{for: 1 s, to: {to} m, law: harmonic}}" for to in (0.1, 0.0))
    drive = f"{{law: sequence, segments: [{rise}, {{for: 1 s, law: dwell}}, {back}]}}"
    mk.loads(on_a_platform(drive=drive), "platform").respond("run")
    assert edges
    assert all(each == pytest.approx([1.0, 2.0]) for each in edges)
