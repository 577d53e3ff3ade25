"""`Model.respond`: motions with closed forms, read as a caller reads them."""

import math

import mpmath
import numpy as np
import pytest

import mechkin_cli as mk

ROTOR = """\
format: 1
units: {length: mm, force: N}
parameters: {mass: 2 kg, arm: 250 mm, push: 3 N*m}
links:
  bob: {mass: mass, center_of_mass: [0, -arm, 0], inertia: {zz: 0.01 kg*m^2, xx: 0.01 kg*m^2}}
joints:
  A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}
points: {tip: {link: bob, at: [0, -500, 0]}}
"""
GRAVITY = "loads: [{type: gravity, g: [0, -9810, 0], runs: [fall, both]}]\n"
RESPONSES = """\
responses:
  spin:
    start: {A.theta: 30, A.theta_dot: 1 rad/s}
    efforts: {A.theta: push}
    time: {from: 0, to: 2, step: 0.25}
  fall:
    start: {A.theta: 80}
    time: {from: 0, to: 3, step: 0.1}
    stop: [{value: A.theta, at: 0, direction: up}, {value: time, at: 5}]
  both:
    start: {A.theta: 80}
    efforts: {A.theta: "-0.5 N*m*s/rad*A.theta_dot"}
    time: {values: [0, 0.5, 2]}
"""
INERTIA = 0.01 + 2.0 * 0.25**2


@pytest.fixture(scope="module")
def model() -> mk.Model:
    return mk.loads(ROTOR + GRAVITY + RESPONSES, "rotor.yaml")


def test_a_constant_torque_on_a_free_rotor(model: mk.Model) -> None:
    found = model.respond("spin", ["row.kinetic_energy", "row.work", "tip.velocity"])
    t = found["time"]
    assert t.tolist() == [0.25 * k for k in range(9)]
    rate = 1.0 + 3.0 / INERTIA * t
    angle = math.radians(30.0) + t + 1.5 / INERTIA * t * t
    assert found["A.theta"] == pytest.approx(np.degrees(angle), rel=1e-9)
    assert found["A.theta_dot"] == pytest.approx(rate, rel=1e-9)
    assert found["A.effort"].tolist() == [3000.0] * 9
    # in N*mm: the torque by the angle, and half the inertia by the rate's square
    assert found["row.work"] == pytest.approx(3000.0 * (angle - angle[0]), rel=1e-9, abs=1e-9)
    assert found["row.kinetic_energy"] == pytest.approx(500.0 * INERTIA * rate**2, rel=1e-9)
    assert found["norm(tip.velocity)"] == pytest.approx(500.0 * rate, rel=1e-9)
    assert np.nanmax(found["row.energy_error"]) < 1e-9
    assert set(found["row.status"]) == {"ok"}
    assert set(found["row.event"]) == {""}


def test_a_pendulum_stops_where_it_passes_below(model: mk.Model) -> None:
    """sin(theta/2) = k cd(w t): elliptic functions; the second passage of 0 is that upwards."""
    found = model.respond("fall")
    k = mpmath.sin(mpmath.radians(40))
    w = mpmath.sqrt(2.0 * 9.81 * 0.25 / INERTIA)
    period = 4 * mpmath.ellipk(k**2) / w
    times = found["time"]
    assert times[:-1].tolist() == [round(0.1 * n, 1) for n in range(times.size - 1)]
    assert times[-1] == pytest.approx(float(period * 3 / 4), rel=1e-9)
    exact = [
        float(mpmath.degrees(2 * mpmath.asin(k * mpmath.ellipfun("cd", w * t, m=k**2))))
        for t in times
    ]
    assert found["A.theta"] == pytest.approx(exact, abs=1e-6)
    assert found["row.event"].tolist() == [""] * (times.size - 1) + ["A.theta = 0 deg upwards"]
    assert found.result.complete


def test_loads_of_other_runs_do_not_act(model: mk.Model) -> None:
    damped = model.respond("both")
    assert damped["row.dissipated"][0] == 0.0
    assert damped["A.effort"] == pytest.approx(-500.0 * damped["A.theta_dot"], abs=1e-12)
    assert damped["row.work"][-1] < -100.0  # an effort against the motion takes energy away
    assert np.nanmax(damped["row.energy_error"]) < 1e-8


def test_a_varied_model_responds_as_a_file_with_these_values(model: mk.Model) -> None:
    varied = model.with_parameters({"mass": "3 kg", "push": "5 N*m"})
    written = mk.loads(
        (ROTOR + GRAVITY + RESPONSES).replace("mass: 2 kg", "mass: 3 kg").replace("3 N*m", "5 N*m")
    )
    for name in ("spin", "fall"):
        one, other = varied.respond(name), written.respond(name)
        assert one["A.theta"].tolist() == other["A.theta"].tolist()
        assert one["time"].tolist() == other["time"].tolist()
    assert varied.response("spin").efforts[0].amount == 5.0


def test_modes_at_the_start_of_a_response(model: mk.Model) -> None:
    (mode,) = model.modes(run="fall").modes
    assert mode.coordinates["A.theta"] == pytest.approx(80.0)
    with pytest.raises(mk.UsageError, match="there is no run fal; did you mean fall"):
        model.modes(run="fal")


def test_bad_use_says_what_there_is(model: mk.Model) -> None:
    with pytest.raises(mk.UsageError, match="needs a name; responses are spin, fall, both"):
        model.respond()
    with pytest.raises(mk.UsageError, match="there is no response spinn; did you mean spin"):
        model.respond("spinn")
    with pytest.raises(mk.UsageError, match=r"has no sweep: its file has no motion:.*spin"):
        model.analyze()
    with pytest.raises(mk.UsageError, match="has no sweep to vary; vary a response one by one"):
        model.vary({"mass": [1.0, 2.0]})
    with pytest.raises(mk.UsageError, match="there is no table fall; tables are spin"):
        model.respond("spin", tables=["fall"])
    with pytest.raises(mk.UsageError, match=r"there is no quantity A\.thetta"):
        model.respond("spin", ["A.thetta"])
    with pytest.raises(mk.UsageError, match="the file has no responses; add responses:"):
        mk.load("mechanisms/dissertation/rcsr.yaml").respond()


def test_the_bytes_do_not_depend_on_lanes_or_threads(model: mk.Model) -> None:
    first = model.respond("fall")["A.theta"].tobytes()
    assert model.respond("fall", lanes=2, threads=1)["A.theta"].tobytes() == first


def test_a_sweep_has_nothing_that_only_responses_have() -> None:
    sweep = mk.load("mechanisms/dissertation/rcsr.yaml").analyze(tables=[])
    for name in ("row.event", "row.work", "row.dissipated", "row.energy_error"):
        with pytest.raises(mk.ExpressionError, match=f"{name} is told of the rows of a response"):
            sweep[name]
