"""The files of `mechanisms/couplings` against closed forms: ratios, torques by power, forces of
teeth and strands, loops by circles at 40 digits, and slots, arcs and rolling wheels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk

SLANT = np.tan(np.radians(20.0))


def rows_of(name: str) -> Any:
    rows = mk.load(FILE_OF[name]).analyze()
    assert set(rows["row.status"]) == {"ok"}
    return rows


def near(found: Any, expected: Any, within: float = 1e-11) -> None:
    np.testing.assert_allclose(found, expected, rtol=within, atol=within)


def test_spur_gears() -> None:
    """2 N m at 20 mm is 100 N; pushed apart by the tangent of 20 deg; the bearings take both."""
    rows = rows_of("spur_gears")
    near(rows["B.theta"], -0.5 * rows["A.theta"])
    near(rows["A.effort"], -2000.0)
    near(rows["G.tooth_force"], np.tile([100.0 * SLANT, -100.0], (len(rows["A.theta"]), 1)))
    near(rows["norm(A.force)"], 100.0 / np.cos(np.radians(20.0)))
    near(rows["norm(B.force)"], 100.0 / np.cos(np.radians(20.0)))


def test_planetary_gear() -> None:
    """Willis: 18 S + 42 N = 60 C; torques are shared by the teeth, 18 : 42 : -60."""
    rows = rows_of("planetary_gear")
    sun, ring = rows["S.theta"], rows["N.theta"]
    carrier = (18.0 * sun + 42.0 * ring) / 60.0
    near(rows["C.theta"], carrier)
    near(carrier, 0.15 * sun)
    near(rows["P.theta"], 42.0 / 12.0 * (ring - carrier))
    near(rows["planet.omega"], 60.0 * (3.5 * (-3.0 / 14.0 - 0.15) + 0.15))
    near(rows["S.effort"], 10000.0 * 18.0 / 60.0, 1e-9)
    near(rows["N.effort"], 10000.0 * 42.0 / 60.0, 1e-9)
    # the planet's bearing pushes the carrier at 30 mm, and turns the planet in its circle
    near(rows["norm(P.force)"], np.hypot(10000.0 / 30.0, 0.1 * 9.0**2 * 30e-3), 1e-9)


def five_bar(theta: mp.mpf) -> mp.matrix:
    """The joint of the rods, above the cranks' ends."""
    b = mp.matrix([-25 * mp.sin(theta), 25 * mp.cos(theta)])
    d = mp.matrix([90 + 15 * mp.sin(2 * theta), 15 * mp.cos(2 * theta)])
    one, other = mp.sqrt(50**2 + 60**2), mp.sqrt(40**2 + 70**2)
    across = d - b
    length = mp.norm(across)
    along = (one**2 - other**2 + length**2) / (2 * length)
    height = mp.sqrt(one**2 - along**2)
    return b + (across * along + mp.matrix([-across[1], across[0]]) * height) / length


def test_geared_five_bar() -> None:
    rows = rows_of("geared_five_bar")
    near(rows["E.theta"], -2.0 * rows["A.theta"])
    with mp.workdps(40):
        for k, theta in enumerate(rows["A.theta"]):
            at = mp.radians(mp.mpf(float(theta)))
            near(rows["P.point"][k], [float(x) for x in five_bar(at)], 1e-12)


