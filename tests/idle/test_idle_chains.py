"""Idle freedoms of neighbouring links, of concentric spheres, and slides between tilted planes,
against closed forms and against files without them."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

LIMIT = 1e-12


def turned(axis: np.ndarray, angle: float, vector: np.ndarray) -> np.ndarray:
    """Rodrigues' formula."""
    n = axis / np.sqrt(axis @ axis)
    along = n * (n @ vector)
    return along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(n, vector)


SPHERE_PLANE_SLEEVE = """
format: 1
links: {crank: {}, L1: {}, L2: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [1, 0, 0.2]}
  S: {type: S, links: [crank, L1], point: [0.1, 0.5, 0.2]}
  E: {type: E, links: [L1, L2], point: [0.5, 0.5, 0.6], normal: [0, 0, 1], x: [1, 0, 0]}
  C: {type: C, links: [L2, ground], point: [0.8, 0.1, 0.5], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 40, step: 10, rate: 1 rad/s}}}
"""


def test_two_links_that_turn_about_one_direction() -> None:
    """Between S and C with E in the middle only the height of the sphere's centre is told."""
    model = mk.loads(SPHERE_PLANE_SLEEVE)
    analysis = model.analyze(["C.s", "C.s_dot", "E.theta", "C.theta"])
    axis, centre = np.array([1.0, 0.0, 0.2]), np.array([0.1, 0.5, 0.2])
    for row, theta in enumerate(np.radians(analysis["A.theta"])):
        now = turned(axis, float(theta), centre)
        rate = np.cross(axis / np.sqrt(axis @ axis), now)[2]
        # C's second link is the ground, which moves down where the sleeve goes up
        assert abs(analysis["C.s"][row] + now[2] - centre[2]) < LIMIT
        assert abs(analysis["C.s_dot"][row] + rate) < LIMIT
    (one, other) = [d for d in analysis.diagnostics if d.code == "conventional"]
    assert "L1 spins freely about S-E" in one.message
    assert "L2 spins freely about E-C" in other.message
    assert len(model.mobility().idle) == 2
    assert model.mobility().useful == 1


def test_each_of_two_neighbours_may_be_driven() -> None:
    text = SPHERE_PLANE_SLEEVE.replace("rate: 1 rad/s}", "rate: 1 rad/s}, C.theta: {at: 20}")
    one, other = (mk.loads(t).analyze(["C.s"])["C.s"] for t in (SPHERE_PLANE_SLEEVE, text))
    assert np.abs(one - other).max() < LIMIT
    assert len(mk.loads(text).mobility().idle) == 1


CONCENTRIC = """
format: 1
links:
  crank: {mass: 1, center_of_mass: [0.2, 0.1, 0.1]}
  ball: {mass: 2, center_of_mass: OFF, inertia: {xx: 0.3, yy: 0.2, zz: 0.4}}
  slide: {mass: 1, center_of_mass: [0.6, 0.1, 0.2], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  sleeve: {mass: 1, center_of_mass: [1, 0.5, 0.3]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0.2, 1]}
  S: {type: S, links: [crank, ball], point: [0.4, 0.1, 0.2]}
  T: {type: S, links: [ball, slide], point: [0.4, 0.1, 0.2]}
  P: {type: P, links: [slide, sleeve], point: [0.9, 0, 0], axis: [1, 0.3, 0.1]}
  C: {type: C, links: [ground, sleeve], point: [1, 0.5, 0.3], axis: [0.2, 0.1, 1]}
motion: {inputs: {A.theta: {from: 0, to: 40, step: 10, rate: 5 rad/s}}}
loads: [{type: gravity, g: [0.5, 1, -9.81]}]
tables: [{name: stroke, columns: [C.s]}]
"""
MOVED = ["C.s", "C.theta", "P.s", "C.s_ddot", "P.s_ddot", "A.effort", "C.force", "P.moment"]


WELD = "  S: {type: W, links: [crank, ball]}"


def concentric(off: str = "[0.4, 0.1, 0.2]", end: str = "") -> mk.Model:
    return mk.loads(CONCENTRIC.replace("OFF", off) + end)


