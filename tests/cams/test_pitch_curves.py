"""The way back: the pitch curve of a cam, taken as the curve of a pair, moves the follower by the
law that the cam was cut for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError

HEAD = """
format: 1
plane: xy
units: {length: mm, angle: deg}
links: {cam: {}, follower: {}}
joints:
  A: {type: R, links: [ground, cam], point: [0, 0]}
  B: GUIDE
"""
# turns between the points of the curve
MOTION = """
motion: {inputs: {A.theta: {from: 0.13, to: 359, step: 2.37, rate: 1 rad/s}}}
"""
SLIDE = "{type: P, links: [ground, follower], point: [0, 60], axis: [0, 1]}"
SWING = "{type: R, links: [follower, ground], point: [95, 0]}"


def waves(most: float, more: float) -> tuple[str, Callable[[Any], Any]]:
    """A smooth law in mm or deg, and its values."""
    return (
        f"{most}*(1 - cos(theta)) + {more}*(1 - cos(2*theta))",
        lambda x: most * (1.0 - np.cos(x)) + more * (1.0 - np.cos(2.0 * x)),
    )


def risen(x: Any) -> Any:
    """A cycloidal rise of 20 mm in 60 deg, and its return."""
    turn = np.degrees(x)
    up, down = (np.clip((turn - a) / 60.0, 0.0, 1.0) for a in (30.0, 180.0))
    rise, fall = (u - np.sin(2.0 * np.pi * u) / (2.0 * np.pi) for u in (up, down))
    return 20.0 * (rise - fall)


TRANSLATING = "{type: translating, base_radius: 40 mm, "
OSCILLATING = "{type: oscillating, base_radius: 40 mm, arm: 80 mm, distance: 95 mm, "
FOLLOWERS = {
    "roller": TRANSLATING + "contact: roller, radius: 10 mm, offset: 5 mm}",
    "knife": TRANSLATING + "contact: knife}",
    "swinging roller": OSCILLATING + "contact: roller, radius: 10 mm}",
    "swinging knife": OSCILLATING + "contact: knife}",
}


def cut(guide: str, law: str, follower: str) -> mk.Model:
    gives = "B.theta" if guide == SWING else "B.s"
    words = f"K: {{type: function, of: A.theta, gives: {gives}, {law}, follower: {follower}}}"
    return mk.loads(f"{HEAD.replace('GUIDE', guide)}couplings:\n  {words}\n")


def led(guide: str, curve: dict[str, Any]) -> mk.Result:
    """The follower on the cam's curve."""
    section = f"{{closed: {str(curve['closed']).lower()}, points: {curve['points']}}}"
    pin = f"{{type: Ps, links: [follower, cam], point: {curve['points'][0]}, curve: {section}}}"
    return mk.loads(f"{HEAD.replace('GUIDE', guide)}  D: {pin}\n{MOTION}").analyze()


@pytest.mark.parametrize("follower", FOLLOWERS.values(), ids=FOLLOWERS.keys())
def test_a_pitch_curve_gives_its_law_back(follower: str) -> None:
    swings = "oscillating" in follower
    guide, unit = (SWING, "deg") if swings else (SLIDE, "mm")
    value, law = waves(6.0, 2.0)
    value = f"({value})*1 {unit}"
    curve = cut(guide, f'value: "{value}"', follower).cam("K", points=3600).curve()
    assert curve["closed"]
    result = led(guide, curve)
    assert set(result["row.status"]) == {"ok"}
    x = np.radians(np.asarray(result["A.theta"]))
    np.testing.assert_allclose(result["B.theta" if swings else "B.s"], law(x), atol=1e-10)
    rate = np.asarray(result["B.theta_dot" if swings else "B.s_dot"])
    known = (6.0 * np.sin(x) + 4.0 * np.sin(2.0 * x)) * (np.pi / 180.0 if swings else 1.0)
    np.testing.assert_allclose(rate, known, atol=1e-8)


def test_a_rise_with_dwells_comes_back_too() -> None:
    """The jerk of a cycloidal rise jumps at its ends, which are points of the curve."""
    segments = (
        "{for: 30 deg, law: dwell}, {for: 60 deg, to: 20 mm, law: cycloidal}, "
        "{for: 90 deg, law: dwell}, {for: 60 deg, to: 0 mm, law: cycloidal}, "
        "{for: 120 deg, law: dwell}"
    )
    rise = f"law: {{law: sequence, from: 0 mm, segments: [{segments}]}}"
    curve = cut(SLIDE, rise, FOLLOWERS["roller"]).cam("K", points=3600).curve()
    result = led(SLIDE, curve)
    x = np.radians(np.asarray(result["A.theta"]))
    np.testing.assert_allclose(result["B.s"], risen(x), atol=1e-9)


def test_its_file_is_a_curve_of_a_mechanism() -> None:
    cam = cut(SLIDE, 'value: "6 mm*(1 - cos(theta))"', FOLLOWERS["knife"]).cam("K", points=90)
    text = cam.files()["K.curve.yaml"].decode()
    pin = "  D:\n    type: Ps\n    links: [follower, cam]\n    point: [0, 40]\n"
    inside = "".join(f"    {line}\n" for line in text.splitlines())
    result = mk.loads(f"{HEAD.replace('GUIDE', SLIDE)}{pin}{inside}{MOTION}").analyze()
    same = led(SLIDE, cam.curve())
    np.testing.assert_array_equal(result["B.s"], same["B.s"])


def test_no_point_of_a_flat_face_keeps_to_a_curve() -> None:
    cam = cut(SLIDE, 'value: "6 mm*(1 - cos(theta))"', TRANSLATING + "contact: flat}").cam("K")
    assert "K.curve.yaml" not in cam.files()
    with pytest.raises(UsageError, match="K: a flat face touches"):
        cam.curve()


def test_a_follower_that_rises_the_way_of_its_cam_is_named() -> None:
    """Both joints written from ground turn alike; from the follower's side it turns back."""
    value = 'value: "6 deg*(1 - cos(theta))"'
    against = cut(SWING, value, FOLLOWERS["swinging roller"]).cam("K")
    assert against.diagnostics == ()
    alike = SWING.replace("[follower, ground]", "[ground, follower]")
    told = mk.loads(
        HEAD.replace("GUIDE", alike)
        + "couplings:\n  K: {type: function, of: A.theta, gives: B.theta, "
        + f"{value}, follower: {FOLLOWERS['swinging roller']}}}\n"
    ).cam("K")
    assert [d.code for d in told.diagnostics] == ["follower-turns-alike"]
    assert "B.theta grows the way that A.theta turns the cam" in str(told.diagnostics[0])