def test_the_torque_of_the_geared_five_bar() -> None:
    """The slope of the right rod's kinetic energy, less what the load at the joint does."""
    rows = rows_of("geared_five_bar")

    def middle(theta: mp.mpf) -> tuple[mp.matrix, mp.mpf]:
        """The mass centre of the right rod, and its turn."""
        joint = five_bar(theta)
        d = mp.matrix([90 + 15 * mp.sin(2 * theta), 15 * mp.cos(2 * theta)])
        turn = mp.atan2(joint[1] - d[1], joint[0] - d[0]) - mp.atan2(70, -40)
        off = mp.matrix([45 - 90, 60 - 15])
        turned = mp.matrix(
            [
                off[0] * mp.cos(turn) - off[1] * mp.sin(turn),
                off[0] * mp.sin(turn) + off[1] * mp.cos(turn),
            ]
        )
        return d + turned, turn

    def energy(theta: mp.mpf) -> mp.mpf:
        """N mm."""
        x, y, turn = (
            8 * mp.diff(lambda t, k=k: (*middle(t)[0], middle(t)[1])[k], theta) for k in range(3)
        )
        return (mp.mpf("0.4") * (x * x + y * y) + 200 * turn * turn) / 2000

    with mp.workdps(40):
        for k in (1, 7, 16):
            at = mp.radians(mp.mpf(float(rows["A.theta"][k])))
            torque = mp.diff(lambda t: energy(t) + 20 * five_bar(t)[1], at)
            near(rows["A.effort"][k], float(torque), 1e-9)


def test_rack_in_a_loop() -> None:
    """s = r cos + sqrt(l^2 - r^2 sin^2) less its place at home; the rack rolls on 20 mm."""
    rows = rows_of("rack_in_a_loop")
    theta = np.radians(rows["A.theta"])
    s = 30.0 * np.cos(theta) + np.sqrt(1e4 - (30.0 * np.sin(theta)) ** 2) - 130.0
    near(rows["S.s"], s)
    near(np.abs(rows["W.theta"]), np.degrees(np.abs(s) / 20.0))
    # 0.6 N m at 20 mm is 30 N
    near(rows["norm(K.tooth_force)"], 30.0 / np.cos(np.radians(20.0)), 1e-10)


def test_the_torque_of_the_rack_in_a_loop() -> None:
    rows = rows_of("rack_in_a_loop")

    def slide(theta: mp.mpf) -> mp.mpf:
        return 30 * mp.cos(theta) + mp.sqrt(10**4 - (30 * mp.sin(theta)) ** 2)

    sign = np.sign(rows["W.theta"][3] * rows["S.s"][3])
    with mp.workdps(40):
        for k in (2, 9, 17):
            at = mp.radians(mp.mpf(float(rows["A.theta"][k])))
            # per turn: kinetic energy of half a kilogram, and the moment on the pinion
            speed = mp.diff(lambda t: (10 * mp.diff(slide, t)) ** 2 / 4000, at)
            load = 600 * sign * mp.diff(slide, at) / 20
            near(rows["A.effort"][k], float(speed - load), 1e-9)


def test_bevel_differential() -> None:
    """Twice the case's turn is the sum of both sides', and the planet turns by their difference
    times 24/16; both sides have half the case's torque."""
    rows = rows_of("bevel_differential")
    case = rows["K.theta"]
    near(rows["M.theta"], 0.75 * case)
    near(np.abs(rows["P.theta"]), 24.0 / 16.0 * 0.25 * case)
    near(rows["K.effort"], 6000.0, 1e-9)
    near(rows["L.effort"], -3000.0, 1e-9)
    # 3 N m at 36 mm, and the push of the cones, square to it
    near(rows["norm(H.tooth_force)"], 3000.0 / 36.0 / np.cos(np.radians(20.0)), 1e-10)


def test_worm_gear() -> None:
    """The wheel turns 2/40 of the worm. Its 8 N m at 80 mm are the worm's thrust; the worm's own
    torque is a twentieth of them, at 20 mm; the teeth part by the normal force times sin 20 deg."""
    rows = rows_of("worm_gear")
    near(rows["B.theta"], -rows["A.theta"] / 20.0)
    near(rows["A.effort"], 400.0, 1e-9)
    force = rows["G.tooth_force"]
    near(np.abs(force[:, 0]), 100.0, 1e-10)
    near(np.abs(force[:, 1]), 20.0, 1e-10)
    near(np.abs(force[:, 2]), np.hypot(100.0, 20.0) * SLANT, 1e-10)


