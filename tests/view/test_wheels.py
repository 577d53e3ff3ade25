"""Wheels, racks and belts of couplings: their teeth mesh in the drawing and as they move, and lines
have the lengths of closed forms."""

from __future__ import annotations

import re
from math import acos, pi, sqrt
from typing import Any

import numpy as np
import pytest
from references import FILE_OF
from view.contract import FORM
from view.seen import data

import mechkin_cli as mk
from mechkin_cli.templates import template_text
from mechkin_cli.view.cams import drawn_cams
from mechkin_cli.view.joints import carried, link_poses
from mechkin_cli.view.wheels import cable_line, wheel_outlines

PLANE = "format: 1\nplane: xy\nunits: {length: mm, angle: deg}\n"
SPACE = "format: 1\nunits: {length: mm, angle: deg}\n"
PAIR = """\
links: {one: {}, two: {}}
joints:
  A: {type: R, links: [ground, one], point: [7, -3]}
  B: {type: R, links: [two, ground], point: POINT}
couplings: {K: {type: gear, joints: [A, B], teeth: TEETH}}
motion: {inputs: {A.theta: {from: 0, to: 400, step: 23}}}
"""


def moved(model: mk.Model) -> list[tuple[Any, np.ndarray, np.ndarray]]:
    """Each wheel with its centre and the direction of its mark in each row (rows, 3)."""
    result = model.analyze().result
    wheels = model.view_settings.wheels
    names = ["ground", *result.problem.mechanism.links]
    poses = link_poses(result, names)
    found = []
    for wheel in wheels:
        own = poses[:, names.index(wheel.link)]
        centre = carried(own, wheel.on.o)
        tip = carried(own, np.array(wheel.on.o) + np.array(wheel.on.x))
        found.append((wheel, centre, tip - centre))
    return found


def about(mark: np.ndarray, line: np.ndarray) -> np.ndarray:
    """The angle from a line to a mark, in the plane z."""
    turn = np.arctan2(mark[:, 1], mark[:, 0]) - np.arctan2(line[:, 1], line[:, 0])
    return np.asarray(turn)


def misfit(phase: np.ndarray) -> float:
    """How far a phase, in turns of a tooth, is from a half."""
    return float(np.abs((phase % 1.0) - 0.5).max())


@pytest.mark.parametrize("point", ["[97, -3]", "[7, 60]", "[-40, -50]"])
@pytest.mark.parametrize("teeth", ["[20, 40]", "[17, 23]", "[31, 12]"])
def test_a_tooth_stands_in_a_gap(point: str, teeth: str) -> None:
    """At the pitch point one wheel is at a tooth by a share s of its pitch, the other, which counts
    the other way, at 1/2 - s."""
    text = PAIR.replace("POINT", point).replace("TEETH", teeth)
    (one, c1, m1), (two, c2, m2) = moved(mk.loads(PLANE + text))
    apart = c2 - c1
    assert np.linalg.norm(apart[0]) == pytest.approx(one.radius + two.radius)
    phase = one.teeth * about(m1, apart) + two.teeth * about(m2, -apart)
    assert misfit(phase / (2.0 * pi)) < 1e-9


def test_teeth_of_a_planetary_gear() -> None:
    """Of the sun and planet as above; of the ring, which counts the same way, s and 1/2 + s."""
    (sun, c1, m1), (planet, c2, m2), (ring, c3, m3) = moved(mk.loads(template_text("planetary")))
    assert (sun.link, planet.link, ring.link) == ("sun", "planet", "ground")
    assert (sun.inner, planet.inner, ring.inner) == (False, False, True)
    apart = c2 - c1
    phase = sun.teeth * about(m1, apart) + planet.teeth * about(m2, -apart)
    assert misfit(phase / (2.0 * pi)) < 1e-9
    phase = ring.teeth * about(m3, apart) - planet.teeth * about(m2, apart)
    assert misfit(phase / (2.0 * pi)) < 1e-9
    assert np.abs(c3).max() < 1e-12
    assert ring.radius == pytest.approx(0.0525)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("axis", ["[1, 0]", "[-3, 0]"])
