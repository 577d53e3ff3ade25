"""Bushings in use: loops that are overconstrained without, responses, planes, what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.balances.dense import borne_wrenches, row_motion
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.kernel.functions import widths

MECHANISMS = Path(__file__).parents[2] / "mechanisms"

PARALLEL = """format: 1
plane: xy
units: {length: mm, force: N}
links: {one: {}, two: {}, three: {}, rod: {mass: 2, center_of_mass: [120, 80]}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0]}
  B: {type: R, links: [one, rod], point: [0, 80]}
  C: {type: R, links: [ground, two], point: [150, 0]}
  D: {type: R, links: [two, rod], point: [150, 80]}
  E: {type: R, links: [ground, three], point: [300, 0]}
  LAST
motion: {inputs: {A.theta: {values: [0, 20, -50]}MORE}}
loads:
  - {type: gravity, g: standard}
"""
HINGE = "F: {type: R, links: [three, rod], point: [300, 80]}"
RUBBER_HINGE = """  - {type: bushing, name: F, links: [three, rod], point: [300, 80],
     stiffness: {x: 500, y: 500}, free: {y: FREE}}
"""


def test_a_loop_too_many_has_unique_reactions_with_a_bushing() -> None:
    """Three parallel cranks of equal length: nothing says what each bears, unless the last is held
    by rubber; one that is drawn too long by .1 mm pushes by its stiffness times that."""
    r = mk.loads(PARALLEL.replace("LAST", HINGE).replace("MORE", "")).analyze()
    assert np.isnan(r["D.force"]).any()
    third = PARALLEL.replace("LAST", "").replace("MORE", ", E.theta: {with: A.theta}")
    for free in (0.0, 0.1):
        r = mk.loads(third + RUBBER_HINGE.replace("FREE", str(free))).analyze()
        angles = np.radians(r["A.theta"])
        push = 500 * free
        assert np.hypot(*r["F.force"].T) == pytest.approx(push, abs=1e-9)
        # along its crank, with which its axes turn
        along = np.stack([-np.sin(angles), np.cos(angles)], axis=1)
        assert r["F.force"] == pytest.approx(push * along, abs=1e-9)
        # what the other two bear is told by moments about B and the directions of two-force links
        weight, c = 2 * 9.80665, np.cos(angles)
        arm = 120 * weight - 300 * push * c
        down = (r["D.force"][:, 1] * 150) * 1.0
        assert down == pytest.approx(arm, rel=1e-9)
        assert r["E.effort"] == pytest.approx(np.zeros(3), abs=1e-7)


RUBBER = """format: 1
links: {mass: {mass: 2, center_of_mass: [0, 0, 0], inertia: {xx: .1, yy: .2, zz: .3}}}
joints: {pose: {type: F, links: [ground, mass], point: [0, 0, 0]}}
loads:
  - {type: bushing, name: b, links: [ground, mass], point: [0, 0, 0],
     stiffness: {x: 200, y: 300, z: 400, rx: 5, ry: 6, rz: 7}, damping: {x: 4}}
responses:
  swing:
    start: {pose.x: .01, pose.y: .02, pose.z: -.01, pose.rz: 0, pose.ry: 0, pose.rx: 0,
            pose.rz_dot: 1 rad/s}
    time: {from: 0, to: 1, step: 0.05}
    tolerance: 1e-12
"""


def test_a_mass_on_a_bushing_swings_as_its_matrix_says() -> None:
    r = mk.loads(RUBBER).respond("swing")
    t = r["time"]
    decay, omega = 4 / (2 * 2), np.sqrt(200 / 2 - (4 / 4) ** 2)
    x = 0.01 * np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))
    assert r["pose.x"] == pytest.approx(x, abs=1e-11)
    assert r["pose.y"] == pytest.approx(0.02 * np.cos(np.sqrt(150) * t), abs=1e-11)
    turn = np.degrees(np.sin(np.sqrt(7 / 0.3) * t) / np.sqrt(7 / 0.3))
    assert r["pose.rz"] == pytest.approx(turn, abs=1e-9)
    assert np.nanmax(r["row.energy_error"]) < 1e-11
    lost = 0.5 * 200 * 0.01**2 - (0.5 * 200 * r["pose.x"] ** 2 + r["pose.x_dot"] ** 2)
    assert r["row.dissipated"] == pytest.approx(lost, abs=1e-12)


def test_in_a_plane() -> None:
    """The same bushing in a plane and in space."""
    plane = """format: 1
