"""Every template runs without a warning and has the answers of closed forms or known values."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from mpmath import mp

import mechkin_cli as mk
from mechkin_cli.__main__ import main
from mechkin_cli.templates import USUAL, purpose, template_names, template_text

ROOT = Path(__file__).parents[2]
TURNS = np.radians(np.arange(0.0, 361.0, 5.0))


def rows_of(name: str) -> Any:
    return mk.loads(template_text(name)).analyze()


def off(found: Any, expected: Any) -> float:
    return float(np.abs(np.asarray(found) - np.asarray(expected)).max())


@pytest.mark.parametrize("name", template_names())
def test_a_template_runs_without_a_warning(name: str) -> None:
    model = mk.loads(template_text(name))
    runs = [model.respond(run) if run != "sweep" else model.analyze() for run in model.runs]
    for rows in runs:
        assert set(rows["row.status"]) == {"ok"}
        assert {d.severity for d in rows.diagnostics} <= {"note"}
        assert rows.tables
    text = template_text(name)
    assert text.startswith("# ")
    assert 20 < len(purpose(text)) < 100
    assert max(map(len, text.splitlines())) <= 110


PLANAR = {
    "four-bar",
    "slider-crank",
    "inverted-slider",
    "cylinder-arm",
    "pendulum",
    "gearbox",
    "planetary",
    "belt",
    "cam",
    "excavator",
}
IN_A_PLANE = {"R", "P", "W", "Ps"}


def test_mechanisms_of_a_plane_are_drawn_in_one() -> None:
    """No ball or cylinder stands in for a pin, and no third coordinate is written."""
    for name in template_names():
        file = yaml.safe_load(template_text(name))
        types = {joint["type"] for joint in file["joints"].values()}
        assert (file.get("plane") == "xy") == (name in PLANAR), name
        if name in PLANAR:
            assert types <= IN_A_PLANE, name
            assert all(len(joint["point"]) == 2 for joint in file["joints"].values()), name


def motor_torque(energy: Any, work: Any, theta: float) -> float:
    """The torque at a crank of constant rate: the slope of the energy less that of the loads' work.

    Args:
        energy: kinetic and potential energy of a place of the crank in rad, at 40 digits.
        work: done by the other loads up to a place.
        theta: in degrees.
    """
    with mp.workdps(40):
        return float(mp.diff(lambda t: energy(t) - work(t), mp.radians(mp.mpf(theta))))


def moving(parts: Any, rate: int) -> Any:
    """Energy of bodies in N*mm, of (mass, inertia, place by crank angle: x, y, turn) each."""

    def energy(theta: Any) -> Any:
        total = mp.mpf(0)
        for mass, inertia, place in parts:
            x, y, turn = (
                rate * mp.diff(lambda t, k=k, at=place: at(t)[k], theta) for k in range(3)
            )
            kinetic = (mp.mpf(mass) * (x * x + y * y) + inertia * turn * turn) / 2
            total += (kinetic + mp.mpf(mass) * mp.mpf("9806.65") * place(theta)[1]) / 1000
        return total

    return energy


def test_the_four_bar_is_freudensteins() -> None:
    rows, (a, b, c, d) = rows_of("four-bar"), (40.0, 120.0, 80.0, 100.0)
    t = TURNS
    x, y = a * np.cos(t), a * np.sin(t)
    reach = np.hypot(d - x, y)
    rocker = np.arctan2(y, x - d) - np.arccos((c**2 + reach**2 - b**2) / (2 * c * reach))
    start = rocker[0]
    assert off(np.radians(rows["D.theta"]), np.unwrap(rocker) - start) < 1e-12
    transmitted = np.arccos((b**2 + c**2 - reach**2) / (2 * b * c))
    assert off(rows["transmission"], np.degrees(transmitted)) < 1e-9


def test_the_four_bars_motor() -> None:
    rows, (a, b, c, d) = rows_of("four-bar"), map(mp.mpf, (40, 120, 80, 100))

    def angles(t: Any) -> Any:
        """Of coupler and rocker from x."""
        x, y = a * mp.cos(t), a * mp.sin(t)
        reach = mp.hypot(d - x, y)
        phi = mp.atan2(y, x - d) - mp.acos((c**2 + reach**2 - b**2) / (2 * c * reach))
        return mp.atan2(c * mp.sin(phi) - y, d + c * mp.cos(phi) - x), phi

    def rod(t: Any) -> Any:
        turn = angles(t)[0]
        return a * mp.cos(t) + b / 2 * mp.cos(turn), a * mp.sin(t) + b / 2 * mp.sin(turn), turn

    def rocker(t: Any) -> Any:
        turn = angles(t)[1]
        return d + c / 2 * mp.cos(turn), c / 2 * mp.sin(turn), turn

    def crank(t: Any) -> Any:
        return a / 2 * mp.cos(t), a / 2 * mp.sin(t), t

    parts = [("0.3", 70, crank), ("0.6", 700, rod), ("0.4", 240, rocker)]
    energy = moving(parts, 10)
    for k in (3, 20, 41, 66):
        against = -500 * int(np.sign(rows["D.theta_dot"][k]))
        found = motor_torque(energy, lambda t, f=against: f * angles(t)[1], rows["A.theta"][k])
        assert rows["A.effort"][k] == pytest.approx(found, rel=1e-10)


def test_the_slider_cranks_slider() -> None:
    rows, r, rod = rows_of("slider-crank"), 40.0, 120.0
    t = TURNS
    s = r * np.cos(t) + np.sqrt(rod**2 - (r * np.sin(t)) ** 2) - r - rod
    assert off(rows["S.s"], s) < 1e-11
    # pushed back over the first half turn, without what dead centres leave to rounding
    back = (rows["O.theta"] > 0.0) & (rows["O.theta"] < 180.0)
    assert rows["pressure"].tolist() == np.where(back, 25.0, 5.0).tolist()


def test_the_slider_cranks_motor() -> None:
    rows, r, rod = rows_of("slider-crank"), mp.mpf(40), mp.mpf(120)

    def reach(t: Any) -> Any:
        return r * mp.cos(t) + mp.sqrt(rod * rod - (r * mp.sin(t)) ** 2)

    parts = [
        ("0.4", 90, lambda t: (r / 2 * mp.cos(t), r / 2 * mp.sin(t), t)),
        (
            "0.6",
            720,
            lambda t: (
                (r * mp.cos(t) + reach(t)) / 2,
                r / 2 * mp.sin(t),
                -mp.asin(r / rod * mp.sin(t)),
            ),
        ),
        ("1.1", 0, lambda t: (reach(t), mp.mpf(0), mp.mpf(0))),
    ]
    energy = moving(parts, 20)
    for k in (1, 17, 40, 70):
        pressure = int(rows["pressure"][k])
        found = motor_torque(energy, lambda t, f=pressure: f * reach(t), rows["O.theta"][k])
        assert rows["O.effort"][k] == pytest.approx(found, rel=1e-10)


def test_the_inverted_sliders_swing() -> None:
    rows = rows_of("inverted-slider")
    t = np.radians(rows["O.theta"])
    x, y = 80.0 + 30.0 * np.cos(t), 30.0 * np.sin(t)
    assert off(np.radians(rows["C.theta"]), np.arctan2(y, x)) < 1e-13
    assert off(np.abs(rows["S.s"]), np.abs(np.hypot(x, y) - 110.0)) < 1e-11


def test_the_rssrs_rod_keeps_its_length_on_the_branch_of_the_drawing() -> None:
    """The rocker's angle from A cos + B sin = C at 40 digits."""
    rows = rows_of("rssr")
    with mp.workdps(40):
        tilt = mp.radians(15)
        axis = mp.matrix([mp.sin(tilt), 0, mp.cos(tilt)])
        pivot = mp.matrix([160, 0, 60])
        arm = mp.matrix([140, 100, 60]) - pivot
        along = (axis.T * arm)[0] * axis
        radial = arm - along
        across = mp.matrix(
            [
                axis[1] * arm[2] - axis[2] * arm[1],
                axis[2] * arm[0] - axis[0] * arm[2],
                axis[0] * arm[1] - axis[1] * arm[0],
            ]
        )
        length = mp.mpf(100) ** 2 + mp.mpf(100) ** 2 + mp.mpf(60) ** 2
        for theta, found in zip(rows["O1.theta"], rows["O4.theta"], strict=True):
            t = mp.radians(mp.mpf(float(theta)))
            crank = mp.matrix([40 * mp.cos(t), 40 * mp.sin(t), 0])
            fixed = pivot + along - crank
            a, b = 2 * (fixed.T * radial)[0], 2 * (fixed.T * across)[0]
            rest = length - (fixed.T * fixed)[0] - (radial.T * radial)[0]
            middle, spread = mp.atan2(b, a), mp.acos(rest / mp.hypot(a, b))
            roots = [mp.degrees(middle + spread), mp.degrees(middle - spread)]
            near = [abs(mp.mpf(float(found)) - root) for root in roots]
            assert min(near) < mp.mpf("1e-11")
    assert rows["O4.theta"][0] == pytest.approx(0.0, abs=1e-12)


