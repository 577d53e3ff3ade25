"""Responses that end before their time, each with its verdict; their rows stay, empty."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from response.motions import off
from response.oscillators import lines, slider

import mechkin_cli as mk
from mechkin_cli import tolerances


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


def error_of(text: str) -> tuple[set[str], Any]:
    """The statuses of a response that ends before its time, and its error."""
    found = mk.loads(text).respond("run")
    (error,) = (d for d in found.diagnostics if d.severity == "error")
    return set(statuses(found)), error


PENDULUM = """format: 1
name: p
units: {length: m, angle: rad, force: N}
links: {bob: {mass: 2, center_of_mass: [0, -0.25, 0]}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: torque, joint: A, value: "-0.3 N*m*sign(A.theta_dot)"}
responses:
  run:
    start: {A.theta: 1}
    time: {from: 0, to: 20, step: 0.5}
"""


def test_a_jump_that_holds_names_its_load() -> None:
    words, error = error_of(PENDULUM)
    assert words == {"ok", "friction-undecided"}
    assert (error.code, error.place.line) == ("held-at-jump", 8)
    assert '"-0.3 N*m*sign(A.theta_dot)" jumps' in error.message


def test_a_load_that_steps_run_out_by_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tolerances, "MOST_RESPONSE_STEPS", 400)
    text = PENDULUM.replace("sign(A.theta_dot)", "abs(sin(1e3*A.theta))")
    words, error = error_of(text)
    assert "step-limit" in words
    assert (error.code, error.place.line) == ("step-limit", 8)
    assert "bends or jumps" in error.message


FOUR_BAR = """format: 1
name: four-bar
units: {length: m, angle: deg, force: N}
links:
  a: {mass: 1, center_of_mass: [0, 0.15, 0], inertia: {zz: 0.02}}
  b: {mass: 2, center_of_mass: [0.4, 0.4, 0], inertia: {zz: 0.07}}
  c: {mass: 1, center_of_mass: [0.9, 0.3, 0], inertia: {zz: 0.02}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [a, b], point: [0, 0.3, 0]}
  C: {type: C, links: [b, c], point: [0.8, 0.6, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, c], point: [1, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
responses:
  run: {start: {A.theta: 20}, time: {from: 0, to: 4, step: 1}, fixed_step: 1}
"""


def test_a_fixed_step_that_is_too_long_says_so() -> None:
    words, error = error_of(FOUR_BAR)
    assert words == {"ok", "step-limit"}
    assert "a fixed step of 1 s is too long" in error.message
    assert "shorter fixed_step" in error.hint
    rows = mk.loads(FOUR_BAR.replace("fixed_step: 1}", "fixed_step: 0.01}")).respond("run")
    assert set(statuses(rows)) == {"ok"}


def test_a_stop_without_a_value_says_so() -> None:
    stop = "    stop: [{value: 'sqrt(0.1 - A.theta/1 rad)', at: 0.3}]\n"
    words, error = error_of(PENDULUM + stop)
    assert words == {"step-limit"}
    assert (error.code, error.place.line) == ("stop-undefined", 13)


def test_a_drive_that_comes_to_its_end_says_so() -> None:
    """A crank of 0.5 and a rod of 1 m: the slide is driven from 1 to beyond 1.5 m, a pendulum
    hangs on the rod."""
    words, error = error_of("""format: 1
name: crank, rod, driven slide, pendulum
units: {length: m, angle: rad, force: N}
links:
  crank: {mass: 1, center_of_mass: [0.125, 0.24, 0], inertia: {zz: 0.1}}
  rod: {mass: 1, center_of_mass: [0.6, 0.2, 0], inertia: {zz: 0.1}}
  block: {mass: 1, center_of_mass: [1, 0, 0]}
  bob: {mass: 1, center_of_mass: [1, -0.5, 0], inertia: {zz: 0.1}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [crank, rod], point: [0.125, 0.4841229182759271, 0]}
  C: {type: C, links: [rod, block], point: [1, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, block], point: [1, 0, 0], axis: [1, 0, 0]}
  E: {type: R, links: [rod, bob], point: [1, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
responses:
  run:
    start: {E.theta: 0.5}
    driven: {D.s: {law: constant-rate, at: 0, rate: 1 m/s}}
    time: {from: 0, to: 1, step: 0.1}
""")
    assert words == {"ok", "branch-lost"}
    assert "ends at 0.5 s: D.s cannot be driven further" in error.message


def test_an_inertia_that_is_lost_on_the_way_is_named() -> None:
    """The steps become short for stability first, and the implicit method takes over; its stages
    that cannot be solved for are no branch point."""
    found = mk.load(Path(__file__).parent / "ends" / "lost_inertia.yaml").respond("run")
    assert set(statuses(found)) == {"ok", "singular-inertia"}
    words = " ".join(str(d) for d in found.diagnostics)
    # where a dense integration in the coordinates of all links ends, too
    assert "ends at 0.181614 s: J1.theta has no inertia" in words
