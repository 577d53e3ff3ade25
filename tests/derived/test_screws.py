"""Screws of links against joint axes, and against poses and rates at 40 digits."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest
from derived.exact_rows import solution
from mechanisms.runs import closings, edited, model, run
from oracle import mp
from oracle.vectors import add, apply, cross, dot, scale, subtract, turn

import mechkin_cli as mk

NAMES = ("axis", "point")
CHAIN = """
format: 1
units: {{length: mm, angle: deg}}
links: {{a: {{}}}}
joints: {{J: {joint}, links: [ground, a], point: [1, 2, 3], axis: [2, 1, 2]}}}}
motion: {{inputs: {inputs}}}
"""
FOOT = np.array([1, 2, 3]) - 10 / 9 * np.array([2, 1, 2])
"""The point of the line through (1, 2, 3) along (2, 1, 2) nearest to the origin."""
AXIS = np.array([2, 1, 2]) / 3


def chain(joint, inputs, quantities):
    text = CHAIN.format(joint="{" + joint, inputs=inputs)
    return mk.loads(text).analyze([f"a.{name}" for name in quantities], tables=[])


INSTANT = ("screw_axis", "screw_point", "screw_pitch")
FINITE = ("finite_axis", "finite_point", "finite_angle", "finite_slide")


@pytest.mark.parametrize("rate", [3, -0.002])
def test_a_pin_is_the_screw_axis(rate):
    found = chain("type: R", f"{{J.theta: {{from: 20, to: 170, step: 50, rate: {rate}}}}}", INSTANT)
    assert np.max(np.abs(found["a.screw_axis"] - np.sign(rate) * AXIS)) <= 4e-16
    assert np.max(np.abs(found["a.screw_point"] - FOOT)) <= 4e-15
    assert np.max(np.abs(found["a.screw_pitch"])) <= 4e-15


@pytest.mark.parametrize("lead", [5, -5])
def test_a_thread_has_its_lead_as_pitch(lead):
    inputs = "{J.theta: {from: -50, to: 130, step: 60, rate: 2}}"
    found = chain(f"type: H, lead: {lead}", inputs, (*INSTANT, *FINITE))
    assert np.max(np.abs(found["a.screw_pitch"] - lead / (2 * pi))) <= 1e-15
    assert np.max(np.abs(found["a.screw_point"] - FOOT)) <= 1e-14
    signs = np.array([-1, 1, 1, 1])
    assert np.max(np.abs(found["a.finite_axis"] - signs[:, None] * AXIS)) <= 1e-15
    assert np.max(np.abs(found["a.finite_angle"] - [50, 10, 70, 130])) <= 1e-13
    assert np.max(np.abs(found["a.finite_slide"] * 360 / lead - [50, 10, 70, 130])) <= 1e-13
    assert np.max(np.abs(found["a.finite_point"] - FOOT)) <= 2e-14


def test_the_pitch_is_advance_per_rad_whatever_the_file_counts_angles_in():
    its = chain("type: H, lead: 5", "{J.theta: {values: [10], rate: 2}}", INSTANT)
    quantity = its.result.quantity("a.screw_pitch")
    assert its.result.units.label(quantity.dimension) == "mm/rad"


def test_a_slide_has_a_direction_and_no_point():
    found = chain("type: P", "{J.s: {values: [-4, 0, 6], rate: 2}}", (*INSTANT, *FINITE))
    assert np.max(np.abs(found["a.screw_axis"] - AXIS)) <= 4e-16
    assert np.isnan(found["a.screw_point"]).all()
    assert np.isnan(found["a.screw_pitch"]).all()
    assert np.max(np.abs(found["a.finite_axis"][[0, 2]] - np.array([[-1], [1]]) * AXIS)) <= 4e-16
    assert np.isnan(found["a.finite_axis"][1]).all()
    assert np.isnan(found["a.finite_point"]).all()
    assert found["a.finite_angle"].tolist() == [0, 0, 0]
    assert found["a.finite_slide"] == pytest.approx([4, 0, 6], abs=1e-15)


def test_without_rates_the_input_moves_at_unit_rate():
    found = chain("type: H, lead: 5", "{J.theta: {from: 20, to: 170, step: 50}}", INSTANT)
    assert np.max(np.abs(found["a.screw_axis"] - AXIS)) <= 4e-16
    assert np.max(np.abs(found["a.screw_pitch"] - 5 / (2 * pi))) <= 1e-15


def test_a_link_at_rest_has_no_screw():
    """With the crank along the slide the slider stands still."""
    found = run("slider_crank")
    rests = np.isin(found["A.theta"], [0, 180, 360])
    assert np.array_equal(np.isnan(found["slider.screw_axis"]).all(axis=1), rests)


def test_a_cylindric_joint_screws_with_both_rates():
    inputs = "{J.theta: {values: [90, 180], rate: 4}, J.s: {values: [7, -7], rate: -3}}"
    found = chain("type: C", inputs, (*INSTANT, *FINITE))
    assert found["a.screw_pitch"] == pytest.approx([-0.75, -0.75], rel=1e-15)
    assert found["a.finite_angle"] == pytest.approx([90, 180], abs=1e-13)
    assert found["a.finite_slide"] == pytest.approx([7, -7], abs=1e-14)
    assert np.max(np.abs(found["a.finite_point"] - FOOT)) <= 1e-14


def test_the_coupler_of_a_parallelogram_only_shifts():
    """In 40 digits the velocity of every point of the coupler is that of the crank's end."""
    found = run("parallelogram")
    theta = np.radians(found["A.theta"])
    expected = np.array([[-mp.sin(t), mp.cos(t), 0] for t in theta], dtype=float)
    assert np.max(np.abs(found["two.screw_axis"] - expected)) <= 1e-14
    assert np.isnan(found["two.screw_pitch"]).all()
    chord = 2 * 0.3 * np.array([float(mp.sin(t / 2)) for t in theta])
    assert found["two.finite_slide"] == pytest.approx(chord, rel=1e-13)
    assert np.isnan(found["two.finite_point"]).all()