plane: xy
links: {a: {}, b: {mass: 1, center_of_mass: [1, 1]}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [1, 0]}
motion: {inputs: {A.theta: {from: 0, to: 40, count: 5}, B.theta: {from: 0, to: -70, count: 5}}}
loads:
  - {type: bushing, name: m, links: [a, b], point: [1, 1], x: [1, 2],
     stiffness: {x: 10, y: 20, rz: 3}, free: {x: .1, rz: 20}}
"""
    space = """format: 1
links: {a: {}, b: {mass: 1, center_of_mass: [1, 1, 0]}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [1, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 40, count: 5}, B.theta: {from: 0, to: -70, count: 5}}}
loads:
  - {type: bushing, name: m, links: [a, b], point: [1, 1, 0], axes: {x: [1, 2, 0], y: [-2, 1, 0]},
     stiffness: {x: 10, y: 20, rz: 3}, free: {x: .1, rz: 20}}
"""
    one, other = mk.loads(plane).analyze(), mk.loads(space).analyze()
    for name in ("A.effort", "B.effort", "row.potential_energy"):
        assert one[name] == pytest.approx(other[name], rel=1e-13, abs=1e-14), name
    assert one["m.force"] == pytest.approx(other["m.force"][:, :2], rel=1e-13)
    assert one["m.shift"] == pytest.approx(other["m.shift"][:, :2], rel=1e-13)
    assert one["m.moment"] == pytest.approx(other["m.moment"][:, 2], rel=1e-13)
    assert one["m.turn"] == pytest.approx(other["m.turn"][:, 2], rel=1e-13)


BODY = """format: 1
links: {body: {}}
joints: {pose: {type: F, links: [ground, body], point: [0, 0, 0]}}
loads:
  - {type: bushing, WHAT}
