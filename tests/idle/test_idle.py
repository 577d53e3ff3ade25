"""Idle freedoms that are held: slippers, sleeves, swivels, telescopes off their line.

Against published examples solved at 50 digits, and against files that drive the idle coordinate.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from references import FOLDER

import mechkin_cli as mk

_DATA = json.loads((FOLDER / "exact" / "lecture_examples.json").read_text(encoding="utf-8"))
EXAMPLES = {e["name"]: e for e in _DATA["examples"] if e["passive_freedoms"]}
LIMIT = 1e-12
_OF_JOINTS = {"joint_displacement": "", "joint_velocity": "_dot", "joint_acceleration": "_ddot"}
_OF_LINKS = {"angular_velocity_zero_spin": "omega", "angular_acceleration_zero_spin": "alpha"}


def file_of(example: dict[str, Any]) -> str:
    """A mechanism file of an example; the notes call points and joints by the same names."""
    length = "mm" if example["units"].startswith("mm") else "m"
    links = ", ".join(f"{name}: {{}}" for name in example["links"] if name != "ground")
    lines = [f"format: 1\nunits: {{length: {length}}}\nlinks: {{{links}}}\njoints:"]
    for joint in example["joints"]:
        more = "".join(f", {key}: {joint[key]}" for key in ("axis", "normal") if key in joint)
        more += ", x: [0, 1, 0]" if joint["type"] == "E" else ""
        ends = ", ".join(joint["links"])
        lines.append(
            f"  j_{joint['name']}: "
            f"{{type: {joint['type']}, links: [{ends}], point: {joint['point']}{more}}}"
        )
    lines.append("points:")
    lines += [f"  p_{p['name']}: {{link: {p['link']}, at: {p['at']}}}" for p in example["points"]]
    lines.append("motion:\n  inputs:")
    for given in example["inputs"]:
        rates = f"rate: {given['velocity']} rad/s, acceleration: {given['acceleration']} rad/s^2"
        lines.append(f"    j_{given['joint']}.theta: {{at: {given['position']}, {rates}}}")
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("name", EXAMPLES)
def test_lecture_examples_with_idle_freedoms(name: str) -> None:
    example, met = EXAMPLES[name], 0
    model = mk.loads(file_of(example))
    analysis = model.analyze([])
    for wanted in example["expected"]:
        kind, value = wanted["quantity"], np.array(wanted["value"])
        if kind in _OF_JOINTS:
            joint = next(j for j in example["joints"] if j["name"] == wanted["joint"])
            part = {"R": "theta", "P": "s"}[joint["type"]]
            found = analysis[f"j_{wanted['joint']}.{part}{_OF_JOINTS[kind]}"][0]
            found = np.radians(found) if (part, kind) == ("theta", "joint_displacement") else found
        elif kind in ("position", "velocity", "acceleration"):
            found = analysis[f"p_{wanted['point']}.{kind}"][0]
        elif kind in _OF_LINKS:
            found = analysis[f"{wanted['link']}.{_OF_LINKS[kind]}"][0]
        elif kind == "mobility_without_passive":
            found = np.array(model.mobility().useful)
        else:
            continue
        met += 1
        assert np.max(np.abs(found - value)) <= LIMIT * max(1.0, np.max(np.abs(value))), wanted
    assert met >= 3
    assert analysis["row.status"].tolist() == ["ok"]


SLIPPER = """
format: 1
parameters: {tilt: 20 deg, r: 0.03 m}
links:
  plate: {mass: 2, center_of_mass: [0, 0, 0.01]}
  slipper: {mass: 0.5, center_of_mass: [r, OFF, 0], inertia: {xx: .1, yy: .1, zz: .1}}
  piston: {mass: 1, center_of_mass: [r, 0, 0.1]}
joints:
  R: {type: R, links: [ground, plate], point: [0, 0, 0], axis: [0, 0, 1]}
  E:
    type: E
    links: [plate, slipper]
    point: [r, 0, 0]
    normal: [sin(tilt), 0, cos(tilt)]
    x: [0, 1, 0]
  S: {type: S, links: [slipper, piston], point: [r, 0, 0]}
  P: {type: P, links: [ground, piston], point: [r, 0, 0], axis: [0, 0, 1]}