def test_a_rack_meets_its_pinion(side: int, axis: str) -> None:
    """Along the pitch line the pinion's tooth is at r times its angle, the rack's half a pitch
    from it."""
    text = f"""{PLANE}links: {{one: {{}}, bar: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0]}}
  S: {{type: P, links: [bar, ground], point: [11, {-20 * side}], axis: {axis}}}
couplings: {{K: {{type: rack, joints: [A, S], radius: 20 mm}}}}
motion: {{inputs: {{A.theta: {{from: 0, to: 200, step: 23}}}}}}
"""
    model = mk.loads(text)
    (pinion, _, mark), (rack, place, out) = moved(model)
    down = np.array([[0.0, -1.0 * side, 0.0]])
    assert np.abs(out + down).max() < 1e-12
    assert np.abs(place[:, 1] + 0.02 * side).max() < 1e-12
    tooth = 0.02 * about(mark, down) * side
    assert misfit((place[:, 0] - tooth) / pinion.pitch) < 1e-9
    assert rack.pitch == pytest.approx(pinion.pitch)
    reach = data(model)["wheels"][1]["reach"]
    # the pinion's way on the rack, and its ends
    assert reach[1] - reach[0] == pytest.approx(20 * pi * 184 / 180 + 2 * 1.2 * 20)


@pytest.mark.parametrize("crossed", [False, True])
def test_a_belt_is_as_long_as_its_strands_and_arcs(crossed: bool) -> None:
    text = f"""{PLANE}links: {{one: {{}}, two: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [5, 5]}}
  B: {{type: R, links: [ground, two], point: [95, 125]}}
couplings:
  K: {{type: belt, joints: [A, B], radii: [20, 50], crossed: {str(crossed).lower()}}}
motion: {{inputs: {{A.theta: {{from: 0, to: 200, step: 50}}}}}}
"""
    model = mk.loads(text)
    (belt,) = model.view_settings.belts
    line = np.array([*belt.line, belt.line[0]]) * 1e3
    length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
    d, r, q = 150.0, 20.0, 50.0
    gap = r + q if crossed else q - r
    touch = acos(gap / d)
    arcs = (r + q) * 2 * (pi - touch) if crossed else r * 2 * touch + q * 2 * (pi - touch)
    assert length == pytest.approx(2 * sqrt(d * d - gap * gap) + arcs, rel=2e-3)
    assert [wheel.teeth for wheel in model.view_settings.wheels] == [0, 0]


def test_wheels_of_one_shaft_are_drawn_above_one_another() -> None:
    wheels = mk.loads(template_text("gearbox")).view_settings.wheels
    assert [wheel.link for wheel in wheels] == [
        "motor_shaft",
        "middle_shaft",
        "middle_shaft",
        "output_shaft",
    ]
    low, high = ({wheel.on.o[2] for wheel in part} for part in (wheels[:2], wheels[2:]))
    assert low == {0.0}
    assert min(high) > max(wheel.width for wheel in wheels)
    assert len(high) == 1


BEVEL = """links: {one: {}, two: {}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, two], point: [50, 0, 80], axis: [1, 0, 0]}
couplings: {K: {type: gear, joints: [A, B], teeth: [20, 40], radii: [30, 60]}}
motion: {inputs: {A.theta: {from: 0, to: 720, step: 90}}}
"""
WORM = """links: {worm: {}, wheel: {}}
joints:
  A: {type: R, links: [ground, worm], point: [9, 0, 0], axis: [1, 0, 0]}
  B: {type: R, links: [ground, wheel], point: [0, 2, -100], axis: [0, 1, 0]}
couplings: {K: {type: gear, joints: [A, B], teeth: [1, 40], radii: [20, 80], helix: atan(10)}}
motion: {inputs: {A.theta: {from: 0, to: 720, step: 90}}}
"""


def test_bevel_wheels_meet_where_their_cones_have_one_apex() -> None:
    """The apex is 80 above A; the wheels of 30 and 60 have it 60 and 30 from their planes."""
    one, two = mk.loads(SPACE + BEVEL).view_settings.wheels
    for wheel, radius, apex in ((one, 0.03, 0.06), (two, 0.06, 0.03)):
        assert wheel.radius == pytest.approx(radius)
        assert abs(wheel.apex) == pytest.approx(apex)
        peak = np.array(wheel.on.o) + wheel.apex * np.array(wheel.on.z)
        assert peak == pytest.approx([0.0, 0.0, 0.08])


