"""Profiles of cams against closed forms: eccentric circles for every follower, pressure angles and
radii of curvature at 40 digits, undercut and lift-off at their places, and the drawings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile, UsageError

FILE = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
parameters: {R: 40 mm, r: 12 mm, x: 9 mm, L: 70 mm, D: 90 mm, h: 6 mm}
links: {cam: {}, follower: {mass: 0.5, center_of_mass: [0, 0], inertia: 200}}
joints:
  A: {type: R, links: [ground, cam], point: [0, 0]}
  B: FOLLOWS
couplings:
  K: {type: function, of: A.theta, gives: GIVES, LAW, follower: FOLLOWER}
"""
SLIDE = "{type: P, links: [ground, follower], point: [0, 60], axis: [0, 1]}"
SWING = "{type: R, links: [follower, ground], point: [90, 0]}"


def cam(law: str, follower: str, more: str = "") -> mk.Model:
    """The model of a cam."""
    swings = "oscillating" in follower
    text = FILE.replace("FOLLOWS", SWING if swings else SLIDE)
    text = text.replace("GIVES", "B.theta" if swings else "B.s")
    return mk.loads(text.replace("LAW", law).replace("FOLLOWER", follower) + more)


# The centre of a circle of radius R is x off the axis, opposite to a translating follower, and to
# the left of an oscillating one's line of centres, when theta is 0. The distance of the pivot from
# it is E, and the angle there from the line to the axis is G.
TO_CENTRE = "sqrt(D^2 + x^2 + 2*D*x*cos(theta))"
AROUND = "atan2(-x*sin(theta), D + x*cos(theta))"
ROLLED = f"acos(({TO_CENTRE}^2 + L^2 - (R + r)^2)/(2*L*{TO_CENTRE})) + {AROUND}"
ROLLED_FIRST = "acos(((D + x)^2 + L^2 - (R + r)^2)/(2*L*(D + x)))"
LAID = f"asin((R + h)/{TO_CENTRE}) + {AROUND}"
ECCENTRIC = {
    "flat": (
        'value: "x*(1 - cos(theta))"',
        "{type: translating, contact: flat, base_radius: R - x}",
        (0.0, -9.0),
    ),
    "roller": (
        'value: "sqrt((R + r)^2 - (x*sin(theta))^2) - x*cos(theta) - (R + r - x)"',
        "{type: translating, contact: roller, radius: r, base_radius: R - x}",
        (0.0, -9.0),
    ),
    "offset roller": (
        'value: "sqrt((R + r)^2 - (h - x*sin(theta))^2) - x*cos(theta) '
        '- sqrt((R + r)^2 - h^2) + x"',
        "{type: translating, contact: roller, radius: r, offset: h, "
        "base_radius: sqrt((sqrt((R + r)^2 - h^2) - x)^2 + h^2) - r}",
        (0.0, -9.0),
    ),
    "knife": (
        'value: "sqrt(R^2 - (x*sin(theta))^2) - x*cos(theta) - (R - x)"',
        "{type: translating, contact: knife, base_radius: R - x}",
        (0.0, -9.0),
    ),
    "swinging roller": (
        f'value: "{ROLLED} - {ROLLED_FIRST}"',
        "{type: oscillating, contact: roller, radius: r, arm: L, distance: D, base_radius: "
        f"sqrt(D^2 + L^2 - 2*D*L*cos({ROLLED_FIRST})) - r}}",
        (-9.0, 0.0),
    ),
    "swinging face": (
        f'value: "{LAID} - asin((R + h)/(D + x))"',
        "{type: oscillating, contact: flat, offset: h, distance: D, "
        "base_radius: D*(R + h)/(D + x) - h}",
        (-9.0, 0.0),
    ),
}


@pytest.mark.parametrize(("law", "follower", "centre"), ECCENTRIC.values(), ids=ECCENTRIC.keys())
def test_an_eccentric_circle_is_what_moves_its_followers(
    law: str, follower: str, centre: tuple[float, float]
) -> None:
    found = cam(law, follower).cam("K", points=90)
    apart = found.profile - np.array(centre)[:, None]
    np.testing.assert_allclose(np.hypot(*apart), 40.0, rtol=1e-12)
    np.testing.assert_allclose(found.radius, 40.0, rtol=1e-10)
    assert found.is_closed
    assert found.undercut == ()
    assert found.least_radius is not None
    assert found.least_radius.value == pytest.approx(40.0, rel=1e-10)
    assert found.hollow_radius is None


RISE = "law: {law: cycloidal, from: 0 mm, to: 20 mm, start: 30 deg, duration: 60 deg}"


def lifted(x: Any) -> Any:
    """A cycloidal rise of 20 mm from 30 to 90 deg."""
    u = (x - mp.pi / 6) / (mp.pi / 3)
    return 20 * (u - mp.sin(2 * mp.pi * u) / (2 * mp.pi))


