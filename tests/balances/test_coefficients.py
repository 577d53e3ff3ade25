"""Coefficients of the inputs' accelerations, against free bodies at 40 digits and closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf
from oracle import Mechanism, Solution, assemble, document, newton_euler, read, solve, to_text
from oracle.bodies import Bodies, Placement
from oracle.numerics import mp as oracle
from oracle.vectors import add, apply
from properties.answers import EPS, at_row, errors, kind, within
from properties.case import Case
from properties.cases import case
from properties.expected import expected
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.mechanism.derived import COEFFICIENT_KINDS
from mechkin_cli.mechanism.problem import response_problem

SOME = [*(f"loop {seed}" for seed in range(0, 24, 4)), *(f"structure {s}" for s in range(2, 14, 3))]


def at_other_rates(its: Case, mechanism: Mechanism, orders) -> Solution:
    """The place of a case with (rate, acceleration) of each input."""
    inputs = {n: (its.solution[n], *orders(n)) for n in its.mechanism.inputs}
    if len(its.mechanism.joints) > len(its.mechanism.links) + 1 or "structure" in its.text:
        return assemble(mechanism, inputs, guess=its.solution)
    return solve(mechanism, inputs, guess=its.solution.coordinates)


def is_linear(name: str) -> bool:
    return name.endswith(("_ddot", ".acceleration", ".alpha")) or (
        kind(name).order is None and not name.startswith("row.")
    )


def check(its: Case, found: dict[str, np.ndarray], wanted: dict[str, np.ndarray]) -> None:
    """Rates and positions are there for the scales of what is compared."""
    others = {n: v for n, v in wanted.items() if n not in found and not is_linear(n)}
    wanted = others | {n: wanted[n] for n in found}
    assert within(errors(others | found, wanted, its.size, its.condition), 2.0)


@pytest.mark.parametrize("which", SOME)
def test_both_parts_against_free_bodies(which):
    its = case(which)
    model = mk.loads(its.text)
    inputs = list(its.mechanism.inputs)
    names = [n for n, q in model.problem.quantities().items() if q.kind in COEFFICIENT_KINDS]
    # an effort has its long name only
    names = [n for n in names if ".effort" not in n or n.split(".")[2] == "effort"]
    analysis = model.analyze(names, tables=[])
    values = at_row({n: analysis[n] for n in names}, its.row)

    def part(suffix: str) -> dict[str, np.ndarray]:
        return {n.removesuffix(suffix): values[n] for n in names if n.endswith(suffix)}

    at_rest = replace(its.mechanism, loads=[])
    for by in inputs:
        solution = at_other_rates(its, at_rest, lambda n, by=by: (0, int(n == by)))
        wanted = expected(at_rest, solution, newton_euler(at_rest, solution))
        suffix = f".per.{by}_ddot" if len(inputs) > 1 else ".per_acceleration"
        found = part(suffix)
        assert all(map(is_linear, found))
        assert len(found) > 10
        check(its, found, wanted)
        inertia = values[f"{by}.reduced_inertia"]
        assert np.array_equal(inertia, found[f"{by}.effort"])
    rates = {n: its.solution[f"{n}_dot"] for n in inputs}
    solution = at_other_rates(its, its.mechanism, lambda n: (rates[n], 0))
    wanted = expected(its.mechanism, solution, newton_euler(its.mechanism, solution))
    check(its, part(".without_acceleration"), wanted)


def test_the_source_at_20_degrees():
    """365.068 of the effective inertia of section 3.5, from Lagrange's and free bodies' equations
    (reference/notes/response.md)."""
    data = document(RCSR)
    given = {"alpha1": 10, "alpha4": 20, "P1": 5, "P2": 10, "P3": 5, "P4": 10}
    for name, value in given.items():
        data["parameters"][name] = f"{value} {'deg' if name.startswith('alpha') else 'in'}"
    data["motion"] = {"inputs": {"O1.theta": {"at": "20"}}}
    data["assembly"] = {"near": {"O2.theta": "174.53", "O2.s": "-9.862", "O4.theta": "152.56"}}
    data["loads"] = [{"type": "torque", "joint": "O1", "value": "10"}]
    names = ["O1.theta.reduced_inertia", "O1.effort.without_acceleration"]
    r = mk.loads(to_text(data)).analyze(names, tables=[])
    assert abs(r["O1.theta.reduced_inertia"][0] - 365.068280) < 1e-6
    # alpha1(0) = 10 / J from rest
    assert abs(10 / r["O1.theta.reduced_inertia"][0] - 0.027392136028972) < 1e-14
    assert abs(r["O1.effort.without_acceleration"][0] + 10) < 1e-12


COHERENT = {"length": "in", "angle": "deg", "mass": "lbm", "force": "lbm*in/s^2"}


@pytest.mark.parametrize("name", ["rcsr", "rcsr_csr", "sevenr"])
def test_reduced_inertia_of_files_is_twice_the_kinetic_energy_at_unit_rate(name):
    data = document(FILE_OF[name])
    axes = {"x": ["1", "0", "0"], "y": ["0", "1", "0"], "z": ["0", "0", "1"]}
    data |= {"units": COHERENT, "tables": [], "points": {}, "directions": {}}
    for k, link in enumerate(data["links"]):
        body = {"mass": f"{k + 1}", "center_of_mass": ["0.3", f"{k}", "-0.5"]}
        data["links"][link] = data["links"][link] or body
    for link in data["links"]:
        data["points"][f"p_{link}"] = {"link": link, "at": ["0", "0", "0"]}
        for axis, vector in axes.items():
            data["directions"][f"{axis}_{link}"] = {"link": link, "vector": vector}
    for section in ("tables", "coefficients"):
        data.pop(section, None)
    mechanism, model = read(to_text(data)), mk.loads(to_text(data))
    (driven,) = mechanism.inputs
    coordinates = [*model.problem.mechanism.coordinates]
    names = [f"{driven}.reduced_inertia", *coordinates, *data["directions"]]
    names += [f"{point}.position" for point in data["points"]]
    analysis = model.analyze(names, tables=[])
    row = analysis.rows // 2

    def at(name: str) -> list:
        return [oracle.mpf(x) for x in np.atleast_1d(analysis[name][row]).tolist()]

    bodies, poses = Bodies(mechanism), {}
    for link, centre in bodies.centres.items():
        rotation = [list(r) for r in zip(*(at(f"{a}_{link}") for a in "xyz"), strict=True)]
        poses[link] = rotation, add(at(f"p_{link}.position"), apply(rotation, centre))
    angles = {
        joint: {c: oracle.radians(at(f"{joint}.{c}")[0]) for c in near} if near else near
        for joint, near in bodies.drawing().angles.items()
    }
    value = mechanism.row(row)[driven][0]
    solution = assemble(mechanism, {driven: (value, 1, 0, 0)}, placement=Placement(poses, angles))
    energy = expected(mechanism, solution, newton_euler(mechanism, solution))
    wanted = 2 * energy["row.kinetic_energy"][0]
    found = analysis[f"{driven}.reduced_inertia"][row]
    assert abs(found - wanted) < 1e-12 * wanted


SLIDER_CRANK = """
format: 1
links:
  crank: {mass: 2, center_of_mass: [0.03, 0.01, 0], inertia: {zz: .02}}
  rod: {mass: 1.5, center_of_mass: [0.25, 0, 0], inertia: {zz: .03}}
  slider: {mass: 3, center_of_mass: [0.4, 0, 0]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [0.1, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, slider], point: [0.4, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, slider], point: [0.4, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 0, to: 350, step: 10, rate: 3 rad/s, acceleration: 2 rad/s^2}}}
