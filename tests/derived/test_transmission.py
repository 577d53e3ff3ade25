"""Mechanical advantage and transmission angle against closed forms and statics."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from mechanisms.runs import closings, edited, model, run
from oracle.numerics import mpmath_context as mp
from references import FILE_OF, exact

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError

FOUR_BAR = """
format: 1
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{{pin}, links: [crank, coupler], point: [2, 0, 0]}}
  C: {{type: S, links: [coupler, rocker], point: [5.125, {height}, 0]}}
  D: {{type: R, links: [ground, rocker], point: [6, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{from: 0, to: 350, step: 10}}}}}}
"""
"""Crank 2, coupler 5, rocker 4, ground 6; drawn with the crank along the ground."""
HEIGHT = (25 - 3.125**2) ** 0.5
SLIDER = """
format: 1
links: {crank: {}, rod: {}, slider: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [crank, rod], point: [2, 0, 0]}
  C: {type: S, links: [rod, slider], point: [7, 0, 0]}
  D: {type: P, links: [ground, slider], point: [7, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 30}}}
"""


def cosine(analysis):
    return np.array([float(mp.cos(mp.radians(float(d)))) for d in analysis["A.theta"]])


def sine(analysis):
    return np.array([float(mp.sin(mp.radians(float(d)))) for d in analysis["A.theta"]])


def column(a):
    return np.asarray(a, float)


def angle_of(force, velocity):
    """asin(|F.v|/(|F||v|)) in degrees, row by row at 40 digits."""
    found = []
    for f, v in zip(force, velocity, strict=True):
        f, v = ([mp.mpf(float(x)) for x in each] for each in (f, v))
        ratio = mp.fdot(f, v) / mp.sqrt(mp.fdot(f, f) * mp.fdot(v, v))
        found.append(float(mp.degrees(mp.asin(abs(ratio)))))
    return np.array(found)


@pytest.fixture(scope="module")
def four_bar():
    text = FOUR_BAR.format(pin="type: S", height=HEIGHT)
    return mk.loads(text).analyze(
        ["D.theta.transmission_angle", "D.theta.mechanical_advantage"], tables=[]
    )


def test_plane_four_bar_by_the_law_of_cosines(four_bar):
    """The angle between coupler and rocker in the triangle over the diagonal from B to D."""
    square = 4 + 36 - 24 * cosine(four_bar)
    ratio = np.abs((25 + 16 - square) / 40)
    expected = [float(mp.degrees(mp.acos(x))) for x in ratio]
    assert np.max(np.abs(four_bar["D.theta.transmission_angle"] - expected)) <= 2e-12


def test_in_a_response_what_rubs_does_not_change_it():
    """The static force of the drive alone, by the law of cosines where the crank is then."""
    text = f"""
format: 1
plane: xy
links: {{crank: {{mass: 1, center_of_mass: [1, 0], inertia: 1}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, coupler], point: [2, 0]}}
  C: {{type: R, links: [coupler, rocker], point: [5.125, {HEIGHT}]}}
  D: {{type: R, links: [ground, rocker], point: [6, 0]}}
loads:
  - {{type: torque, joint: A, value: 9}}
  - {{type: friction, joint: D, coefficient: 0.2, radius: 0.1}}
responses: {{r: {{start: {{A.theta: 20, A.theta_dot: 1}}, time: {{from: 0, to: 1, count: 9}}}}}}
"""
    rows = mk.loads(text).respond("r")
    assert set(rows["row.status"]) == {"ok"}
    ratio = np.abs((25 + 16 - (4 + 36 - 24 * cosine(rows))) / 40)
    expected = [float(mp.degrees(mp.acos(x))) for x in ratio]
    assert np.max(np.abs(rows["D.theta.transmission_angle"] - expected)) <= 2e-12


def rocker_angle(theta):
    """Of the rocker against the ground, from the triangles over the diagonal from B to D."""
    x, y = 6 - 2 * mp.cos(theta), -2 * mp.sin(theta)
    diagonal = mp.sqrt(x * x + y * y)
    return mp.pi + mp.atan2(y, x) - mp.acos((diagonal**2 + 16 - 25) / (8 * diagonal))


def test_plane_four_bar_by_differentiation(four_bar):
    slopes = [mp.diff(rocker_angle, mp.radians(int(d))) for d in four_bar["A.theta"]]
    found = four_bar["D.theta.mechanical_advantage"]
    assert np.max(np.abs(found * column(slopes) - 1)) <= 1e-12


def test_slider_crank():
    """s = 2 cos + sqrt(25 - 4 sin^2), and the rod's inclination to the slide."""
    names = ["D.s.mechanical_advantage", "D.s.transmission_angle"]
    found = mk.loads(SLIDER).analyze(names, tables=[])
    c, s = cosine(found), sine(found)
    rate = -2 * s - 4 * s * c / np.sqrt(25 - 4 * s * s)
    dead = np.isin(found["A.theta"], [0, 180, 360])
    advantage = found["D.s.mechanical_advantage"]
    assert np.array_equal(np.isnan(advantage), dead)
    assert np.max(np.abs(advantage[~dead] * rate[~dead] - 1)) <= 1e-13
    label = found.result.units.label(found.result.quantity(names[0]).dimension)
    assert label == "rad/m"
    inclination = [float(mp.degrees(mp.asin(abs(x) * 2 / 5))) for x in s]
    expected = 90 - np.array(inclination)
    assert np.max(np.abs(found["D.s.transmission_angle"] - expected)) <= 1e-12