"""
RIGHT = "links: [ground, body], point: [0, 0, 0], stiffness: {x: 1}"


@pytest.mark.parametrize(
    ("what", "code", "text"),
    [
        (RIGHT.replace("x: 1", "x: -1"), "indefinite-bushing", "stiffness along x is negative"),
        (f"{RIGHT}, damping: {{rz: -1}}", "indefinite-bushing", "damping along rz is negative"),
        (RIGHT.replace("ground", "grond"), "unknown-link", "no link grond"),
        (RIGHT.replace("ground", "body"), "same-link", "joined to itself"),
        (f"{RIGHT}, axes: {{x: [1, 0, 0], y: [1, 1, 0]}}", "axes-not-square", "a bushing must be"),
        (f"{RIGHT}, name: body", "name-clash", "already used in links"),
        (f"{RIGHT}, free: {{rz: 200}}", "bushing-turn", "less than half a turn"),
        (f"{RIGHT}, free: {{rx: 150, ry: 120}}", "bushing-turn", "less than half a turn"),
        (RIGHT.replace("{x: 1}", "[[1, 0], [0, 1]]"), "wrong-length", ""),
        (
            RIGHT.replace(
                "{x: 1}", str([[2.0 if i == k else 0.1 * k for k in range(6)] for i in range(6)])
            ),
            "not-symmetric",
            "x, y",
        ),
        (
            RIGHT.replace(
                "{x: 1}",
                str([[1.0 if i == k else 2.0 * (i + k == 1) for k in range(6)] for i in range(6)]),
            ),
            "indefinite-bushing",
            "not positive semidefinite",
        ),
        (
            RIGHT.replace("{x: 1}", str([[float(i * k == 0) for k in range(6)] for i in range(6)])),
            "indefinite-bushing",
            "not positive semidefinite",
        ),
    ],
)
def test_what_is_refused(what: str, code: str, text: str) -> None:
    with pytest.raises(InvalidFile) as refused:
        mk.loads(BODY.replace("WHAT", what))
    found = refused.value.diagnostics
    assert {each.code for each in found if each.severity == "error"} == {code}, found
    assert text in found[0].message


def test_a_direction_may_be_free_of_stiffness() -> None:
    """A matrix of rank one: a spring along a line that goes past the point."""
    way = np.array([1.0, 2, 0, 0, -0.5, 3])
    matrix = np.outer(way, way).tolist()
    text = BODY.replace("WHAT", RIGHT.replace("{x: 1}", str(matrix)))
    text += "motion: {inputs: {pose.x: {at: 0.1}, pose.y: {at: 0}, pose.z: {at: 0}, "
    text += "pose.rz: {at: 0}, pose.ry: {at: 0}, pose.rx: {at: 0}}}\n"
    r = mk.loads(text).analyze()
    assert [r[f"pose.{n}.effort"][0] for n in ("x", "y", "z", "rx", "ry", "rz")] == pytest.approx(
        0.1 * way
    )


MOUNTED = """format: 1
name: engine
units: {length: mm, angle: deg, mass: kg, force: N}
parameters: {k: 100 N/mm, across: 100 mm, free: 2 deg}
links: {engine: {mass: 100, center_of_mass: [10, 20, 300], inertia: {xx: 3e6, yy: 5e6, zz: 4e6}}}
joints: {pose: {type: F, links: [ground, engine], point: [0, 0, 0]}}
motion:
  inputs:
    pose.x: {from: 0, to: 10, count: 3, rate: 30}
    pose.y: {at: 3}
    pose.z: {at: -5}
    pose.rz: {from: 0, to: 50, count: 3, rate: 2}
    pose.ry: {at: 30}
    pose.rx: {at: -70}
loads:
  - {type: gravity, g: standard}
  - {type: bushing, name: a, links: [ground, engine], point: [across, 0, 0],
     stiffness: {x: k, y: 200, z: 500, rx: 2000, ry: 1e4, rz: 3e4}, damping: {x: 1, y: 2, rz: 4e3},
     free: {z: -2, rx: free}}
  - {type: bushing, links: [engine, ground], point: [-100, 50, 0],
     axes: {x: [1, 1, 0], y: [-1, 1, 1]}, stiffness: {x: 2*k, rz: 3e4}}
"""
ASKED = ["a.force", "a.moment", "pose.rx.effort", "row.potential_energy"]


@pytest.mark.parametrize("size", [0, 70, 9000])
def test_the_dense_balance_has_them(size: int) -> None:
    """Forces on the body and their moments, written down once more without the kernel; a crank
    beside it (mm) makes the mechanism, and the kernel's unit of length, larger and smaller."""
    text = MOUNTED
    if size:
        turn = "axis: [0, 0, 1]}"
        joints = (
            f"C: {{type: R, links: [ground, crank], point: [{size}, 0, 0], {turn}, "
            f"D: {{type: R, links: [crank, rod], point: [0, {size}, 0], {turn}, "
        )
        text = text.replace("links: {", "links: {crank: {}, rod: {}, ", 1)
        text = text.replace("joints: {", f"joints: {{{joints}", 1)
        text = text.replace(
            "  inputs:\n", "  inputs:\n    C.theta: {at: 0}\n    D.theta: {at: 0}\n"
        )
    model = mk.loads(text)
    assert (model.session.layout.length == 1.0) == (not size)
    r = model.analyze()
    for row in range(3):
        motion = row_motion(r.result, row)
        borne = borne_wrenches(r.result, motion, row)["engine"]
        force, point = r["pose.total_force"][row], 1e-3 * r["pose.point"][row]
        moment = 1e-3 * r["pose.total_moment"][row] + np.cross(point, force)
        assert borne.force == pytest.approx(-force, rel=1e-12)
        assert borne.moment == pytest.approx(-moment, rel=1e-12)


