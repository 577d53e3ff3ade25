"""Responses that end before their time, each with its verdict; their rows stay, empty."""

from __future__ import annotations

from typing import Any

import numpy as np
from responses.motions import off
from responses.oscillators import lines, slider

import mechkin_cli as mk


def statuses(found: Any) -> list[str]:
    return [str(word) for word in found["row.status"]]


def test_a_motion_that_runs_away_is_cut_off() -> None:
    """m x'' = 6 m x^2, x = 1 / (1 - t)^2: there is nothing at t = 1."""
    text = slider(
        lines("- {type: force, joint: S, value: '12 N/m^2*S.s^2'}"),
        lines(
            "start: {S.s: 1, S.s_dot: 2}",
            "time: {from: 0, to: 2, step: 0.125}",
            "tolerance: 1e-12",
            indent=4,
        ),
    )
    found = mk.loads(text).respond("run")
    t, words = found["time"], statuses(found)
    assert off(t, 0.125 * np.arange(17)) == 0
    good = t < 1
    assert words[: int(np.sum(good))] == ["ok"] * 8
    assert set(words[8:]) == {"step-limit"}
    assert off(found["S.s"][good], 1 / (1 - t[good]) ** 2) < 1e-8
    assert np.all(np.isnan(found["S.s"][~good]))


MASSLESS = """format: 1
name: a link without mass
links:
  arm: {{mass: 1, center_of_mass: [0.5, 0, 0], inertia: {{zz: 0.1}}}}
  hand: {{{hand}}}
joints:
  A: {{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [arm, hand], point: [1, 0, 0], axis: [0, 0, 1]}}
responses:
  run:
    start: {{A.theta: 0, B.theta: 0}}
    efforts: {{A.theta: 1}}
    time: {{from: 0, to: 1, step: 0.25}}
"""


def test_a_freedom_without_inertia_is_named() -> None:
    found = mk.loads(MASSLESS.format(hand="")).respond("run")
    assert set(statuses(found)) == {"singular-inertia"}
    words = " ".join(str(d) for d in found.diagnostics)
    assert "B.theta has no inertia" in words
    assert "last place A.theta = 0 deg, B.theta = 0 deg" in words


def test_the_same_freedom_with_inertia_moves() -> None:
    """The check above can fail: a little inertia, and every row is there."""
    found = mk.loads(
        MASSLESS.format(hand="mass: 0.1, center_of_mass: [1, 0, 0], inertia: {zz: 0.01}")
    ).respond("run")
    assert set(statuses(found)) == {"ok"}


def test_a_motion_of_two_without_inertia_names_both() -> None:
    """Two hinges on one line with nothing between them: only their sum has an inertia."""
    text = """format: 1
name: two hinges on one line
links:
  ring: {}
  disc: {mass: 1, center_of_mass: [0, 0, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
joints:
  A: {type: R, links: [ground, ring], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ring, disc], point: [0, 0, 1], axis: [0, 0, 1]}
responses:
  run:
    start: {A.theta: 0, B.theta: 0}
    efforts: {A.theta: 1}
    time: {from: 0, to: 1, step: 0.25}
"""
    found = mk.loads(text).respond("run")
    assert set(statuses(found)) == {"singular-inertia"}
    words = " ".join(str(d) for d in found.diagnostics)
    assert "A.theta and B.theta together" in words


TINY = """format: 1
name: p
units: {{length: mm, force: N}}
links: {{bob: {{mass: 2, center_of_mass: [0, -250, 0]}}}}
joints: {{A: {{type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}}}
loads: [{{type: gravity, g: [0, -9810, 0]}}]
responses:
  run: {{start: {{A.theta: {swing}}}, time: {{from: 0, to: {end}, count: {count}}}}}
"""


def test_no_energy_is_missing_where_only_rounding_moves() -> None:
    """A swing of 1e-6 deg moves less energy than the rounding of the weight's."""
    found = mk.loads(TINY.format(swing=1e-6, end=10, count=11)).respond("run")
    assert np.nanmax(found["row.energy_error"]) < 1e-9


def test_energies_count_in_parts_of_what_moved_between_rows() -> None:
    """Half a period, at whose ends all rests at one height: what is missing counts in parts of the
    energy at the lowest place."""
    half = 0.587  # s, of a swing by 80 deg
    found = mk.loads(TINY.format(swing=80, end=half, count=2)).respond("run")
    assert 0 <= np.nanmax(found["row.energy_error"]) < 1e-9