def test_a_link_between_concentric_spheres_turns_in_every_way() -> None:
    """As with one sphere, and the link's mass as a point of the crank."""
    plain = CONCENTRIC.replace("{xx: 0.3, yy: 0.2, zz: 0.4}", "{}").replace("[ball,", "[crank,")
    plain = plain.replace("  S: {type: S, links: [crank, ball], point: [0.4, 0.1, 0.2]}", WELD)
    plain = plain.replace("OFF", "[0.4, 0.1, 0.2]")
    model = concentric()
    assert len(model.mobility().idle) == 3
    one, other = model.analyze([*MOVED, "ball.omega"]), mk.loads(plain).analyze(MOVED)
    for name in MOVED:
        size = max(1e-3, float(np.abs(other[name]).max()))
        assert np.abs(one[name] - other[name]).max() < 1e-11 * size, name
    (note,) = [d for d in one.diagnostics if d.code == "conventional"]
    assert "ball spins freely about the centre of S-T" in note.message
    assert "ball.omega" in note.message


def test_a_mass_off_the_centre_turns_it_unless_it_is_held() -> None:
    with pytest.raises(mk.UsageError, match="mass centre of ball lies off that centre"):
        concentric("[0.4, 0.1, 0.3]").analyze(["A.effort"])
    names = [f"ball.holding_moment_{k}" for k in range(3)]
    held = concentric("[0.4, 0.1, 0.3]", "idle: hold\n").analyze([*MOVED, *names])
    # held, the ball is a part of the crank
    weld = CONCENTRIC.replace("  S: {type: S, links: [crank, ball], point: [0.4, 0.1, 0.2]}", WELD)
    weld = weld.replace("OFF", "[0.4, 0.1, 0.3]")
    other = mk.loads(weld).analyze([*MOVED, "S.moment_about_origin", "S.force"])
    for name in MOVED:
        size = max(1e-3, float(np.abs(other[name]).max()))
        assert np.abs(held[name] - other[name]).max() < 1e-11 * size, name
    moment = np.array([held[name] for name in names])
    force = other["S.force"]
    force = force.T if force.shape[0] != 3 else force
    about = other["S.moment_about_origin"]
    about = about.T if about.shape[0] != 3 else about
    axis, centre = np.array([0.0, 0.2, 1.0]), np.array([0.4, 0.1, 0.2])
    for row, theta in enumerate(np.radians(held["A.theta"])):
        at = turned(axis, float(theta), centre)
        whole = about[:, row] - np.cross(at, force[:, row])
        assert abs(np.linalg.norm(whole) - np.linalg.norm(moment[:, row])) < 1e-9


TILTED = """
format: 1
links: {a: {}, pad: {MASS}, b: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0.9, 0.2, 0.3]}
  B: {type: E, links: [ONE], point: [0.5, -0.2, 0], normal: [1, 0, 0.2], x: [0, 1, 0]}
  C: {type: E, links: [TWO], point: [1, 0.1, 0.3], normal: [0.2, -0.6, 0.8], x: [1, 0, 0]}
  D: {type: R, links: [b, ground], point: [-0.6, 0, -0.7], axis: [-0.9, 0.1, 0.4]}
motion: {inputs: {A.theta: {from: 0, to: -48, step: 4, rate: 1 rad/s}}}
tables: [{name: turn, columns: [D.theta]}]
"""


@pytest.mark.parametrize("one", ["a, pad", "pad, a"])
@pytest.mark.parametrize("two", ["b, pad", "pad, b"])
def test_a_slide_between_tilted_planes_is_held_wherever_their_coordinates_stand(
    one: str, two: str
) -> None:
    """Two planes keep the angle of their normals: D.theta by bisection of it."""
    text = TILTED.replace("MASS", "").replace("ONE", one).replace("TWO", two)
    model = mk.loads(text)
    analysis = model.analyze(["D.theta"])
    assert analysis["row.status"].tolist() == ["ok"] * 13
    n, m = np.array([1.0, 0.0, 0.2]), np.array([0.2, -0.6, 0.8])
    a, d = np.array([0.9, 0.2, 0.3]), np.array([-0.9, 0.1, 0.4])

    def miss(theta: float, phi: float) -> float:
        # D turns the ground against b
        return float(turned(a, theta, n) @ turned(d, -phi, m) - n @ m)

    for theta, phi in zip(
        np.radians(analysis["A.theta"]), np.radians(analysis["D.theta"]), strict=True
    ):
        assert abs(miss(float(theta), float(phi))) < LIMIT
    assert np.abs(np.diff(analysis["D.theta"])).max() < 30.0
    assert [i.sentence for i in model.mobility().idle] == [
        "pad slides freely along the axis of B, C"
    ]