@pytest.mark.parametrize("offset", [0, 7, -7])
def test_pressure_angle_and_curvature_of_a_roller(offset: int) -> None:
    """tan(phi) = (s' - e)/(s + sqrt(Rp^2 - e^2)); the curvature of the curve that the roller's
    centre takes round the cam, less the roller."""
    follower = "{type: translating, contact: roller, base_radius: 45 mm, radius: 8 mm, "
    found = cam(RISE, follower + f"offset: {offset} mm}}").cam(points=360)
    for row in range(31, 90, 4):
        with mp.workdps(40):
            turn = mp.mpf(row) * mp.pi / 180
            height = mp.sqrt(mp.mpf(53) ** 2 - offset**2)

            def path(x: Any, height: Any = height) -> Any:
                return (offset + 1j * (height + lifted(x))) * mp.expj(-x)

            phi = mp.atan((mp.diff(lifted, turn) - offset) / (lifted(turn) + height))
            one, two = mp.diff(path, turn), mp.diff(path, turn, 2)
            radius = -(abs(one) ** 3) / (mp.conj(one) * two).imag - 8
            place = path(turn) - 8j * one / abs(one)
        assert found.turn[row] == pytest.approx(row)
        assert found.pressure_angle[row] == pytest.approx(float(mp.degrees(phi)), abs=1e-11)
        assert found.radius[row] == pytest.approx(float(radius), rel=1e-11)
        np.testing.assert_allclose(
            found.profile[:, row], [float(place.real), float(place.imag)], rtol=1e-12, atol=1e-12
        )
    with mp.workdps(30):
        slope = mp.diff
        most = mp.findroot(
            lambda x: slope(lambda z: (slope(lifted, z) - offset) / (lifted(z) + height), x),
            1.0,
        )
        phi = mp.atan((mp.diff(lifted, most) - offset) / (lifted(most) + height))
    assert found.greatest_pressure_angle.value == pytest.approx(float(mp.degrees(phi)), rel=1e-10)
    assert found.greatest_pressure_angle.turn == pytest.approx(float(mp.degrees(most)), rel=1e-6)


def test_a_cam_of_other_parameters_needs_no_sweep() -> None:
    """R + s + s'' = R + 10 mm under a flat face with s = 10 mm (1 - cos(theta))."""
    law = 'value: "10 mm*(1 - cos(theta))"'
    model = cam(law, "{type: translating, contact: flat, base_radius: R}")
    for size in (40.0, 35.0):
        varied = model.with_parameters({"R": size})
        np.testing.assert_allclose(varied.cam().radius, size + 10.0, rtol=1e-12)
        assert varied.mobility().mobility == 1
    with pytest.raises(InvalidFile, match="is not driven"):
        varied.analyze()


def test_undercut_is_named_with_its_place() -> None:
    """A flat face over too small a base: R + s + s'' falls below zero."""
    found = cam(RISE, "{type: translating, contact: flat, base_radius: 30 mm}").cam()
    with mp.workdps(30):

        def radius(x: Any) -> Any:
            return 30 + lifted(x) + mp.diff(lifted, x, 2)

        ends = [float(mp.degrees(mp.findroot(radius, mp.radians(at)))) for at in (65, 88)]
    assert len(found.undercut) == 1
    np.testing.assert_allclose(found.undercut[0], ends, rtol=1e-9)
    assert "undercut" in [d.code for d in found.diagnostics]
    assert f"from {ends[0]:.6g} to {ends[1]:.6g} deg" in str(found.diagnostics[0])
    # a pitch curve, and rollers smaller and larger than its least radius of curvature
    roller = "{type: translating, contact: roller, base_radius: 35 mm, radius: 35 mm}"
    least = cam(RISE, roller).cam().least_radius
    assert least is not None
    larger = f"{35.0 + least.value + 1e-5} mm"
    smaller = f"{35.0 + least.value - 1e-5} mm"
    for radius, is_cut in ((larger, True), (smaller, False)):
        changed = roller.replace("radius: 35 mm}", f"radius: {radius}}}")
        changed = changed.replace("base_radius: 35 mm", f"base_radius: 70 mm - {radius}")
        assert bool(cam(RISE, changed).cam().undercut) == is_cut