@pytest.mark.parametrize(
    ("name", "rate"), [("O4.theta", "omega4"), ("O2.theta", "omega2"), ("O2.s", "s2_dot")]
)
def test_rcsr_against_exact_rates(name, rate):
    """The file's rate of the input is 0.1 rad/s."""
    expected = 0.1 / column(exact("rcsr")[rate])
    found = run("rcsr")[f"{name}.mechanical_advantage"]
    assert np.max(np.abs(found / expected - 1)) <= 1e-12


def test_rates_of_the_file_do_not_matter():
    motion = {"inputs": {"O1.theta": {"from": 150, "to": 202, "step": 2}}}
    found = edited("rcsr", ["O4.theta.mechanical_advantage"], motion=motion)
    wanted = run("rcsr")["O4.theta.mechanical_advantage"]
    assert found["O4.theta.mechanical_advantage"].tobytes() == wanted.tobytes()


def test_a_load_is_balanced_by_its_part_of_effort():
    links = {name: {} for name in ("crank", "coupler", "rocker")}
    load = [{"type": "torque", "joint": "O4", "value": "3"}]
    names = ["O1.effort", "O4.theta.mechanical_advantage"]
    found = edited("rcsr", names, links=links, loads=load)
    balanced = found["O1.effort"] * found["O4.theta.mechanical_advantage"]
    assert balanced == pytest.approx(-3, rel=1e-11)


@pytest.mark.parametrize(
    ("leading", "values"), [("A", ([6, 10], [5, 9])), ("B", ([10, 10], [5, 9]))]
)
def test_of_several_inputs_the_first_that_moves_leads(leading, values):
    """Against differences in it, the other held."""
    step = 1e-3

    def five_bar(shift, quantity):
        moved = {"A": values[0], "B": values[1]}
        moved[leading] = [value + shift for value in moved[leading]]
        inputs = ", ".join(f"{name}.theta: {{values: {moved[name]}, rate: 7}}" for name in "AB")
        analysis = mk.loads(FIVE_BAR.format(inputs=inputs)).analyze([quantity], tables=[])
        return analysis[quantity]

    slope = (five_bar(step, "D.theta") - five_bar(-step, "D.theta")) / (2 * step)
    found = five_bar(0.0, "D.theta.mechanical_advantage")
    assert found * slope == pytest.approx([1, 1], abs=1e-7)


FIVE_BAR = """
format: 1
links: {{a: {{}}, b: {{}}, c: {{}}, d: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [a, b], point: [1, 2, 0], axis: [0, 0, 1]}}
  C: {{type: S, links: [b, c], point: [3, 3, 0]}}
  E: {{type: S, links: [c, d], point: [5, 4, 1]}}
  D: {{type: R, links: [ground, d], point: [6, 0, 0], axis: [0, 1, 2]}}
motion: {{inputs: {{{inputs}}}}}
"""


def test_rssr_transmits_along_its_coupler():
    found = run("rssr")
    along = found["O3.point"] - found["O2.point"]
    velocity = np.cross(found["O4.axis"], found["O3.point"] - found["O4.point"])
    expected = angle_of(along, velocity)
    assert np.max(np.abs(found["O4.theta.transmission_angle"] - expected)) <= 1e-11


def test_rcsr_transmits_square_to_the_cylinder():
    """A cylindric joint gives no force along its axis and no moment about it, so the force at the
    sphere runs to the axis at right angles."""
    found = run("rcsr")
    axis, arm = found["O2.axis"], found["O3.point"] - found["O2.point"]
    force = arm - np.sum(axis * arm, axis=1)[:, None] * axis
    velocity = np.cross(found["O4.axis"], found["O3.point"] - found["O4.point"])
    expected = angle_of(force, velocity)
    assert np.max(np.abs(found["O4.theta.transmission_angle"] - expected)) <= 1e-10