def test_open_belt() -> None:
    """3 N m at 30 mm is the difference of the strands, about 150 N; on a bearing they make the sum
    along the line of centres, and the difference across, by the angle of the strands."""
    rows = rows_of("open_belt")
    near(rows["B.theta"], 0.5 * rows["A.theta"])
    near(rows["A.effort"], 3000.0, 1e-9)
    near(rows["K.tight"], 200.0, 1e-10)
    near(rows["K.slack"], 100.0, 1e-10)
    sine = 30.0 / 200.0
    pulled = np.hypot(300.0 * np.sqrt(1.0 - sine * sine), 100.0 * sine)
    near(rows["norm(A.force)"], pulled, 1e-10)
    near(rows["norm(B.force)"], pulled, 1e-10)


def test_tackle() -> None:
    """Four strands: a quarter of the cart's way, with 8 kg by 10 + 0.1 m/s^2 on them."""
    rows = rows_of("tackle")
    near(rows["G.s"], 0.25 * rows["C.s"])
    near(rows["G.s_dot"], 0.25 * 200.0)
    near(rows["K.tension"], 8.0 * 10.1 / 4.0)
    near(rows["C.effort"], 8.0 * 10.1 / 4.0)


def test_cylinder_boom() -> None:
    """P is 500 from the pin, Q 600: the law of cosines; the weight's moment by the arm of the
    cylinder, and on the pin what the cylinder does not bear. At a constant speed of the cylinder
    the boom, whose weight alone has an inertia of m 800^2, turns faster and faster."""
    rows = rows_of("cylinder_boom")
    length = rows["lift.s"]
    inner = np.arccos((500.0**2 + 600.0**2 - length**2) / (2.0 * 500.0 * 600.0))
    turn = inner - inner[0]
    near(np.radians(rows["A.theta"]), turn)
    # length' = arm * turn', arm = 500 * 600 sin(inner) / length
    arm = 3e5 * np.sin(inner) / length
    rate = 50.0 / arm
    near(rows["A.theta_dot"], rate)
    slope = 3e5 * np.cos(inner) / length - arm * arm / length
    quickening = -slope * rate * rate / arm
    x, y = 800.0 * np.cos(turn), 800.0 * np.sin(turn)
    pulled = 60.0 * (10.0 * x + 1e-3 * 800.0**2 * quickening)
    near(rows["lift.force"], pulled / arm, 1e-10)
    near(rows["lift.pressure"], rows["lift.force"] / (np.pi * 63.0**2 / 4.0), 1e-10)
    q = 600.0 * np.cos(turn) - 300.0, 600.0 * np.sin(turn) + 400.0
    across = 60e-3 * (-quickening * y - rate * rate * x) - rows["lift.force"] * q[0] / length
    upwards = 60e-3 * (quickening * x - rate * rate * y) + 600.0
    upwards -= rows["lift.force"] * q[1] / length
    near(rows["norm(A.force)"], np.hypot(across, upwards), 1e-10)


Law = Callable[[Any], Any]


def follows(rows: Any, crank: str, name: str, law: Law, rate: float, turns: bool = False) -> None:
    """A coordinate and its rates are those of a law of a crank's turn (rad) of a constant rate; it
    `turns`: by that many radians, not lengths."""
    expected: list[list[float]] = [[], [], []]
    with mp.workdps(40):
        for turn in rows[crank]:
            at = mp.radians(mp.mpf(float(turn)))
            one, two = (mp.diff(law, at, order) for order in (1, 2))
            value = mp.degrees(law(at)) if turns else law(at)
            for known, each in zip(expected, (value, rate * one, rate**2 * two), strict=True):
                known.append(float(each))
    for order, known in zip(("", "_dot", "_ddot"), expected, strict=True):
        size = np.max(np.abs(known))
        np.testing.assert_allclose(rows[name + order], known, rtol=1e-11, atol=1e-12 * size)


def slopes(rows: Any, crank: str, work: Law) -> list[float]:
    """The slope of a work (N mm) by a crank's turn (rad), in each row."""
    with mp.workdps(40):
        turns = [mp.radians(mp.mpf(float(turn))) for turn in rows[crank]]
        return [float(mp.diff(work, at)) for at in turns]