def test_the_rcsr_is_that_of_the_dissertation() -> None:
    known = mk.load(ROOT / "mechanisms" / "dissertation" / "rcsr.yaml").analyze()
    rows = rows_of("rcsr")
    shared = [
        (i, int(np.flatnonzero(known["O1.theta"] == t)[0]))
        for i, t in enumerate(rows["O1.theta"])
        if t in known["O1.theta"]
    ]
    assert len(shared) > 3
    for name in ("O4.theta", "O2.s"):
        for i, k in shared:
            assert rows[name][i] == pytest.approx(known[name][k], rel=1e-11)


def test_the_cylinder_arms_triangle_and_moments() -> None:
    rows = rows_of("cylinder-arm")
    foot, grip = np.hypot(800.0, 300.0), 1000.0
    length = np.hypot(200.0, 300.0) + rows["cylinder.s"]
    at_bearing = np.arccos((foot**2 + grip**2 - length**2) / (2 * foot * grip))
    boom = at_bearing - np.arctan2(300.0, 800.0)
    assert off(np.radians(rows["O.theta"]), boom) < 1e-12
    lever = foot * grip * np.sin(at_bearing) / length
    weight = 150.0 * 9.80665 * 1250.0 + 400.0 * 9.80665 * 2500.0
    assert off(rows["cylinder.effort"] / (weight * np.cos(boom) / lever), 1.0) < 1e-12