def test_a_sphere_on_a_plane_pushes_along_the_normal():
    found = run("rspr")
    velocity = np.cross(found["B.axis"], found["S.point"] - found["B.point"])
    expected = angle_of(found["S.axis"], velocity)
    assert np.max(np.abs(found["B.theta.transmission_angle"] - expected)) <= 1e-10


def test_each_coordinate_of_a_cylindric_joint_has_its_own_angle():
    """A load on one coordinate alone: no force along the axis for theta, no moment about it for
    s; never a force along the groove."""
    found = run("rsgc")
    groove, axis = found["S.axis"], found["B.axis"]
    around = np.cross(axis, found["S.point"] - found["B.point"])
    turning = angle_of(np.cross(groove, axis), around)
    sliding = angle_of(np.cross(groove, around), axis)
    assert np.max(np.abs(found["B.theta.transmission_angle"] - turning)) <= 1e-10
    assert np.max(np.abs(found["B.s.transmission_angle"] - sliding)) <= 1e-10


def test_a_force_that_is_not_unique_leaves_the_cells_empty():
    """With a pin for the first sphere the plane's normal carries any force between the pins."""
    text = FOUR_BAR.format(pin="type: R, axis: [0, 0, 1]", height=HEIGHT)
    found = mk.loads(text).analyze(["D.theta.transmission_angle"], tables=[])
    assert not found.result.status.any()
    assert np.isnan(found["D.theta.transmission_angle"]).all()
    assert [note.code for note in found.diagnostics] == ["not-unique"]


@pytest.mark.parametrize("name", ["rcsr", "rsgc", "rspr"])
def test_the_closing_joint_does_not_matter(name):
    ends = (".transmission_angle", ".mechanical_advantage")
    names = [quantity for quantity in model(name).quantities if quantity.endswith(ends)]
    assert names
    for cut in closings(name):
        found = model(name).analyze(names, tables=[], closed_at=cut)
        for quantity in names:
            wanted = run(name)[quantity]
            error = np.max(np.abs(found[quantity] - wanted))
            assert error <= 1e-11 * np.max(np.abs(wanted)), (cut, quantity)


def test_where_it_is_not_defined_the_message_says_so():
    with pytest.raises(UsageError, match="exactly one other joint, of type S, Sp or Sg"):
        model("hooke").analyze(["B.theta.transmission_angle"], tables=[])
    text = FILE_OF["sevenr"].read_text(encoding="utf-8")
    joint = next(iter(model("sevenr").problem.mechanism.joints))
    table = f"tables:\n  - {{name: t, columns: [{{label: m, value: {joint}.turn}}]}}\n"
    with pytest.raises(mk.InvalidFile, match="joints of type S, Sp, Sg have an orientation"):
        mk.loads(text.replace("tables:\n", table), "sevenr")