def test_a_worm_leans_by_its_helix_and_its_wheel_by_the_lead() -> None:
    worm, wheel = mk.loads(SPACE + WORM).view_settings.wheels
    assert (worm.is_worm, wheel.is_worm) == (True, False)
    assert abs(worm.lean) == pytest.approx(10.0)
    assert abs(wheel.lean) == pytest.approx(0.1)
    # where they touch: between the axes, above the wheel's
    assert np.array(worm.on.o) == pytest.approx([0.0, 0.0, 0.0], abs=1e-15)
    assert np.array(wheel.on.o) == pytest.approx([0.0, 0.0, -0.1], abs=1e-15)


def test_outlines_have_the_teeth() -> None:
    """Each tooth reaches a module beyond the pitch circle, and five quarters inside."""
    (wheel, *_), _ = moved(
        mk.loads(PLANE + PAIR.replace("POINT", "[97, -3]").replace("TEETH", "[20, 40]"))
    )
    (line,) = wheel_outlines(wheel, True)
    radii = np.linalg.norm(line - np.array(wheel.on.o), axis=1)
    assert len(line) == 4 * 20
    assert radii.max() == pytest.approx(0.033)
    assert radii.min() == pytest.approx(0.03 - 0.00375)
    (circle,) = wheel_outlines(wheel, False)
    assert np.linalg.norm(circle - np.array(wheel.on.o), axis=1) == pytest.approx(0.03)


@pytest.mark.parametrize("name", ["gearbox", "planetary"])
def test_pages_have_the_wheels(name: str) -> None:
    model = mk.loads(template_text(name))
    shown = data(model, modes=False)
    assert len(shown["wheels"]) == len(model.view_settings.wheels)
    assert shown["belts"] == []


FOLLOWERS = {
    "roller": (
        "{type: P, links: [ground, arm], point: [0, 60], axis: [0, 1]}",
        "S.s",
        "8 mm*(1 - cos(A.theta))",
        "{type: translating, contact: roller, radius: 9, base_radius: 40, offset: 7}",
    ),
    "downward": (
        "{type: P, links: [arm, ground], point: [0, 60], axis: [1, 2]}",
        "S.s",
        "8 mm*(1 - cos(2*A.theta))",
        "{type: translating, contact: roller, radius: 9, base_radius: 40}",
    ),
    "oscillating": (
        "{type: R, links: [arm, ground], point: [60, 70]}",
        "S.theta",
        "0.1 rad*(1 - cos(A.theta))",
        "{type: oscillating, contact: roller, radius: 9, base_radius: 40, arm: 70, distance: D}",
    ),
}


@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_roller_lies_on_its_cam_in_every_row(name: str) -> None:
    """The disc's outline, moved with the cam, is a radius from the roller's centre, moved with the
    follower, and no nearer."""
    joint, gives, law, follower = FOLLOWERS[name]
    text = f"""{PLANE}parameters: {{D: sqrt((60 mm)^2 + (70 mm)^2)}}
links: {{disc: {{}}, arm: {{}}}}
joints:
  A: {{type: R, links: [ground, disc], point: [0, 0]}}
  S: {joint}
couplings:
  K: {{type: function, of: A.theta, gives: {gives}, value: "{law}", follower: {follower}}}
motion: {{inputs: {{A.theta: {{from: 0, to: 360, step: 30}}}}}}
"""
    result = mk.loads(text).analyze().result
    (cam,) = drawn_cams(result.problem.mechanism)
    roller = cam.roller
    assert roller is not None
    names = ["ground", *result.problem.mechanism.links]
    poses = link_poses(result, names)
    centres = carried(poses[:, names.index("arm")], roller.on.o)
    disc = poses[:, names.index("disc")]
    lines = np.stack([carried(disc, point) for point in cam.line], axis=1)
    apart = np.linalg.norm(lines - centres[:, None], axis=2).min(axis=1)
    assert apart == pytest.approx(0.009, abs=2e-5)