"""


def inertia_of_slider_crank(theta):
    """J(theta) from the velocities' closed forms."""
    r, rod = mpf("0.1"), mpf("0.3")
    beta = mp.asin(r * mp.sin(theta) / rod)
    # of the rod's angle -beta, and of its mass centre 0.15 from the pin
    turn = r * mp.cos(theta) / (rod * mp.cos(beta))
    slide = r * mp.sin(theta) + r * mp.cos(theta) * mp.tan(beta)
    along = mpf("0.15")
    vx = -r * mp.sin(theta) - along * mp.sin(beta) * turn
    vy = r * mp.cos(theta) - along * mp.cos(beta) * turn
    crank = mpf("0.02") + 2 * (mpf("0.03") ** 2 + mpf("0.01") ** 2)
    return crank + mpf("1.5") * (vx**2 + vy**2) + mpf("0.03") * turn**2 + 3 * slide**2


def test_eksergian_s_equation():
    """effort = J a + J' w^2/2 with J and J' of closed forms at 40 digits."""
    names = ["A.effort", "A.theta.reduced_inertia", "A.effort.without_acceleration"]
    r = mk.loads(SLIDER_CRANK).analyze(names)
    with mp.workdps(40):
        for row, degrees in enumerate(range(0, 351, 10)):
            theta = mp.radians(degrees)
            inertia = inertia_of_slider_crank(theta)
            slope = mp.diff(inertia_of_slider_crank, theta)
            assert abs(r["A.theta.reduced_inertia"][row] - inertia) < 1e-16 + 1e-14 * inertia
            rest = slope * mpf(3) ** 2 / 2
            assert abs(r["A.effort.without_acceleration"][row] - rest) < 1e-14
            assert abs(r["A.effort"][row] - (2 * inertia + rest)) < 1e-14