def test_nothing_is_loaded_where_nothing_is_asked_for():
    code = (
        "import sys, mechkin_cli as mk; mk.load(sys.argv[1]).analyze(); "
        "print(any(name.startswith('mechkin_cli.analysis.derived') for name in sys.modules))"
    )
    path = str(FILE_OF["rcsr"])
    done = subprocess.run(
        [sys.executable, "-P", "-c", code, path], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


MASSES = {
    "crank: {}": "crank: {mass: 3, center_of_mass: [1, 0, 0]}",
    "slider: {}": "slider: {mass: 2, center_of_mass: [7, 0, 0]}",
}
TURNING = "step: 30, rate: 9 rad/s, acceleration: 4 rad/s^2"


def moving_slider(masses):
    text = SLIDER.replace("step: 30", TURNING)
    for old, new in masses.items():
        text = text.replace(old, new)
    names = ["dynamic_transmission_angle", "transmission_angle"]
    reactions = ["C.force", "D.axis"]
    return mk.loads(text).analyze([*(f"D.s.{name}" for name in names), *reactions], tables=[])


def test_a_rod_without_mass_transmits_along_its_line():
    """The slider's inertia alone: the force is along the rod as in statics."""
    found = moving_slider(MASSES)
    still = found["D.s.transmission_angle"]
    assert np.abs(found["D.s.dynamic_transmission_angle"] - still).max() <= 1e-10


def test_the_rod_s_mass_turns_the_force():
    rod = {"rod: {}": "rod: {mass: 1, center_of_mass: [4, 0, 0], inertia: {yy: 2, zz: 2}}"}
    found = moving_slider(MASSES | rod)
    wanted = angle_of(found["C.force"], found["D.axis"])
    dynamic = found["D.s.dynamic_transmission_angle"]
    assert np.abs(dynamic - wanted).max() <= 1e-10
    assert np.abs(dynamic - found["D.s.transmission_angle"]).max() > 1.0


def test_where_nothing_is_transmitted_there_is_no_angle():
    found = moving_slider({"crank: {}": MASSES["crank: {}"]})
    assert np.isnan(found["D.s.dynamic_transmission_angle"]).all()
    assert np.isfinite(found["D.s.transmission_angle"]).all()


# In a plane: driven at a pin, or at a pin in a slot.

PLANE = """
format: 1
plane: xy
links: {{crank: {{}}, rod: {{}}, out: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, rod], point: [2, 0]}}
  C: {{type: R, links: [rod, out], point: [{x}, {y}]}}
  D: {{{guide}, links: [{order}]}}
motion: {{inputs: {{A.theta: {{from: 0, to: 350, step: 10}}}}}}
"""
ORDERS = ["ground, out", "out, ground"]


@pytest.mark.parametrize("order", ORDERS)
def test_four_bar_of_a_plane_file_by_the_law_of_cosines(order):
    text = PLANE.format(x=5.125, y=HEIGHT, guide="type: R, point: [6, 0]", order=order)
    found = mk.loads(text).analyze(["D.theta.transmission_angle"], tables=[])
    square = 4 + 36 - 24 * cosine(found)
    expected = [float(mp.degrees(mp.acos(abs(x)))) for x in (25 + 16 - square) / 40]
    assert np.max(np.abs(found["D.theta.transmission_angle"] - expected)) <= 2e-12


@pytest.mark.parametrize("order", ORDERS)
def test_slider_of_a_plane_file(order):
    """The rod of 5 against the slide along x: sin of its inclination is 2 sin(theta)/5."""
    text = PLANE.format(x=7, y=0, guide="type: P, point: [7, 0], axis: [1, 0]", order=order)
    found = mk.loads(text).analyze(["D.s.transmission_angle"], tables=[])
    expected = [90 - float(mp.degrees(mp.asin(abs(x) * 2 / 5))) for x in sine(found)]
    assert np.max(np.abs(found["D.s.transmission_angle"] - expected)) <= 1e-12


SLOT = """
format: 1
plane: xy
links: {crank: {}, arm: {MASS}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  K: {type: Ps, links: [crank, arm], point: [2, 1], slot: [1, 0]}
  D: {type: R, links: [ground, arm], point: [-4, 0]}
motion: {inputs: {A.theta: {from: 0, to: 350, step: 10, rate: 3 rad/s}}}
"""


@pytest.mark.parametrize(
    ("mass", "kind"),
    [("", "transmission_angle"), ("mass: 2, inertia: 3", "dynamic_transmission_angle")],
)
def test_a_pin_pushes_square_to_its_slot(mass, kind):
    """The slot passes the arm's pivot at 1, the pin stands at d from it: sin = sqrt(1 - 1/d^2)."""
    name = f"D.theta.{kind}"
    centre = ", center_of_mass: [0, 1]" if mass else ""
    found = mk.loads(SLOT.replace("MASS", mass + centre)).analyze([name, "A.theta"], tables=[])
    start = mp.atan2(1, 2)
    expected = []
    for theta in found["A.theta"]:
        turn = start + mp.radians(float(theta))
        square = (mp.sqrt(5) * mp.cos(turn) + 4) ** 2 + 5 * mp.sin(turn) ** 2
        expected.append(float(mp.degrees(mp.acos(1 / mp.sqrt(square)))))
    assert np.max(np.abs(found[name] - expected)) <= 1e-11


@pytest.mark.parametrize("name", ["A.theta", "B.theta", "C.theta"])
def test_other_coordinates_of_a_plane_have_none(name):
    text = PLANE.format(x=5.125, y=HEIGHT, guide="type: R, point: [6, 0]", order=ORDERS[0])
    with pytest.raises(UsageError, match="in a plane R or Ps, and no input"):
        mk.loads(text).analyze([f"{name}.transmission_angle"], tables=[])


def test_a_pin_that_is_driven_transmits_a_moment_too():
    text = PLANE.format(x=5.125, y=HEIGHT, guide="type: R, point: [6, 0]", order=ORDERS[0])
    text = text.replace("A.theta:", "C.theta:").replace("to: 350", "to: 30")
    with pytest.raises(UsageError, match="in a plane R or Ps, and no input"):
        mk.loads(text).analyze(["D.theta.transmission_angle"], tables=[])