def test_the_deltas_tool_is_where_three_spheres_meet() -> None:
    rows = rows_of("delta")
    # each parallelogram holds a point of the tool at one distance from its elbow, drawn inwards
    long = np.hypot(120.0 + 100.0 - 40.0, 220.0)
    centres = []
    for number, turn in enumerate(np.radians([0.0, 120.0, 240.0])):
        arm = np.radians(rows[f"M{number + 1}.theta"])
        out = 120.0 + 100.0 * np.cos(arm) - 40.0
        centres.append([out * np.cos(turn), out * np.sin(turn), -100.0 * np.sin(arm)])
    first, second, third = (np.array(one).T for one in centres)
    # the lower of the two points that three spheres of one radius share (trilateration)
    x = (second - first) / np.linalg.norm(second - first, axis=1)[:, None]
    along = np.sum(x * (third - first), axis=1)
    across = third - first - along[:, None] * x
    y = across / np.linalg.norm(across, axis=1)[:, None]
    z = np.cross(x, y)
    d, j = np.linalg.norm(second - first, axis=1), np.linalg.norm(across, axis=1)
    u = d / 2.0
    v = (along**2 + j**2 - 2.0 * along * u) / (2.0 * j)
    w = np.sqrt(long**2 - u**2 - v**2)
    place = first + u[:, None] * x + v[:, None] * y - w[:, None] * z
    tip = np.stack([rows[f"tip.position.{axis}"] for axis in "xyz"], axis=-1)
    assert off(tip, place) < 1e-9
    # massless arms and rods: the motors' power lifts and speeds up the tool alone
    rates = (1.0, 0.75, 0.5)
    power = sum(rows[f"M{k + 1}.effort"] * rate for k, rate in enumerate(rates))
    velocity, acceleration = rows["tip.velocity"], rows["tip.acceleration"]
    thrust = 0.4 * (acceleration + np.array([0.0, 0.0, 9806.65])) / 1000.0
    assert off(power, np.sum(thrust * velocity, axis=1)) < 1e-8


