"""The files of `mechanisms/couplings` against closed forms: ratios, torques by power, forces of
teeth and strands, and loops by circles at 40 digits."""

from __future__ import annotations

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
)


@pytest.mark.parametrize("name", NAMES)
def test_every_table_is_repeated_in_double_double(name: str) -> None:
    """Ratios, places and pretension are recorded, whether they are written or computed."""
    errors = rows_of(name).errors
    assert {column.why for column in errors.columns} == {""}
    assert errors.digits >= 13


@pytest.mark.parametrize("name", NAMES)
def test_power_of_every_row_balances(name: str) -> None:
    assert np.nanmax(np.abs(rows_of(name)["row.power_error"])) < 1e-12