def test_reduced_inertia_holds_without_rates_and_loads():
    names = ["A.theta.reduced_inertia"]
    plain = mk.loads(SLIDER_CRANK).analyze(names)[names[0]]
    still = SLIDER_CRANK.replace("rate: 3 rad/s, acceleration: 2 rad/s^2", "rate: 0 rad/s")
    loaded = still + (
        "loads: [{type: gravity, g: [0, -9.81, 0]}, {type: force, joint: D, value: 'A.theta_dot*1 "
        "N*s/rad'}, {type: damper, joint: D, coordinate: s, damping: 4}]\n"
    )
    assert np.array_equal(mk.loads(loaded).analyze(names)[names[0]], plain)


def test_reactions_that_are_not_unique_have_no_coefficients():
    """The plane loop's pins share what is square to the plane; along it all is unique."""
    names = [
        "B.force.per_acceleration",
        "B.force.without_acceleration",
        "B.moment.per_acceleration",
    ]
    r = mk.loads(SLIDER_CRANK).analyze([*names, "B.force"])
    for name in names[:2]:
        assert np.isfinite(r[name][:, :2]).all()
    assert np.isnan(r["B.moment.per_acceleration"][:, 0]).all()
    assert any(d.code == "not-unique" for d in r.diagnostics)
    parts = r["B.force.per_acceleration"] * 2 + r["B.force.without_acceleration"]
    assert np.abs(parts - r["B.force"])[:, :2].max() < 1e-13


ARM = """
format: 1
links:
  upper: {mass: 2, center_of_mass: [0.3, 0, 0], inertia: {zz: .05}}
  lower: {mass: 1, center_of_mass: [0.9, 0, 0], inertia: {zz: .03}}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [upper, lower], point: [0.5, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 90, count: 4}, B.theta: {from: 0, to: 120, count: 4}}}
"""


def test_the_inertia_matrix_of_two_inputs():
    names = ["A.theta.reduced_inertia", "A.theta.effort.per.B.theta_ddot"]
    names += ["B.theta.reduced_inertia", "B.theta.effort.per.A.theta_ddot"]
    r = mk.loads(ARM).analyze(names)
    with mp.workdps(40):
        for row, degrees in enumerate((0, 40, 80, 120)):
            both = mpf("0.5") * mpf("0.4") * mp.cos(mp.radians(degrees))
            own = mpf("0.03") + mpf("0.16")
            wanted = (mpf("0.05") + 2 * mpf("0.09") + mpf("0.25") + own + 2 * both, own + both, own)
            for name, value in zip(names, (*wanted, wanted[1]), strict=True):
                assert abs(r[name][row] - value) < 4 * EPS