def test_the_suspensions_links_keep_their_lengths_and_its_roll_centre() -> None:
    rows = rows_of("suspension")
    for one, other in (("rod_inner", "rod_outer"), ("lower_ball", "upper_ball")):
        lengths = np.linalg.norm(rows[f"{one}.point"] - rows[f"{other}.point"], axis=1)
        assert np.ptp(lengths) < 1e-11
    # the tangent of the contact point's path, from a spline through finely spaced rows
    fine = mk.loads(template_text("suspension").replace("step: 1}", "step: 0.05}")).analyze()
    y, z = fine["contact.position.y"], fine["contact.position.z"]
    roll = z + y * np.gradient(y) / np.gradient(z)
    assert off(fine["roll_centre"][1:-1], roll[1:-1]) < 0.05
    assert rows["camber"][12] == pytest.approx(0.0, abs=1e-12)


def test_the_platforms_legs_reach_from_foot_to_head() -> None:
    rows = rows_of("platform")
    feet, heads = (-12, 12, 108, 132, 228, 252), (-50, 50, 70, 170, 190, 290)
    for k, (foot, head) in enumerate(zip(np.radians(feet), np.radians(heads), strict=True), 1):
        home = np.linalg.norm(
            [0.6 * np.cos(head) - np.cos(foot), 0.6 * np.sin(head) - np.sin(foot), 1.0]
        )
        legs = np.linalg.norm(rows[f"B{k}.point"] - rows[f"A{k}.point"], axis=1)
        assert off(legs, home + rows[f"L{k}.s"]) < 1e-13
    weights = 60.0 * 9.81
    pushed = sum(
        rows[f"L{k}.effort"]
        * (rows[f"B{k}.point"] - rows[f"A{k}.point"])[:, 2]
        / np.linalg.norm(rows[f"B{k}.point"] - rows[f"A{k}.point"], axis=1)
        for k in range(1, 7)
    )
    assert off(pushed / weights, 1.0) < 0.1


def test_the_pendulum_is_jacobis() -> None:
    rows = mk.loads(template_text("pendulum")).respond("swing")
    with mp.workdps(30):
        k, rate = mp.sin(mp.radians(30)), mp.sqrt(mp.mpf("9.80665"))
        quarter = mp.ellipk(k * k)
        angles = [
            float(
                mp.degrees(2 * mp.asin(k * mp.ellipfun("sn", quarter - rate * mp.mpf(t), m=k * k)))
            )
            for t in map(float, rows["time"])
        ]
    assert off(rows["A.theta"], angles) < 1e-7


def test_the_gearbox_in_steady_running() -> None:
    """Of 30 N m at the output a third arrives at the middle shaft, a ninth at the motor; a force of
    teeth is the moment over the radius and the cosine of the pressure angle."""
    rows = rows_of("gearbox")
    assert off(rows["C.theta"], rows["A.theta"] / 9.0) < 1e-10
    assert off(rows["A.effort"], 30000.0 / 9.0) < 1e-9
    slant = np.cos(np.radians(20.0))
    at_middle, at_output = 10000.0 / 54.0 / slant, 30000.0 / 75.0 / slant
    for name, force in {
        "norm(G12.tooth_force)": at_middle,
        "norm(G34.tooth_force)": at_output,
        "norm(A.force)": at_middle,
        "norm(C.force)": at_output,
    }.items():
        assert off(rows[name], force) < 1e-9, name
    # on the middle shaft both act downwards along y by their tangential parts, and push it apart
    across = (at_output - at_middle) * np.sin(np.radians(20.0))
    along = (at_output + at_middle) * slant
    assert off(rows["norm(B.force)"], np.hypot(across, along)) < 1e-9