def test_geneva_drive() -> None:
    """tan(wheel) = -r sin/(d - r cos) with d = r sqrt(2): a quarter, at rest where it begins and
    ends. The crank moves the wheel's inertia, whose pin pushes square to the slot."""
    rows = rows_of("geneva_drive")

    def law(x: Any) -> Any:
        return -mp.atan(mp.sin(x) / (mp.sqrt(2) - mp.cos(x)))

    follows(rows, "A.theta", "B.theta", law, 6.0, turns=True)
    turned, rate = rows["B.theta"], rows["B.theta_dot"]
    near(turned[0] - turned[-1], 90.0)
    near(rate[[0, -1]], 0.0)
    energy = slopes(rows, "A.theta", lambda x: (6 * mp.diff(law, x)) ** 2 / 2)
    near(rows["A.effort"], energy, 1e-10)
    # on the slot at the pin's distance from the wheel's axis
    crank = np.radians(rows["A.theta"])
    arm = 50.0 * np.sqrt(3.0 - 2.0 * np.sqrt(2.0) * np.cos(crank))
    near(rows["norm(D.force)"], np.abs(rows["B.theta_ddot"]) / arm, 1e-10)


def test_scotch_yoke() -> None:
    """r cos: a yoke of 2 kg in pure harmonic motion, pushed along its guide alone."""
    rows = rows_of("scotch_yoke")
    follows(rows, "A.theta", "S.s", lambda x: 30 * mp.cos(x) - 30, 20.0)
    theta = np.radians(rows["A.theta"])
    near(rows["A.effort"], 2e-3 * (30.0 * 20.0) ** 2 * np.sin(theta) * np.cos(theta), 1e-10)
    near(rows["norm(D.force)"], 2e-3 * 30.0 * 400.0 * np.abs(np.cos(theta)), 1e-10)


def test_the_quick_return_of_whitworth() -> None:
    """The arm's end at 40 mm turns as the crank's pin is seen from the arm's axis; both dead
    centres of the ram lie 180 deg + 2 asin(d/r) apart."""
    rows = rows_of("whitworth")

    def arm(x: Any) -> Any:
        """From the drawing, where the pin is level with the arm's axis, left of it."""
        at = x - mp.pi + mp.asin(mp.mpf(2) / 5)
        aside = mp.atan2(2 * mp.cos(at), 5 + 2 * mp.sin(at))
        return at + aside + mp.pi

    def ram(x: Any) -> Any:
        turn = arm(x)
        return 40 * mp.cos(turn) + mp.sqrt(150**2 - (40 * mp.sin(turn)) ** 2) - 190

    follows(rows, "A.theta", "B.theta", arm, 5.0, turns=True)
    follows(rows, "A.theta", "S.s", ram, 5.0)
    near(rows["A.effort"], slopes(rows, "A.theta", lambda x: 200 * ram(x)), 1e-9)
    back = 180.0 - 2.0 * np.degrees(np.arcsin(20.0 / 50.0))
    text = FILE_OF["whitworth"].read_text(encoding="utf-8")
    text = text.replace("step: 15", f"step: {back:.15g}").replace("to: 360", f"to: {back:.15g}")
    ends = mk.loads(text).analyze()
    near(ends["S.s"], [0.0, -80.0], 1e-9)
    near(ends["S.s_dot"], 0.0, 1e-9)


def test_cardan_gears() -> None:
    """The planet turns as much as the carrier, the other way: a point of its pitch circle has
    y = 0, one at 10 mm the half axes 30 + 10 and 30 - 10. 100 N along the straight way."""
    rows = rows_of("cardan_gears")
    theta = np.radians(rows["C.theta"])
    near(rows["P.theta"], -2.0 * rows["C.theta"])
    near(rows["straight.position.x"], 60.0 * np.cos(theta))
    near(rows["straight.position.y"], 0.0)
    near(rows["straight.velocity.x"], -600.0 * np.sin(theta), 1e-10)
    near(rows["ellipse.position.x"], 40.0 * np.cos(theta))
    near(rows["ellipse.position.y"], 20.0 * np.sin(theta))
    near(rows["C.effort"], -6000.0 * np.sin(theta), 1e-9)