@pytest.mark.parametrize("row", [1, 13, 25])
@pytest.mark.parametrize("link", ["crank", "coupler", "rocker"])
def test_instant_screw_of_rcsr_against_the_oracle(row, link):
    its = solution("rcsr", row)
    omega = its.omega(link)
    place, velocity = its.motion(link, [1, -2, 3])[:2]
    square = dot(omega, omega)
    rate = mp.sqrt(square)
    axis = scale(omega, 1 / rate)
    centre = add(place, scale(cross(omega, velocity), 1 / square))
    point = subtract(centre, scale(axis, dot(axis, centre)))
    found = {name: run("rcsr")[f"{link}.screw_{name}"][row] for name in (*NAMES, "pitch")}
    assert max(abs(f - e) for f, e in zip(found["axis"], axis, strict=True)) <= 1e-14
    assert max(abs(f - e) for f, e in zip(found["point"], point, strict=True)) <= 1e-13
    assert abs(found["pitch"] - dot(omega, velocity) / square) <= 1e-13


@pytest.mark.parametrize("row", [1, 13, 25])
@pytest.mark.parametrize("link", ["crank", "coupler", "rocker"])
def test_finite_screw_of_rcsr_displaces_points(row, link):
    """Turned about the axis and shifted along it, drawn points come to where the oracle has
    them."""
    its = solution("rcsr", row)
    values = {
        name: run("rcsr")[f"{link}.finite_{name}"][row].tolist()
        for name in (*NAMES, "angle", "slide")
    }
    axis = [mp.mpf(x) for x in values["axis"]]
    point = [mp.mpf(x) for x in values["point"]]
    assert abs(dot(axis, axis) - 1) <= 1e-15
    assert abs(dot(axis, point)) <= 1e-14
    assert 0 <= values["angle"] <= 180
    rotation = turn(axis, mp.radians(values["angle"]))
    for drawn in ([0, 0, 0], [4, 0, 0], [1, -2, 5]):
        moved = add(apply(rotation, subtract(drawn, point)), point)
        moved = add(moved, scale(axis, mp.mpf(values["slide"])))
        expected = its.motion(link, drawn)[0]
        assert max(abs(m - e) for m, e in zip(moved, expected, strict=True)) <= 1e-13


def test_the_closing_joint_does_not_matter():
    names = [f"coupler.{name}" for name in (*INSTANT, *FINITE)]
    wanted = run("rcsr")
    for cut in closings("rcsr"):
        found = model("rcsr").analyze(names, tables=[], closed_at=cut)
        for name in names:
            size = np.max(np.abs(wanted[name]))
            assert np.max(np.abs(found[name] - wanted[name])) <= 1e-12 * size, (cut, name)


def test_a_spin_that_is_a_convention_is_noted():
    inputs = {"O1.theta": {"from": 0, "to": 20, "step": 10, "rate": 1}}
    found = edited("rssr", ["coupler.screw_axis", "rocker.finite_angle"], motion={"inputs": inputs})
    (note,) = found.diagnostics
    assert note.code == "conventional"
    assert note.message.endswith(": coupler.screw_axis")


def test_columns_take_components():
    table = {"name": "t", "columns": [{"label": "p", "value": "norm(crank.screw_point)"}]}
    found = edited("rcsr", [], tables=[table])
    assert found["norm(crank.screw_point)"] == pytest.approx(0, abs=1e-14)
    assert found["crank.finite_angle"] == pytest.approx(np.minimum(*turns()), abs=1e-12)


def turns():
    degrees = np.arange(150.0, 203.0, 2.0)
    return degrees, 360 - degrees


def test_sines_of_small_turns_keep_their_point():
    """The axis of a small turn is as exact as rounding over its angle allows."""
    found = chain("type: R", "{J.theta: {values: [0.001]}}", FINITE)
    limit = 4e-16 * 10 / radians(0.001)
    assert np.max(np.abs(found["a.finite_point"] - FOOT)) <= limit
    assert found["a.finite_angle"] == pytest.approx([0.001], abs=1e-13)