def test_the_gearbox_runs_up_by_one_inertia() -> None:
    """J omega' = 8 N m (1 - omega/300) - 30 N m/9, with all inertias at the motor."""
    rows = mk.loads(template_text("gearbox")).respond("run_up")
    inertia = (900.0 + 1800.0 / 9.0 + 40000.0 / 81.0) * 1e-6
    final = 300.0 * (1.0 - 30.0 / 9.0 / 8.0)
    omega = final * (1.0 - np.exp(-rows["time"] * 8.0 / 300.0 / inertia))
    assert off(rows["A.theta_dot"], omega) < 1e-6
    assert off(rows["C.theta_dot"], omega / 9.0) < 1e-6


def test_the_planetary_gear_is_williss() -> None:
    """In a fixed ring the carrier turns 18/(18 + 42) of the sun's turn, the planet -18/24."""
    rows = rows_of("planetary")
    assert off(rows["C.theta"], 0.3 * rows["S.theta"]) < 1e-10
    assert off(rows["ratio"], 0.3) < 1e-14
    assert off(rows["planet.omega"], -0.75 * 100.0) < 1e-11
    assert off(rows["S.effort"], 0.3 * 12000.0) < 1e-9
    # teeth of sun and ring push the planet with the same tangential force; its bearing carries
    # the sum, and the planet's weight in its circle
    tangential = 0.3 * 12000.0 / 22.5
    for name in ("inner", "outer"):
        found = rows[f"norm({name}.tooth_force)"]
        assert off(found, tangential / np.cos(np.radians(20.0))) < 1e-9
    centrifugal = 0.14 * 30.0**2 * 37.5e-3
    assert off(rows["norm(P.force)"], np.hypot(2.0 * tangential, centrifugal)) < 1e-9


def test_the_belts_strands() -> None:
    """2 mN m of the fan's rate in rad/s squared, a factor 40/100 less at the motor; the strands
    differ by that over 40 mm, about their pretension."""
    rows = rows_of("belt")
    torque = 0.4 * 2.0 * (0.4 * 150.0) ** 2
    assert off(rows["B.theta"], 0.4 * rows["A.theta"]) < 1e-9
    assert off(rows["A.effort"], torque) < 1e-9
    assert off(rows["K.tight"], 120.0 + 0.5 * torque / 40.0) < 1e-10
    assert off(rows["K.slack"], 120.0 - 0.5 * torque / 40.0) < 1e-10
    sine = 60.0 / 350.0
    pull = np.hypot(240.0 * np.sqrt(1.0 - sine * sine), torque / 40.0 * sine)
    assert off(rows["norm(A.force)"], pull) < 1e-10


def test_the_fan_starts_by_a_hyperbolic_tangent() -> None:
    """J omega' = T - c omega^2 at the motor: omega = w tanh(t T/(J w)), w^2 = T/c."""
    rows = mk.loads(template_text("belt")).respond("start")
    inertia, torque, drag = 2.5e-3 + 0.16 * 90e-3, 4.0, 0.4**3 * 2e-3
    final = np.sqrt(torque / drag)
    omega = final * np.tanh(rows["time"] * torque / (inertia * final))
    assert off(rows["A.theta_dot"], omega) < 1e-6
    assert rows["K.slack"].min() > 0.0


def test_the_cams_follower() -> None:
    """A cycloid of 12 mm in 90 deg, and back; 0.25 kg, its weight and 200 N/m, pressed by 60 mm."""
    rows = rows_of("cam")
    theta = np.radians(rows["A.theta"])
    x = theta / (np.pi / 2.0)
    done = np.where(x < 1.0, x, np.where(x < 2.0, 2.0 - x, 0.0))
    way = np.where(x < 1.0, 1.0, np.where(x < 2.0, -1.0, 0.0))
    s = 12.0 * (done - np.sin(2.0 * np.pi * done) / (2.0 * np.pi))
    slope = way * 12.0 / (np.pi / 2.0) * (1.0 - np.cos(2.0 * np.pi * done))
    bend = 12.0 / (np.pi / 2.0) ** 2 * 2.0 * np.pi * np.sin(2.0 * np.pi * done)
    assert off(rows["S.s"], s) < 1e-12
    assert off(rows["S.s_dot"], 30.0 * slope) < 1e-9
    assert off(rows["S.s_ddot"], 900.0 * np.abs(way) * bend) < 1e-8
    contact = 0.25 * (0.9 * np.abs(way) * bend + 9.81) + 0.2 * (s + 60.0)
    assert off(rows["lobe.force"], contact) < 1e-10
    assert off(rows["A.effort"], contact * slope) < 1e-9
    assert rows["lobe.force"].min() > 0.0