def test_variants_and_recorded_numbers() -> None:
    """Variants in the kernel are the files with other parameters; true errors are of rounding."""
    model = mk.loads(MOUNTED)
    values = {"k": [100.0, 120.0, 300.0], "across": [100.0, 90.0, 110.0], "free": [2.0, 3.0, 4.0]}
    varied = model.vary(values, ASKED)
    for k in range(3):
        texts = {"k": "N/mm", "across": "mm", "free": "deg"}
        given = {name: f"{values[name][k]!r} {unit}" for name, unit in texts.items()}
        one = model.with_parameters(given).analyze()
        for name in ASKED:
            assert varied[name][k] == pytest.approx(one[name], rel=1e-12), name
    r = model.analyze()
    for name in ASKED:
        assert np.all(r.errors[name] < 1e-13 * np.abs(r[name]).max()), name


def test_unstable_matrices_are_found_where_parameters_make_them() -> None:
    model = mk.loads(MOUNTED.replace("x: 2*k", "x: k - 50 N/mm"))
    with pytest.raises(InvalidFile, match="stiffness along x is negative"):
        model.with_parameters({"k": "40 N/mm"}).analyze()


def test_no_effort_acts_at_a_pose() -> None:
    text = RUBBER.replace("    time:", "    efforts: {pose.x: 3}\n    time:")
    with pytest.raises(InvalidFile, match="carries no effort"):
        mk.loads(text)


BEAM = """format: 1
units: {length: mm, force: N, angle: rad}
links: {beam: {mass: 30, center_of_mass: [100, 0, 0]}}
joints: {pose: {type: F, links: [ground, beam], point: [0, 0, 0]}}
loads:
  - {type: gravity, g: standard}
  - {type: bushing, name: left, links: [ground, beam], point: [-500, 0, 0], stiffness: STIFF}
  - {type: bushing, name: middle, links: [ground, beam], point: [0, 0, 0], stiffness: STIFF}
  - {type: bushing, name: right, links: [ground, beam], point: [500, 0, 0], stiffness: STIFF}
equilibria:
  rest: {near: {pose.x: 0, pose.y: 0, pose.z: 0, pose.rz: 0, pose.ry: 0, pose.rx: 0}}
"""


def test_a_beam_on_three_stiff_mounts() -> None:
    """Statically undetermined on three rigid supports; on three equal stiff mounts they share the
    weight as a straight beam sinks: W/3 + W a x / (sum of x^2)."""
    stiff = "{x: 1e6, y: 1e6, z: 1e6, rx: 1e6}"
    r = mk.loads(BEAM.replace("STIFF", stiff)).equilibrium("rest")
    weight = 30 * 9.80665
    for name, x in (("left", -500), ("middle", 0), ("right", 500)):
        share = weight / 3 + weight * 100 * x / (2 * 500**2)
        assert r[f"{name}.force"][0, 2] == pytest.approx(share, rel=1e-5), name
    # what is left of forces at rest is rounding
    total = sum(r[f"{name}.force"][0] for name in ("left", "middle", "right"))
    assert total == pytest.approx([0, 0, weight], abs=1e-6)


def test_the_same_bits_in_all_lanes() -> None:
    one = mk.loads(MOUNTED).analyze(ASKED, threads=1)
    for lanes in widths():
        other = mk.loads(MOUNTED).analyze(ASKED, lanes=lanes, threads=1)
        for name in ASKED:
            assert (one[name] == other[name]).all(), name


def test_a_bushing_on_an_idle_link_is_told() -> None:
    """A rod between two balls that a bushing would turn about its line."""
    text = (MECHANISMS / "classics" / "rssr.yaml").read_text(encoding="utf-8")
    bushing = "{type: bushing, links: [ground, coupler], point: middle, stiffness: {rx: 3}}"
    with pytest.raises(InvalidFile, match="a bushing holds coupler"):
        mk.loads(text.replace("loads:\n", f"loads:\n  - {bushing}\n")).analyze()