@pytest.mark.parametrize(("angle", "radian"), [("rad", 1.0), ("turn", 1.0)])
def test_reduced_inertia_is_in_the_units_of_inertia_whatever_angles_are(angle, radian):
    text = SLIDER_CRANK.replace("format: 1\n", f"format: 1\nunits: {{angle: {angle}}}\n")
    text = text.replace("from: 0, to: 350, step: 10,", "from: 0 deg, to: 350 deg, step: 10 deg,")
    name = "A.theta.reduced_inertia"
    found, wanted = (mk.loads(t).analyze([name])[name] for t in (text, SLIDER_CRANK))
    assert np.abs(found - radian * wanted).max() < 1e-15


def test_a_slide_has_a_reduced_mass():
    text = SLIDER_CRANK.replace("A.theta: {from: 0, to: 350, step: 10, rate: 3 rad/s", "XX")
    text = text.replace("XX, acceleration: 2 rad/s^2", "D.s: {at: -0.05 m")
    text = text.replace("motion:", "assembly: {near: {A.theta: 60}}\nmotion:")
    names = ["D.s.reduced_inertia", "A.theta", "A.theta_ddot.per_acceleration", "A.theta_ddot"]
    r = mk.loads(text).analyze(names)
    assert str(mk.loads(text).problem.quantities()["D.s.reduced_inertia"].dimension) == "mass"
    with mp.workdps(40):
        theta = mp.radians(mpf(float(r["A.theta"][0])))
        beta = mp.asin(mp.sin(theta) / 3)
        slide = -(mp.sin(theta) + mp.cos(theta) * mp.tan(beta)) / 10
        wanted = inertia_of_slider_crank(theta) / slide**2
        assert abs(r["D.s.reduced_inertia"][0] - wanted) < 1e-12 * wanted
        assert abs(r["A.theta_ddot.per_acceleration"][0] - 1 / slide) < 1e-12 / abs(slide)


@pytest.mark.parametrize("name", ["A.theta.reduced_inertia", "D.s.transmission_angle"])
def test_a_model_with_other_parameters_has_those_of_its_own_file(name):
    """Also where its size asks for another unit of length."""
    text = SLIDER_CRANK.replace("format: 1\n", "format: 1\nparameters: {k: 1}\n")
    for number in ("0.1", "0.4", "0.25", "0.03", "0.01"):
        text = text.replace(f"{number},", f"k*({number} m),")
    if name.startswith("D"):
        for joint, then in ("BC", "CD"):
            before, after = text.split(f"  {joint}: {{type: R")
            own, rest = after.split(", axis: [0, 0, 1]}\n  " + then)
            text = f"{before}  {joint}: {{type: S{own}}}\n  {then}{rest}"
        text = text.replace("inertia: {zz: .03}", "inertia: {yy: .03, zz: .03}")
    base = mk.loads(text)
    varied = base.with_parameters({"k": 37.0}).analyze([name])[name]
    fresh = mk.loads(text.replace("{k: 1}", "{k: 37}")).analyze([name])[name]
    assert np.allclose(varied, fresh, rtol=1e-12, atol=0)


@pytest.mark.parametrize("name", ["B.theta.reduced_inertia", "A.theta.per_acceleration"])
def test_what_has_none_says_what_has(name):
    with pytest.raises(mk.MechkinError) as caught:
        mk.loads(SLIDER_CRANK).analyze([name])
    assert "such as A.theta_ddot.per_acceleration" in str(caught.value) or (
        "inputs have a reduced inertia" in str(caught.value)
    )


def test_a_response_has_those_of_its_independent_coordinates():
    text = SLIDER_CRANK[: SLIDER_CRANK.index("motion:")] + (
        "responses: {go: {start: {A.theta: 20}, efforts: {A.theta: 1}, time: {from: 0, to: 1, "
        "step: 0.1}}}\n"
    )
    problem = mk.loads(text).problem
    assert problem.responses
    known = response_problem(problem, problem.responses["go"]).quantities()
    assert {"A.theta.reduced_inertia", "D.s_ddot.per_acceleration"} <= known.keys()
    assert "A.effort.without_acceleration" not in known