EXCAVATOR = (
    # pivot, eyes of its cylinder before and behind it, mass centres and masses that it carries
    ((0.0, 0.0), (0.6, -0.6), (2.0, 1.6), "lift"),
    ((4.0, 2.0), (1.8, 2.0), (3.7, 2.7), "crowd"),
    ((4.5, -0.5), (4.3, 1.6), (4.95, -0.35), "curl"),
)
WEIGHTS = ((900.0, 1.9, 1.3), (450.0, 4.1, 1.1), (700.0, 4.9, -0.9))


def test_the_excavators_joints_and_cylinders() -> None:
    """Angles by the law of cosines; a cylinder's force by the moment of all weights beyond the
    pivot that it spans."""
    rows = rows_of("excavator")
    to = [complex(*at) for at, *_ in EXCAVATOR]
    turns = []
    for (pivot, foot, eye, name), joint in zip(EXCAVATOR, "ABC", strict=True):
        a, b = complex(*foot) - complex(*pivot), complex(*eye) - complex(*pivot)
        cosine = (abs(a) ** 2 + abs(b) ** 2 - rows[f"{name}.s"] ** 2) / (2.0 * abs(a) * abs(b))
        home = np.angle(b / a)
        turn = np.sign(home) * np.arccos(cosine) - home
        assert off(np.radians(rows[f"{joint}.theta"]), turn) < 1e-12, joint
        turns.append(np.exp(1j * turn))
    # places of pivots and mass centres: each link turns with all before it
    pivots, whole, centres = [np.zeros_like(turns[0])], np.ones_like(turns[0]), []
    for k, (_, x, y) in enumerate(WEIGHTS):
        whole = whole * turns[k]
        centres.append(pivots[k] + whole * (complex(x, y) - to[k]))
        if k < 2:
            pivots.append(pivots[k] + whole * (to[k + 1] - to[k]))
    for k, (pivot, foot, eye, name) in enumerate(EXCAVATOR):
        moment = sum(
            9.80665e-3 * WEIGHTS[n][0] * (centres[n] - pivots[k]).real for n in range(k, 3)
        )
        a = complex(*foot) - complex(*pivot)
        b = (complex(*eye) - complex(*pivot)) * turns[k]
        # on the link before the pivot, from where the turned eye is seen
        lever = (np.conj(b) * (b - a)).imag / np.abs(b - a)
        assert off(rows[f"{name}.force"], moment / lever) < 1e-9, name
    area = np.pi / 4.0 * 0.125**2
    assert off(rows["lift.pressure"], rows["lift.force"] / area) < 1e-8


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["mechkin", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


def test_the_command_writes_a_file_and_never_over_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, "new", "arm") == 0
    assert (tmp_path / "arm.yaml").read_text(encoding="utf-8") == template_text(USUAL)
    (tmp_path / "arm.yaml").write_text("mine", encoding="utf-8")
    assert run(monkeypatch, "new", "arm", "--template", "rssr") == 2
    assert (tmp_path / "arm.yaml").read_text(encoding="utf-8") == "mine"
    assert "arm.yaml is there already" in capsys.readouterr().err
    assert run(monkeypatch, "new", "b", "--template", "fourbar") == 2
    assert "did you mean four-bar" in capsys.readouterr().err
    assert run(monkeypatch, "new") == 2
    assert run(monkeypatch, "new", "no/such/folder") == 2
    for name in ("", "-", ".", "..", "...yaml", "#"):
        capsys.readouterr()
        assert run(monkeypatch, "new", "--", name) == 2
        assert "is no name for a file" in capsys.readouterr().err
    assert [one.name for one in tmp_path.iterdir()] == ["arm.yaml"]


def test_the_list_has_all_templates(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "new", "--list") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == template_names()