@pytest.mark.parametrize("at", [-0.3, 0.3, -2.4, 2.5])
@pytest.mark.parametrize("clear", [0.5, -1e-4])
def test_extremes_beside_the_seam_of_the_turn(at: float, clear: float) -> None:
    """A flat face over s = f(theta) - f(0), f = cos(2 (theta - at)) + cos(3 (theta - at)), whose
    radius R + s + s'' = R - f(0) - 3 cos(...) - 8 cos(...) is least at the turn `at`."""
    with mp.workdps(30):
        begin = mp.cos(2 * mp.radians(at)) + mp.cos(3 * mp.radians(at))
    size = float(begin) + 11.0 + clear
    law = f'value: "1 mm*(cos(2*(theta - {at} deg)) + cos(3*(theta - {at} deg))) - {begin} mm"'
    follower = f"{{type: translating, contact: flat, base_radius: {size!r} mm}}"
    found = cam(law, follower).cam(points=72)
    if clear > 0.0:
        least = found.least_radius
        assert least is not None
        assert least.value == pytest.approx(clear, rel=1e-10)
        assert least.turn == pytest.approx(at % 360.0, abs=1e-4)
        assert found.undercut == ()
    else:  # about the turn, as wide as the parabola below zero: 84 x^2/2 = 1e-4
        half = np.degrees(np.sqrt(-2.0 * clear / 84.0))
        assert len(found.undercut) == 1
        assert found.undercut[0] == pytest.approx(
            (at % 360.0 - half, at % 360.0 + half), abs=1e-4 * half
        )


def test_lift_off_is_told_in_the_rows_of_the_sweep() -> None:
    """m s'' w^2 + spring < 0, as the follower is held down by a constant force alone."""
    more = """
motion: {inputs: {A.theta: {from: 0, to: 180, step: 1, rate: 60 rad/s}}}
loads: [{type: force, joint: B, value: -20 N}]
"""
    follower = "{type: translating, contact: roller, base_radius: 40 mm, radius: 10 mm}"
    found = cam(RISE, follower, more).cam()
    rows = np.arange(0.0, 181.0)
    u = np.clip((np.radians(rows) - np.pi / 6) / (np.pi / 3), 0.0, 1.0)
    bend = 20e-3 * 2.0 * np.pi * np.sin(2.0 * np.pi * u) / (np.pi / 3) ** 2
    pulled = rows[0.5 * bend * 60.0**2 + 20.0 < 0.0]
    assert found.lift_off == ((pulled[0], pulled[-1]),)
    assert "lift-off" in [d.code for d in found.diagnostics]


def test_the_drawings_hold_the_profile(tmp_path: Path) -> None:
    law, follower, _ = ECCENTRIC["roller"]
    found = cam(law, follower).cam(points=60)
    files = found.files()
    assert set(files) == {"K.csv", "K.dxf", "K.svg", "K.curve.yaml"}
    lines = files["K.dxf"].decode().split("\n")
    pairs = list(zip(lines[::2], lines[1::2], strict=False))
    assert pairs[-1] == ("  0", "EOF")
    vertices: dict[str, list[tuple[float, float]]] = {}
    for k, pair in enumerate(pairs):
        if pair == ("  0", "VERTEX"):
            layer, x, y = (pairs[k + n][1] for n in (1, 2, 3))
            vertices.setdefault(layer, []).append((float(x), float(y)))
    np.testing.assert_array_equal(np.array(vertices["PROFILE"]).T, found.profile[:, :-1])
    np.testing.assert_array_equal(np.array(vertices["PITCH"]).T, found.pitch[:, :-1])
    header, *rows = files["K.csv"].decode().strip().split("\n")
    assert header.startswith("turn [deg],lift [mm],lift_1 [mm/rad]")
    assert len(rows) == 61
    assert b"<path" in files["K.svg"]


REFUSED = {
    "no radius": ("radius: r, ", "", "needs radius"),
    "an arm": ("radius: r, ", "radius: r, arm: 3 mm, ", "has no arm"),
    "too far": ("radius: r, ", "radius: r, offset: 70 mm, ", "does not reach"),
    "no base": ("base_radius: R - x", "base_radius: 0 mm", "base_radius is positive"),
    "another motion": ("type: translating", "type: oscillating, arm: L, distance: D", "angle"),
}


@pytest.mark.parametrize(("before", "after", "words"), REFUSED.values(), ids=REFUSED.keys())
def test_followers_that_cannot_be(before: str, after: str, words: str) -> None:
    law, follower, _ = ECCENTRIC["roller"]
    text = FILE.replace("FOLLOWS", SLIDE).replace("GIVES", "B.s").replace("LAW", law)
    with pytest.raises(InvalidFile) as told:
        mk.loads(text.replace("FOLLOWER", follower.replace(before, after)))
    errors = [d for d in told.value.diagnostics if d.severity == "error"]
    assert len(errors) == 1
    assert words in str(errors[0])


def test_couplings_that_are_no_cams() -> None:
    law, follower, _ = ECCENTRIC["roller"]
    model = cam(law, follower)
    with pytest.raises(UsageError, match="there is no coupling Q"):
        model.cam("Q")
    plain = mk.loads(
        FILE.replace("FOLLOWS", SLIDE)
        .replace("GIVES", "B.s")
        .replace("LAW", law)
        .replace(", follower: FOLLOWER", "")
    )
    with pytest.raises(UsageError, match="has a follower"):
        plain.cam()