def test_cardioid_gears() -> None:
    """x = 2 a cos - a cos 2, y = 2 a sin - a sin 2, with a cusp where the pen stands still; 20 N
    against x."""
    rows = rows_of("cardioid_gears")
    theta = np.radians(rows["C.theta"])
    near(rows["P.theta"], rows["C.theta"])
    near(rows["pen.position.x"], 48.0 * np.cos(theta) - 24.0 * np.cos(2.0 * theta))
    near(rows["pen.position.y"], 48.0 * np.sin(theta) - 24.0 * np.sin(2.0 * theta))
    near(rows["norm(pen.velocity)"], 2.0 * 2.0 * 48.0 * np.abs(np.sin(theta / 2.0)), 1e-10)
    near(rows["C.effort"], 20.0 * 48.0 * (np.sin(2.0 * theta) - np.sin(theta)), 1e-9)


def test_gear_with_play() -> None:
    """Both wheels have 100 + 1600/4 kg mm^2 at the pinion, which the moment 1 - 20 t drives as one
    gear, up to 0.05 s and behind the last impact; between the flanks the pinion goes by itself."""
    rows = mk.load(FILE_OF["gear_play"]).respond("reversal")
    assert set(rows["row.status"]) == {"ok"}
    time = rows["time"]
    met = rows.result.impacts
    assert len(met) == 9
    as_gear = (time < 0.05) | (time > met[-1].time)
    gained = 2000.0 * time - 20000.0 * time**2
    near(rows["A.theta_dot"][as_gear], gained[as_gear], 1e-9)
    near(rows["B.theta_dot"][as_gear], -0.5 * gained[as_gear], 1e-9)
    # 400 of the 500 kg mm^2 are behind the teeth, at 20 mm
    tangential = 40.0 * (1.0 - 20.0 * time)
    near(rows["G.tooth_force"][as_gear, 1], tangential[as_gear], 1e-9)
    near(rows["G.tooth_force"][as_gear, 0], np.abs(tangential[as_gear]) * SLANT, 1e-9)
    near(rows["G.play"][time < 0.05], 0.1)
    near(rows["G.play"][time > met[-1].time], -0.1, 1e-7)
    across = 0.05 + (0.2 * 3.0 / 2e6) ** (1.0 / 3.0)
    assert met[1].time == pytest.approx(across, rel=1e-7)
    free = (time > 0.05) & (time < across)
    since = time[free] - 0.05
    near(rows["A.theta_dot"][free], 50.0 - 1e5 * since**2)
    near(rows["B.theta_dot"][free], -25.0)
    near(rows["G.play"][free], 0.1 - 2e6 * since**3 / 3.0, 1e-10)
    near(rows["norm(A.force)"][free], 0.0)
    # masses of 0.25 and 1 kg at the pitch circle, with 0.4 of the rate of the play
    rate = 2.0 * (across - 0.05) ** 2 * 1e6 * 1e-3
    assert met[1].rates[0] == pytest.approx(rate, rel=1e-6)
    assert met[1].impulses[0] == pytest.approx(1.4 * rate * 0.25 / 1.25, rel=1e-6)