def test_cylinders_are_drawn_from_eye_to_eye() -> None:
    """As tubes a little wider than their bores; what they are made of is no joint of the page."""
    shown = data(mk.loads(template_text("excavator")), modes=False)
    ties = shown["runs"][0]["ties"]
    assert [tie["kind"] for tie in ties] == ["cylinder"] * 3
    assert [tie["links"] for tie in ties] == [[0, 1], [1, 2], [2, 3]]
    assert ties[0]["places"] == [pytest.approx([0.6, -0.6, 0.0]), pytest.approx([2.0, 1.6, 0.0])]
    assert [tie["radius"] for tie in ties] == pytest.approx([0.075, 0.066, 0.054])
    assert [joint["name"] for joint in shown["joints"]] == ["A", "B", "C"]


HOIST = """\
links: {block: {}, cart: {}}
joints:
  R: {type: P, links: [ground, block], point: [40, -90], axis: [0, 1]}
  C: {type: P, links: [ground, cart], point: [150, -60], axis: [0, 1]}
points:
  a: {link: ground, at: [0, 0]}
  b: {link: block, at: [20, -90]}
  d: {link: ground, at: [80, 0]}
  c: {link: cart, at: [150, -60]}
couplings:
  K:
    type: cable
    path: [a, {pulley: b, radius: 15, side: SIDE}, {pulley: d, radius: 25, side: OTHER}, c]
motion: {inputs: {C.s: {from: 0, to: 40, step: 10}}}
"""


@pytest.mark.parametrize(("side", "other"), [("right", "left"), ("left", "left")])
def test_a_cable_keeps_its_length_and_touches_its_pulleys(side: str, other: str) -> None:
    """Of an arc in chords of 7.5 degrees at the most, a share of 7e-4 is missing at the most."""
    text = PLANE + HOIST.replace("SIDE", side).replace("OTHER", other)
    model = mk.loads(text)
    result = model.analyze().result
    assert result.solved.all()
    (cable,) = model.view_settings.cables
    assert cable.beside == pytest.approx(
        [0.0, 0.015 if side == "left" else -0.015, 0.025 if other == "left" else -0.025, 0.0]
    )
    names = ["ground", *result.problem.mechanism.links]
    poses = link_poses(result, names)
    centres = np.stack(
        [carried(poses[:, names.index(at.link)], at.vector) for at in cable.places], axis=1
    )
    lengths = []
    for row in centres:
        line = cable_line(row, cable.beside, np.array(cable.axes), cable.swivels)
        assert line[[0, -1]] == pytest.approx(row[[0, -1]])
        chords = np.diff(line, axis=0)
        lengths.append(np.linalg.norm(chords, axis=1).sum())
        for centre, beside in zip(row[1:3], cable.beside[1:3], strict=True):
            # the stretches are tangents: how far their lines pass the centre, to the left
            across = np.cross(centre - line[:-1], chords)[:, 2] / np.linalg.norm(chords, axis=1)
            assert np.abs(across - beside).min() < 1e-12
            ends = np.linalg.norm(line - centre, axis=1)
            assert np.sum(np.abs(ends - abs(beside)) < 1e-12) >= 3
    assert np.ptp(lengths) < 7e-4 * 2.0 * pi * 0.04
    FORM.validate(data(model, modes=False))


@pytest.mark.parametrize("space", [False, True])
def test_a_belt_over_several_pulleys_touches_each(space: bool) -> None:
    """Each pulley is passed at its radius, and turns about its axis as the belt runs."""
    text = """\
links: {a: {}, b: {}, c: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [100, 0]}
  C: {type: R, links: [ground, c], point: [50, 20]}
couplings: {K: {type: belt, joints: [A, B, C], radii: [20, 15, 10], outside: [C], tensioner: C}}
motion: {inputs: {A.theta: {from: 0, to: 40, step: 10}}}
"""
    if space:
        text = SPACE + re.sub(
            r"point: \[(\d+), (\d+)\]", r"point: [\1, 0, \2], axis: [0, 1, 0]", text
        )
    model = mk.loads(text if space else PLANE + text)
    (belt,) = model.view_settings.belts
    wheels = model.view_settings.wheels
    line = np.array(belt.line)
    middles = line + 0.5 * (np.roll(line, -1, axis=0) - line)
    for wheel in wheels:
        ends, chords = (
            np.linalg.norm(each - np.array(wheel.on.o), axis=1) for each in (line, middles)
        )
        assert ends.min() == pytest.approx(wheel.radius)
        assert chords.min() > 0.99 * wheel.radius
    FORM.validate(data(model, modes=False))