points: {rim: {link: slipper, at: [r, 0.01, 0]}}
motion: {inputs: {R.theta: {from: 0, to: 40, step: 10, rate: 9 rad/s}MORE}}
loads: [{type: gravity, g: [1, 2, -9.81]}]
tables: [{name: stroke, columns: [P.s]}]
"""
FORCES = ["R.effort", "P.s_ddot", "S.force", "E.force", "P.moment", "ground.shaking_moment"]


def slipper(off: str = "0", more: str = "", end: str = "") -> mk.Model:
    return mk.loads(SLIPPER.replace("OFF", off).replace("MORE", more) + end)


def codes(analysis: mk.Analysis) -> list[str]:
    return [diagnostic.code for diagnostic in analysis.diagnostics]


def test_what_is_conventional_is_said_and_nothing_else() -> None:
    analysis = slipper().analyze(
        ["E.theta", "E.x", "P.s", "S.force", "slipper.omega", "rim.position", "S.point", "E.axis"]
    )
    (note,) = [d for d in analysis.diagnostics if d.code == "conventional"]
    names = note.message.rpartition(": ")[2].split(", ")
    # the plate's pin lies on the line of the spin, so the coordinates of the plane do not know it
    assert sorted(names) == ["E.theta", "rim.position", "slipper.omega"]
    assert "slipper spins freely about" in note.message


def test_a_held_coordinate_stands_where_near_puts_it() -> None:
    end = "assembly: {near: {E.theta: 25}}\n"
    one, other = slipper().analyze(FORCES), slipper(end=end).analyze([*FORCES, "E.theta"])
    assert np.abs(other["E.theta"] - 25.0).max() < 1e-12
    for name in FORCES:
        size = max(1e-3, np.abs(one[name]).max())
        assert np.abs(one[name] - other[name]).max() <= 1e-11 * size, name


def test_idle_hold_is_what_a_drive_at_rest_carries() -> None:
    """A mass off the line turns the slipper; held, it needs the moment of a drive that stands."""
    refused = slipper("0.002")
    with pytest.raises(mk.UsageError, match="mass centre of slipper lies off that line"):
        refused.analyze(FORCES)
    held = slipper("0.002", end="idle: hold\n").analyze([*FORCES, "slipper.holding_moment"])
    driven = slipper("0.002", ", E.theta: {at: 0}").analyze([*FORCES, "E.effort"])
    assert "held-spin" in codes(held)
    assert np.abs(driven["E.effort"]).max() > 1e-3
    for one, other in [*((n, n) for n in FORCES), ("slipper.holding_moment", "E.effort")]:
        size = max(1e-3, np.abs(driven[other]).max())
        assert np.abs(held[one] - driven[other]).max() <= 1e-12 * size


@pytest.mark.parametrize(
    ("load", "words"),
    [
        ("{type: torque, link: slipper, torque: [0, 0, 1]}", "a torque acts on slipper"),
        ("{type: force, link: slipper, point: [0, 0, 0], force: [1, 0, 0]}", "off that line"),
        (
            "{type: force, link: slipper, point: [r, 0, 0], force: [0, 1, 0], axes: link}",
            "turns with slipper",
        ),
        ("{type: torque, joint: E, value: 3}", "a load acts on E.theta"),
        ("{type: damper, joint: E, coordinate: theta, damping: 2}", "a load acts on E.theta"),
    ],
)
def test_what_drives_an_idle_freedom_is_refused(load: str, words: str) -> None:
    text = SLIPPER.replace("OFF", "0").replace("MORE", "")
    text = text.replace("loads: [", f"loads: [{load}, ")
    with pytest.raises(mk.UsageError, match=words):
        mk.loads(text).analyze(FORCES)
    assert mk.loads(text).analyze(["P.s"]).result.complete


def test_one_position_and_other_parameters_go_with_what_is_held() -> None:
    model = slipper()
    analysis = model.analyze(["P.s", "P.s_ddot"])
    for row, theta in enumerate(analysis["R.theta"]):
        assert abs(model.solve({"R.theta": float(theta)})["P.s"] - analysis["P.s"][row]) < 1e-15
    varied = model.with_parameters({"r": "0.05 m", "tilt": "25 deg"}).analyze(["P.s"])
    theta, tilt = np.radians(varied["R.theta"]), np.radians(25.0)
    want = 0.05 * np.tan(tilt) * (1.0 - np.cos(theta))
    assert np.abs(varied["P.s"] - want).max() < 1e-15


STRUT = """
format: 1
links: {{a: {{}}, body: {{{mass}}}, rod: {{}}, c: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  S1: {{type: S, links: [a, body], point: [0.3, 0.1, 0.2]}}
  T: {{type: {kind}, links: [body, rod], point: [0.3, 0.1, 0.2], axis: {axis}}}
  S2: {{type: S, links: [rod, c], point: [1.1, 0.6, 0.9]}}
  C: {{type: R, links: [ground, c], point: [1, 0, 0], axis: [0.1, 1, 0.3]}}
motion: {{inputs: {{A.theta: {{from: 0, to: 20, step: 10, rate: 1 rad/s}}, T.s: {{at: 0.05}}}}}}
"""
WAY = np.array([0.8, 0.5, 0.7])


def rounded(vector: np.ndarray, digits: int) -> str:
    return str([float(f"{c:.{digits - 1}e}") for c in vector])


@pytest.mark.parametrize("kind", ["P", "C"])
@pytest.mark.parametrize("digits", [16, 12, 9, 8, 7, 6, 4, 2])
def test_a_leg_is_solved_however_its_slide_is_written(kind: str, digits: int) -> None:
    """Off the line by d, the spheres are off their distance by d^2: closer than was written."""
    exact = mk.loads(STRUT.format(kind="P", axis="[0.8, 0.5, 0.7]", mass=""))
    names = ["C.theta", "C.theta_dot", "A.effort"]
    want = exact.analyze(names)
    axis = rounded(WAY / np.sqrt(WAY @ WAY), digits)
    found = mk.loads(STRUT.format(kind=kind, axis=axis, mass="")).analyze(names)
    assert found["row.status"].tolist() == ["ok"] * 3
    off = 10.0 ** (1 - digits)
    for name in names:
        assert np.abs(found[name] - want[name]).max() <= 100 * (off * off * 57.3 + 1e-13), name


@pytest.mark.parametrize("digits", [16, 12, 9])
def test_a_mass_centre_lies_on_the_line_as_far_as_it_is_written(digits: int) -> None:
    centre = rounded(np.array([0.3, 0.1, 0.2]) + WAY / 3, digits)
    mass = f"mass: 1, center_of_mass: {centre}"
    text = STRUT.format(kind="P", axis="[0.8, 0.5, 0.7]", mass=mass)
    assert mk.loads(text).analyze(["A.effort"]).result.complete


@pytest.mark.parametrize("more", [", P.s: {at: 0}", ", P.s: {from: 0, to: 0.004, count: 5}"])
def test_inputs_that_cannot_drive_it_are_called_dependent(more: str) -> None:
    found = [d for d in slipper(more=more).analyze(["P.s"]).diagnostics if d.severity == "error"]
    assert [d.code for d in found] == ["inputs-dependent"]
    assert "R.theta, P.s" in found[0].message


def test_a_link_between_parallel_planes_is_held_in_all_it_may_do() -> None:
    """Two planes with a pad between them: a plane on a plane. Its link turns idly, too."""
    pad = """
format: 1
links: {crank: {}, pad: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: E, links: [crank, pad], point: [0.3, 0.2, 0.1], normal: [1, 2, 3], x: [3, 0, -1]}
  C: {type: E, links: [pad, rocker], point: [0.5, 0.2, 0.3], normal: [1, 2, 3], x: [3, 0, -1]}
  D: {type: Sg, links: [rocker, ground], point: [0.9, 0.1, 0], groove: [1, 1, 2]}
motion: {inputs: {A.theta: {from: 0, to: 20, step: 5, rate: 2 rad/s}}}
"""
    plain = pad.replace("pad: {}, ", "").replace("[crank, pad]", "[crank, rocker]")
    plain = "\n".join(line for line in plain.split("\n") if "  C:" not in line)
    names = ["D.s", "D.s_dot", "D.s_ddot"]
    found, want = mk.loads(pad).analyze(names), mk.loads(plain).analyze(names)
    assert found["row.status"].tolist() == want["row.status"].tolist() == ["ok"] * 5
    assert np.abs(want["D.s"]).max() > 1e-2
    for name in names:
        assert np.abs(found[name] - want[name]).max() < 1e-12