def test_cable_robot() -> None:
    """A drum winds up what the length from its pulley on loses; three pulls hold the mass."""
    rows = rows_of("cable_robot")
    corners = ((1000, 0), (-500, 900), (-500, -900))

    def length(corner: tuple[int, int], x: mp.mpf, y: mp.mpf, z: mp.mpf) -> mp.mpf:
        """Of the tangent to a pulley of 40 mm in the vertical plane of the mass, and of the arc."""
        out = mp.hypot(x - corner[0], y - corner[1]) - 40
        apart = mp.hypot(out, z)
        touch = mp.atan2(z, out) + mp.acos(40 / apart)
        return mp.sqrt(apart**2 - 1600) + 40 * (mp.pi - touch)

    with mp.workdps(40):
        for k, x in enumerate(rows["X.s"]):
            at = [mp.mpf(float(x)), mp.mpf(float(x)) / 2, mp.mpf(float(x)) ** 2 / 600 - 1200]
            pulls = mp.matrix(3, 3)
            for n, corner in enumerate(corners):
                paid = length(corner, *at) - length(corner, 0, 0, -1200)
                near(rows[f"D{n + 1}.theta"][k], float(-mp.degrees(paid / 50)))
                for axis in range(3):
                    order = tuple(int(axis == i) for i in range(3))
                    pulls[axis, n] = -mp.diff(lambda *p, c=corner: length(c, *p), tuple(at), order)
            # x'' = 0.5, y'' = x''/2, z'' = (x'^2 + x x'')/0.3 in m and s
            rise = (mp.mpf("0.04") + at[0] / 1000 / 2) / mp.mpf("0.3")
            force = mp.matrix([mp.mpf("2.5"), mp.mpf("1.25"), 5 * (mp.mpf("9.81") + rise)])
            for n, pull in enumerate(mp.lu_solve(pulls, force)):
                near(rows[f"K{n + 1}.tension"][k], float(pull), 1e-10)
                near(rows[f"D{n + 1}.effort"][k], 50.0 * float(pull), 1e-10)


def test_serpentine_drive() -> None:
    """6 N m at 60 mm and 4 N m at 45 mm leave their shares of 300 N from strand to strand; the
    idler's and the crankshaft's bearings take both, by the angle between them."""
    rows = rows_of("serpentine_drive")
    for name, radius in (("B", 60.0), ("I", -30.0), ("C", 45.0), ("T", -35.0)):
        near(rows[f"{name}.theta"], 80.0 / radius * rows["A.theta"])
    fan, pump = 4000.0 / 45.0, 100.0
    near(rows["A.effort"], 80.0 * (fan + pump), 1e-9)
    near(rows["K.T.tension"], 300.0, 1e-10)
    near(rows["K.I.tension"], 300.0 - fan, 1e-10)
    near(rows["K.B.tension"], 300.0 - fan, 1e-10)
    near(rows["K.A.tension"], 300.0 - fan - pump, 1e-10)

    def strand(apart: complex, rise: float) -> float:
        """Direction of a tangent whose circles lie `rise` further to its left at its end."""
        return float(np.angle(apart) - np.arcsin(rise / abs(apart)))

    between = strand(-70 + 150j, 75.0) - strand(-90 + 110j, -90.0)
    near(rows["norm(I.force)"], 2.0 * (300.0 - fan) * abs(np.sin(between / 2.0)), 1e-10)
    leaves, comes = strand(240 + 40j, -20.0), strand(40 - 140j, 115.0)
    pull = (300.0 - fan - pump) * np.exp(1j * leaves) - 300.0 * np.exp(1j * comes)
    near(rows["norm(A.force)"], abs(pull), 1e-10)


NAMES = (
    "tackle",
    "cable_robot",
    "serpentine_drive",
    "cylinder_boom",
    "spur_gears",
    "planetary_gear",
    "geared_five_bar",
    "rack_in_a_loop",
    "bevel_differential",
    "worm_gear",
    "open_belt",
    "geneva_drive",
    "scotch_yoke",
    "whitworth",
    "cardan_gears",
    "cardioid_gears",
)

NOT_REPEATED = {"cardan_gears": {"straight_y"}}
"""Columns that are zero but for rounding."""


@pytest.mark.parametrize("name", NAMES)
def test_every_table_is_repeated_in_double_double(name: str) -> None:
    """Ratios, places and pretension are recorded, whether they are written or computed."""
    errors = rows_of(name).errors
    assert {column.label for column in errors.columns if column.why} == NOT_REPEATED.get(
        name, set()
    )
    assert errors.digits >= 13


@pytest.mark.parametrize("name", NAMES)
def test_power_of_every_row_balances(name: str) -> None:
    assert np.nanmax(np.abs(rows_of(name)["row.power_error"])) < 1e-12