ROBOT = """\
links: {cart: {}, body: {}, winch: {}}
joints:
  Y: {type: P, links: [ground, cart], point: [0, 0, 0], axis: [0, 1, 0]}
  Z: {type: P, links: [cart, body], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, winch], point: [90, 20, -70], axis: [0, 0, 1]}
points:
  a: {link: ground, at: [90, 20, 10]}
  b: {link: winch, at: [90, 20, -70]}
  p: {link: body, at: [-20, 5, -60]}
couplings: {K: {type: cable, path: PATH}}
motion: {inputs: {Y.s: {from: 0, to: 40, step: 10}, S.s: {from: 0, to: 20, step: 5, with: Y.s/2}}}
"""


@pytest.mark.parametrize("backwards", [False, True])
def test_a_pulley_that_swivels_is_drawn_in_the_plane_of_its_cable(backwards: bool) -> None:
    """Of an arc in chords of 7.5 degrees at the most, a share of 7e-4 is missing at the most."""
    places = ["b", "{pulley: a, radius: 15, swivel: [0, 0, 1]}", "p"]
    path = ", ".join(places[::-1] if backwards else places)
    text = SPACE + ROBOT.replace("PATH", f"[{path}]").replace("from: 0, to: 20, step: 5, ", "")
    model = mk.loads(text)
    result = model.analyze().result
    assert result.solved.all()
    (cable,) = model.view_settings.cables
    names = ["ground", *result.problem.mechanism.links]
    poses = link_poses(result, names)
    passed = np.stack(
        [carried(poses[:, names.index(at.link)], at.vector) for at in cable.places], axis=1
    )
    lengths = []
    for row in passed:
        line = cable_line(row, cable.beside, np.array(cable.axes), cable.swivels)
        lengths.append(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
        assert line[[0, -1]] == pytest.approx(row[[0, -1]])
        point = next(
            at for at, place in zip(row, cable.places, strict=True) if place.link == "body"
        )
        out = (point - row[1])[:2] / np.linalg.norm((point - row[1])[:2])
        centre = row[1] + 0.015 * np.append(out, 0.0)
        rim = line[1:-1]
        assert np.linalg.norm(rim - centre, axis=1) == pytest.approx(0.015)
        touch = rim[0] if backwards else rim[-1]
        assert abs((touch - centre) @ (point - touch)) < 1e-15
    assert np.ptp(lengths) < 7e-4 * pi * 0.015
    FORM.validate(data(model, modes=False))


def test_a_free_pulley_is_drawn_in_the_plane_of_its_cable() -> None:
    """Of an arc in chords of 7.5 degrees at the most, a share of 7e-4 is missing at the most."""
    text = (
        SPACE
        + """\
links: {cart: {}, car: {}}
joints:
  Y: {type: P, links: [ground, cart], point: [0, 0, 0], axis: [1, 2, 0]}
  Z: {type: P, links: [cart, car], point: [0, 0, 0], axis: [0, 0, 1]}
points:
  a: {link: ground, at: [0, 0, 0]}
  b: {link: ground, at: [90, 20, 10]}
  c: {link: car, at: [30, 5, -60]}
couplings: {K: {type: cable, path: [a, {pulley: c, radius: 15, free: true}, b]}}
motion: {inputs: {Y.s: {from: 0, to: 40, step: 10}}}
"""
    )
    model = mk.loads(text)
    result = model.analyze().result
    assert result.solved.all()
    (cable,) = model.view_settings.cables
    names = ["ground", *result.problem.mechanism.links]
    poses = link_poses(result, names)
    passed = np.stack(
        [carried(poses[:, names.index(at.link)], at.vector) for at in cable.places], axis=1
    )
    lengths = []
    for row in passed:
        line = cable_line(row, cable.beside, np.array(cable.axes), cable.swivels)
        lengths.append(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
        assert np.linalg.norm(line[1:-1] - row[1], axis=1) == pytest.approx(0.015)
        for end, touch in ((row[0], line[1]), (row[2], line[-2])):
            assert abs((touch - row[1]) @ (end - touch)) < 1e-15
    assert np.ptp(lengths) < 7e-4 * pi * 0.015
    FORM.validate(data(model, modes=False))


def test_a_tackle_passes_its_points_in_turn() -> None:
    """From a to b and back, 4 by 3 m, then 1 m to the cart."""
    text = (
        PLANE.replace("mm", "m")
        + """\
links: {block: {}, cart: {}}
joints:
  G: {type: P, links: [ground, block], point: [0, -3], axis: [0, 1]}
  C: {type: P, links: [ground, cart], point: [1, 0], axis: [1, 0]}
points: {a: {link: ground, at: [0, 0]}, b: {link: block, at: [0, -3]}, c: {link: cart, at: [1, 0]}}
couplings: {K: {type: cable, path: [a, b, a, b, a, c]}}
motion: {inputs: {C.s: {from: 0, to: 1, step: 1}}}
"""
    )
    model = mk.loads(text)
    shown = data(model, modes=False)
    assert shown["cables"] == [
        {
            "links": [0, 1, 0, 1, 0, 2],
            "places": [[0, 0, 0], [0, -3, 0], [0, 0, 0], [0, -3, 0], [0, 0, 0], [1, 0, 0]],
            "beside": [0.0] * 6,
            "axes": [[0, 0, 1]] * 6,
            "swivels": [0] * 6,
        }
    ]
    (cable,) = model.view_settings.cables
    places = np.array([at.vector for at in cable.places])
    line = cable_line(places, cable.beside, np.array(cable.axes), cable.swivels)
    assert np.linalg.norm(np.diff(line, axis=0), axis=1) == pytest.approx([3, 3, 3, 3, 1])


@pytest.mark.parametrize("nut", ["ground, nut", "nut, ground"])
def test_a_spindle_reaches_from_its_bearing_past_its_nut(nut: str) -> None:
    """A left-hand thread of 8 mm: ten turns move the nut by 80 mm, away from a bearing at -30."""
    text = (
        SPACE
        + f"""\
links: {{spindle: {{}}, nut: {{}}}}
joints:
  A: {{type: R, links: [ground, spindle], point: [0, 0, 0], axis: [1, 0, 0]}}
  S: {{type: P, links: [{nut}], point: [30, 5, 0], axis: [1, 0, 0]}}
couplings: {{K: {{type: screw, joints: [A, S], lead: -8 mm}}}}
motion: {{inputs: {{A.theta: {{from: 0, to: 3600, step: 360}}}}}}
"""
    )
    shown = data(mk.loads(text), modes=False)
    FORM.validate(shown)
    names = [link["name"] for link in shown["links"]]
    (screw,) = shown["screws"]
    assert (names[screw["link"]], names[screw["nut"]["link"]]) == ("spindle", "nut")
    assert screw["lead"] == pytest.approx(-8.0)
    assert screw["reach"] == pytest.approx([-30.0, 80.0])
    for drawn in (screw, screw["nut"]):
        assert drawn["centre"] == pytest.approx([30.0, 0.0, 0.0])
        assert drawn["axis"] == pytest.approx([1.0, 0.0, 0.0])


def test_stops_and_strokes_are_where_limits_are() -> None:
    """Angles in rad, lengths in the file's unit, of one angle and one slide."""
    text = (
        PLANE
        + """\
links: {crank: {}, rod: {}, slider: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [40, 0]}
  C: {type: R, links: [rod, slider], point: [140, 0]}
  S: {type: P, links: [ground, slider], point: [140, 0], axis: [1, 0]}
motion: {inputs: {A.theta: {from: -10, to: 100, step: 10}}}
limits: {A.theta: [-30, 120], S.s: {max: 5}}
"""
    )
    shown = data(mk.loads(text), modes=False)
    FORM.validate(shown)
    stops = [joint["stops"] for joint in shown["joints"]]
    assert stops[0]["turn"] == pytest.approx([-pi / 6.0, 2.0 * pi / 3.0])
    assert stops[1] == stops[2] == {"turn": None, "slide": None}
    assert stops[3]["slide"][0] is None
    assert stops[3]["slide"][1] == pytest.approx(5.0)
    boom = data(mk.load(FILE_OF["cylinder_boom"]), modes=False)
    (tie,) = boom["runs"][0]["ties"]
    assert tie["stroke"] == pytest.approx([480.0, 720.0])