def test_the_force_that_holds_a_slide() -> None:
    """A pad with mass needs it; without gravity and accelerations it would be none."""
    text = TILTED.replace("ONE", "a, pad").replace("TWO", "b, pad")
    text = text.replace("MASS", "mass: 2, center_of_mass: [0.7, 0, 0.1]")
    text += "loads: [{type: gravity, g: [0, 0, -9.81]}]\n"
    with pytest.raises(mk.UsageError, match="pad has mass"):
        mk.loads(text).analyze(["A.effort"])
    held = mk.loads(text + "idle: hold\n").analyze(["A.effort", "pad.holding_force"])
    assert any(d.code == "held-spin" for d in held.diagnostics)
    assert np.isfinite(held["pad.holding_force"]).all()
    assert np.abs(held["pad.holding_force"]).max() > 1.0


@pytest.mark.parametrize(
    ("text", "name", "other"),
    [
        (TILTED.replace("-0.6, 0, -0.7", "q, 0, -0.7"), "C.x", "-0.5"),
        (CONCENTRIC.replace("point: [1, 0.5", "point: [q, 0.5"), "P.s", "1.1"),
        (CONCENTRIC.replace("point: [0.4, 0.1, 0.2]", "point: [0.4, 0.1, q]"), "C.s", "0.25"),
    ],
)
def test_other_parameters_go_with_what_is_held(text: str, name: str, other: str) -> None:
    first = {"C.x": "-0.6", "P.s": "1", "C.s": "0.2"}[name]
    text = text.replace("MASS", "").replace("ONE", "a, pad").replace("TWO", "b, pad")
    text = text.replace("OFF", "[0.4, 0.1, q]" if name == "C.s" else "[0.4, 0.1, 0.2]")
    given = "format: 1\nparameters: {q: VALUE m}\n"
    one = text.replace("format: 1\n", given.replace("VALUE", first))
    two = text.replace("format: 1\n", given.replace("VALUE", other))
    varied = mk.loads(one).with_parameters({"q": f"{other} m"}).analyze([name])
    fresh = mk.loads(two).analyze([name])
    assert varied["row.status"].tolist() == fresh["row.status"].tolist()
    assert np.abs(varied[name] - fresh[name]).max() < 1e-11
    assert np.abs(fresh[name] - mk.loads(one).analyze([name])[name]).max() > 1e-3


TELESCOPE = """
format: 1
links: {L1: {}, L2: {}, L3: {}}
joints:
  A: {type: R, links: [ground, L1], point: [0, 0, 0], axis: [0, 0, 1]}
  S1: {type: S, links: [L1, L2], point: [1, 0, 0]}
  T: {type: P, links: [L2, L3], point: [1.5, 0.4, 0.2], axis: AXIS}
  S2: {type: S, links: [L3, ground], point: [2, 1, 0.7]}
motion: {inputs: {A.theta: {from: 0, to: 40, step: 10, rate: 1}}}
"""
LOADED = "loads: [{type: force, joint: T, value: 5}]\n"
SPRUNG = "loads: [{type: spring, joint: T, coordinate: s, stiffness: 5, free: 0.1}]\n"


@pytest.mark.parametrize(
    ("axis", "end", "told"),
    [
        ("[0.3, 1, 0.5]", LOADED, True),
        ("[0.3, 1, 0.5]", SPRUNG, True),
        ("[0.3, 1, 0.5]", "", False),
        ("[1, 1, 0.7]", LOADED, False),
    ],
)
def test_what_a_slide_bears_beside_a_load_turns_with_an_idle_leg(
    axis: str, end: str, told: bool
) -> None:
    """The load acts along the axis; both spheres bear along their line, so the rest turns with the
    axis about that line unless they are parallel."""
    text = TELESCOPE.replace("AXIS", axis) + end
    analysis = mk.loads(text).analyze(["T.force", "A.effort"])
    notes = [d.message for d in analysis.diagnostics if d.code == "conventional"]
    assert any("T.force" in words.rpartition(": ")[2] for words in notes) == told
