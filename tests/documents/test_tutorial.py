"""The tutorial: every command runs, prints what is shown, and the prose has the printed numbers."""

from __future__ import annotations

import csv
import re
from math import cos, pi, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from documents.reading import page
from documents.tutorial.running import comparable, runs
from documents.tutorial.steps import Step, steps

import mechkin_cli as mk

TUTORIAL = page("docs/tutorial.md")
LONGEST = 250


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[tuple[Step, str]]]:
    """The folder after the whole tutorial, and what each step printed."""
    folder = tmp_path_factory.mktemp("tutorial")
    return folder, list(runs(folder))


def test_every_command_prints_what_is_shown(done) -> None:
    again = "run `python -P tests/documents/tutorial`"
    assert len(done[1]) == 7
    for step, out in done[1]:
        assert comparable(out) == comparable(step.shown), again


def test_it_is_short_and_every_block_is_a_step() -> None:
    assert len(TUTORIAL.splitlines()) <= LONGEST
    fences = len(re.findall(r"^```\w+$", TUTORIAL, re.MULTILINE))
    assert fences == len(steps()) + sum(isinstance(s, Step) and bool(s.shown) for s in steps())


def numbers(done) -> dict[str, dict[str, float]]:
    """The summary with rows every degree: by word and column."""
    with (done[0] / "out" / "pump" / "motor.summary.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {
        row["summary"]: {
            key: float(value) for key, value in row.items() if key != "summary" and value
        }
        for row in rows
    }


def torque(theta: float, crank: float = 30.0, rod: float = 140.0) -> float:
    """Of the pump in N*mm from Lagrange's equation with the derivatives by differences.

    Rates are constant, so that the torque is the kinetic energy's slope, the weights' and the
    load's over the angle.
    """
    rate, g = 150.0 * 2.0 * pi / 60.0, 9806.65

    def state(angle: float) -> tuple[float, float, float]:
        """Kinetic energy (rate 1, in kg mm^2), height energy in N*mm, plunger's place."""
        h = 1e-5

        def places(a: float) -> np.ndarray:
            tilt = -sin(a) * crank / rod
            x = crank * cos(a) + rod * sqrt(1.0 - tilt**2)
            rod_x, rod_y = (crank * cos(a) + x) / 2.0, crank * sin(a) / 2.0
            return np.array(
                [crank / 4 * cos(a), crank / 4 * sin(a), rod_x, rod_y, x, np.arcsin(tilt)]
            )

        slope = (places(angle + h) - places(angle - h)) / (2.0 * h)
        masses = np.array([0.8, 0.8, 0.5, 0.5, 1.2, 900.0])
        kinetic = float(masses @ slope**2) / 2.0 + 600.0 / 2.0
        at = places(angle)
        height = (0.8 * at[1] + 0.5 * at[3]) * g / 1000.0
        return kinetic, height, float(at[4])

    h = 1e-4
    before, after = state(theta - h), state(theta + h)
    slopes = [(b - a) / (2.0 * h) for a, b in zip(before, after, strict=True)]
    load = -800.0 if slopes[2] * rate > 1.0 else 40.0
    return slopes[0] * rate**2 / 1000.0 + slopes[1] - load * slopes[2]


def test_the_peak_torque_against_lagranges_equation(done) -> None:
    found = numbers(done)
    angles = np.radians(np.arange(0.0, 360.0))
    values = np.array([torque(float(a)) for a in angles])
    assert found["peak"]["torque"] == pytest.approx(np.abs(values).max(), rel=1e-5)
    place = np.degrees(angles[np.abs(values).argmax()])
    assert found["peak at"]["torque"] == pytest.approx(place, abs=1e-9)
    # at rest positions the load jumps, where a row holds one of its two values
    assert found["rms"]["torque"] == pytest.approx(sqrt(float(np.mean(values**2))), rel=1e-4)


def test_the_page_of_quantities_tells_how_watts_are_written(done) -> None:
    r = mk.load(done[0] / "pump.yaml").analyze()
    expression = "O.effort*O.theta_dot/(1 W)"
    assert f"`{expression}`" in page("docs/quantities.md")
    watts = r["O.effort"] / 1000.0 * 150.0 * 2.0 * pi / 60.0
    assert r[expression] == pytest.approx(watts, rel=1e-12)
    assert r.unit(expression) == ""


def test_the_stroke_is_twice_the_crank(done) -> None:
    shown = next(out for step, out in done[1] if step.commands == "mechkin analyze pump.yaml\n")
    rows = [line.split() for line in shown.splitlines() if re.match(r" +\d+ ", line)]
    places = [float(row[1]) for row in rows]
    assert max(places) - min(places) == pytest.approx(60.0, abs=0.005)


def test_the_prose_has_the_numbers_that_were_printed(done) -> None:
    found = numbers(done)
    rms, peak = (found[word]["torque"] / 1000.0 for word in ("rms", "peak"))
    mean, most = (found[word]["power"] / 1000.0 for word in ("mean", "peak"))
    said = [
        f"delivers {rms:.1f} N*m continuously",
        f"and {peak:.1f} N*m briefly",
        f"to the watt, is {mean:.0f} W on average and {most:.0f} W at most",
        f"1500 rpm, {rms / 9.0:.2f} N*m and {peak / 9.0:.2f} N*m",
    ]
    plain = " ".join(TUTORIAL.split())
    assert [text for text in said if text not in plain] == []
    shown = next(out for step, out in done[1] if "bearings.summary" in step.commands)
    guide = re.search(r"^peak,.*,([\d.]+)$", shown, re.MULTILINE)
    assert guide is not None
    assert f"carries a side load of {float(guide[1]):.0f} N" in plain
