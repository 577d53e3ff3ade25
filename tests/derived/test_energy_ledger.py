"""Work, dissipation and the energy balance of sweeps in time, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

import mechkin_cli as mk
from mechkin_cli.derived.quadrature import (
    integrals,
    interval_weights,
    largest_between,
    over_cycle,
    running_integral,
    running_integral_of_cycle,
)

SLIDER = """
format: 1
links:
  crank: {{mass: 2, center_of_mass: [0.03, 0.01, 0], inertia: {{zz: .02}}}}
  rod: {{mass: 1.5, center_of_mass: [0.25, 0, 0], inertia: {{zz: .03}}}}
  slider: {{mass: 3, center_of_mass: [0.4, 0, 0]}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [crank, rod], point: [0.1, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [rod, slider], point: [0.4, 0, 0], axis: [0, 0, 1]}}
  D: {{type: P, links: [ground, slider], point: [0.4, 0, 0], axis: [1, 0, 0]}}
motion:
  time: {{from: 0, to: 2, count: {count}}}
  inputs:
    A.theta: {{law: constant-acceleration, at: 20, rate: 3 rad/s, acceleration: 2 rad/s^2}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
  - {{type: spring, joint: D, coordinate: s, stiffness: 300, free: 0.05, preload: 4}}
  - {{type: damper, joint: D, coordinate: s, damping: 12}}
  - {{type: force, joint: D, value: "-30 N - 5 N*s/rad*A.theta_dot"}}
"""
NAMES = [f"row.{word}" for word in ("work", "dissipated", "energy_error")]


def test_the_balance_closes_as_the_rows_are_refined():
    errors = []
    for count in (51, 101, 201, 401):
        r = mk.loads(SLIDER.format(count=count)).analyze(NAMES)
        errors.append(r["row.energy_error"].max())
    assert errors[-1] < 1e-11
    # eighth order
    assert errors[1] / errors[2] > 200
    assert errors[2] / errors[3] > 200


def test_what_a_damper_takes():
    """c times the integral of the slide's rate squared, at 40 digits."""
    r = mk.loads(SLIDER.format(count=401)).analyze([*NAMES, "row.kinetic_energy"])

    def rate(t):
        theta, omega = mp.radians(20) + 3 * t + t * t, 3 + 2 * t
        beta = mp.asin(mp.sin(theta) / 3)
        return -(mp.sin(theta) + mp.cos(theta) * mp.tan(beta)) / 10 * omega

    with mp.workdps(20):
        places = mp.linspace(0, 2, 9)
        wanted = 12 * mp.quad(lambda t: rate(t) ** 2, places)
    assert abs(r["row.dissipated"][-1] - wanted) < 1e-10 * wanted
    assert r["row.work"][0] == r["row.dissipated"][0] == r["row.energy_error"][0] == 0.0


def test_friction_is_dissipated():
    """Of a slider alone against its weight: coefficient, weight and way."""
    text = """
format: 1
links: {{block: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints: {{D: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}}}
motion:
  time: {{from: 0, to: 2, count: 21}}
  inputs: {{D.s: {{law: constant-acceleration, at: 0, rate: 3, acceleration: 1}}}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
  - {{type: friction, joint: D, coefficient: {coefficient}, length: 60 mm, width: 30 mm}}
"""
    r = mk.loads(text.format(coefficient=0.1)).analyze([*NAMES, "D.s", "D.s.reduced_inertia"])
    assert np.abs(r["row.dissipated"] - 0.1 * 2 * 9.81 * r["D.s"]).max() < 1e-12
    assert r["row.energy_error"].max() < 1e-13
    assert np.abs(r["D.s.reduced_inertia"] - 2).max() < 1e-15
    smooth = mk.loads(text.format(coefficient=0)).analyze(NAMES)
    assert not smooth["row.dissipated"].any()


BLOCK = """
format: 1
links: {{block: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints: {{D: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}}}
motion:
  time: {{from: 0, to: 2, count: {count}}}
  inputs: {{D.s: {{law: constant-acceleration, at: 0, rate: 3, acceleration: -4}}}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
  - {{type: force, link: block, point: [0, 0, 0], force: [0, "25 N*cos(4 rad/s*time)", 0]}}
  - {{type: friction, joint: D, coefficient: 0.1, length: 60 mm, width: 30 mm}}
"""
"""It turns round at 0.75 s; its guide is pressed from below where cos(4 t) > 0.7848."""


@pytest.mark.parametrize("count", [4, 11, 101, 1001])
def test_friction_that_turns_round_and_contacts_that_change_sides(count):
    """However many rows there are, by the integral between all kinks at 30 digits."""
    r = mk.loads(BLOCK.format(count=count)).analyze([*NAMES, "time"])
    with mp.workdps(30):
        weight, first = mpf(2) * mpf("9.81"), mp.acos(mpf(2) * mpf("9.81") / 25) / 4
        kinks = [mpf(3) / 4, first, mp.pi / 2 - first, mp.pi / 2 + first]

        def power(t):
            return abs(weight - 25 * mp.cos(4 * t)) * abs(3 - 4 * t) / 10

        for time, found in zip(r["time"].tolist(), r["row.dissipated"].tolist(), strict=True):
            if count < 100 or time in (0.75, 2.0):
                places = [0, *(k for k in sorted(kinks) if k < time), time]
                assert abs(found - mp.quad(power, places)) < 1e-13 * 30
    assert r["row.energy_error"].max() < 1e-13


def test_what_rows_alone_cannot_tell_is_said(monkeypatch):
    """The balance closes although work and dissipation are both wrong: it says how much."""
    from mechkin_cli.sweep import sweep

    right = mk.loads(BLOCK.format(count=11)).analyze(NAMES)["row.dissipated"]
    monkeypatch.setattr(sweep, "motion_between", lambda result: None)
    r = mk.loads(BLOCK.format(count=11)).analyze(NAMES)
    size = max(np.abs(r[name]).max() for name in NAMES[:2])
    off = np.abs(r["row.dissipated"] - right) / size
    assert off.max() > 1e-3
    assert (off <= r["row.energy_error"] + 1e-15).all()


def test_an_integral_between_kinks_that_nothing_tells():
    """A jump and a bend without a function that parts pieces there, in closed form."""
    low, high = np.array([0.0, 0.5, 0.9]), np.array([0.5, 0.9, 2.0])

    def sample(at):
        values = np.stack([np.abs(at - 0.3), np.where(at > np.sqrt(2), np.exp(at), 0.0)])
        return values, np.empty((0, at.size))

    values, errors = integrals(low, high, sample, np.array([1e-13, 1e-13]))
    wanted = [0.5 * (0.09 + 0.04), 0.5 * (0.36 - 0.04), 0.5 * (1.7**2 - 0.36)]
    assert np.abs(values[0] - wanted).max() < 1e-13
    assert np.abs(values[1] - [0, 0, np.exp(2) - np.exp(np.sqrt(2))]).max() < 1e-12
    assert (np.abs(values[0] - wanted) <= errors[0] + 1e-15).all()


def test_what_has_no_digits_ends_with_its_error() -> None:
    """Of noise no piece is ever good, and each halving would leave twice as many."""
    random, places = np.random.default_rng(1), []

    def sample(at):
        places.append(at.size)
        return random.normal(size=(1, at.size)), np.empty((0, at.size))

    _, errors = integrals(np.arange(4.0), np.arange(4.0) + 1.0, sample, np.array([1e-13]))
    assert sum(places) < 20_000
    assert (errors > 1e-3).all()


def test_balls_that_rub_part_no_intervals():
    """Friction at a ball alone: no coordinate tells of its slip."""
    text = SLIDER.replace("C: {{type: R,", "C: {{type: S,").replace(
        ", axis: [0, 0, 1]}}\n  D", "}}\n  D"
    )
    text += "  - {{type: friction, joint: C, coefficient: 0.1, radius: 10 mm}}\n"
    few, many = (mk.loads(text.format(count=n)).analyze(NAMES) for n in (11, 201))
    assert np.abs(few["row.dissipated"] - many["row.dissipated"][::20]).max() < 1e-13 * 30
    assert max(r["row.energy_error"].max() for r in (few, many)) < 1e-12


def test_a_wrong_mass_would_show():
    """The ledger takes T from the masses and the work from reactions: they do not agree by form."""
    r = mk.loads(SLIDER.format(count=201)).analyze([*NAMES, "row.kinetic_energy"])
    gained = r["row.kinetic_energy"] - r["row.kinetic_energy"][0]
    part = np.abs(0.01 * gained) / np.maximum.accumulate(np.abs(r["row.work"]) + 1e-9)
    assert part.max() > 1e-3
    assert r["row.energy_error"].max() < 1e-8


def test_names_exist_where_rows_have_a_time():
    text = SLIDER.format(count=5).replace("  time: {from: 0, to: 2, count: 5}\n", "")
    text = text.replace("law: constant-acceleration, at: 20,", "from: 0, to: 90, count: 5,")
    with pytest.raises(mk.MechkinError, match="there is no quantity"):
        mk.loads(text).analyze(["row.work"])


def test_weights_integrate_polynomials():
    for points in (2, 5, 8):
        for place in range(points - 1):
            weights = interval_weights(points, place)
            for power in range(points):
                found = mp.fsum(mpf(w) * mpf(k) ** power for k, w in enumerate(weights))
                wanted = (mpf(place + 1) ** (power + 1) - mpf(place) ** (power + 1)) / (power + 1)
                assert abs(found - wanted) < 1e-15 * mpf(points) ** power


def test_order_of_the_running_integral():
    errors = []
    for count in (20, 40, 80):
        x = np.linspace(0.0, 3.0, count + 1)
        found = running_integral(np.cos(x), 3.0 / count)
        errors.append(np.abs(found - np.sin(x)).max())
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (slopes > 7.5).all()


def test_a_cycle_converges_faster_than_any_power():
    x = 2 * np.pi * np.arange(32) / 32
    values = 1 / (2 + np.cos(x))
    total, off = over_cycle(values, 2 * np.pi / 32)
    assert abs(total - 2 * np.pi / np.sqrt(3)) < 1e-14
    assert 1e-16 < off < 1e-7
    around = running_integral_of_cycle(values, 2 * np.pi / 32)
    assert abs(around[-1] - total) < 1e-14
    assert abs(around[16] - total / 2) < 1e-7


def test_the_largest_between_samples():
    x = 2 * np.pi * np.arange(72) / 72 + 0.02
    assert abs(largest_between(np.cos(x) + 0.1 * np.sin(2 * x)) - 1.0193983) < 1e-2
    assert abs(largest_between(np.cos(x)) - 1.0) < 1e-11
