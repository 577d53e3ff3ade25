"""Curved grooves, slots and surfaces in pages and pictures: along their own formulas, and the pin
or ball on them in every row."""

from __future__ import annotations

import numpy as np
import pytest
from view.contract import FORM
from view.seen import data

import mechkin_cli as mk
from mechkin_cli.view.drawing import mechanism_picture
from mechkin_cli.view.joints import carried, link_poses
from mechkin_cli.view.tracks import drawn_track

SLOT = """\
format: 1
plane: xy
units: {length: mm, angle: deg}
links: {crank: {}, coupler: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, coupler], point: [0, 20]}
  D: {type: Ps, links: [coupler, ground], point: [60, 45], curve: CURVE}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 30}}}
"""
GROOVE = """\
format: 1
units: {length: mm, angle: deg}
links: {drum: {}, follower: {}}
joints:
  A: {type: R, links: [ground, drum], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, follower], point: [40, 0, 0], axis: [0, 0, 1]}
  D:
    type: Sg
    links: [follower, drum]
    point: [30, 0, 0]
    curve: {at: [30 mm*cos(u), 30 mm*sin(u), 9 mm*sin(2*u)], from: 0 deg, to: 360 deg, closed: true}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10}}}
"""
BALL = """\
format: 1
units: {length: mm, angle: deg}
links: {disc: {}, piston: {}}
joints:
  A: {type: R, links: [ground, disc], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, piston], point: POINT, axis: [1, 0, 0]}
  D: {type: Sp, links: [piston, disc], point: POINT, surface: SURFACE}
motion: {inputs: {A.theta: {from: 0, to: 30, step: 10}}}
"""


def nearest(text: str) -> np.ndarray:
    """In each row the distance (m) of the joint D's point from what is drawn of its curve."""
    result = mk.loads(text).analyze().result
    mechanism = result.problem.mechanism
    joint = mechanism.joints["D"]
    track = drawn_track(joint)
    assert track is not None
    names = ["ground", *mechanism.links]
    poses = link_poses(result, names)
    pins = carried(poses[:, names.index(joint.first)], joint.on_first.o)
    own = poses[:, names.index(track.link)]
    places = np.stack([carried(own, tuple(place)) for place in track.line], axis=1)
    found: np.ndarray = np.linalg.norm(places - pins[:, None], axis=2).min(axis=1)
    return found


def test_a_round_slot_is_drawn_as_its_circle() -> None:
    """About (90, 0) through (60, 45)."""
    model = mk.loads(SLOT.replace("CURVE", "{center: [90, 0]}"))
    track = drawn_track(model.problem.mechanism.joints["D"])
    assert track is not None
    assert track.closed
    radii = np.linalg.norm(track.line - [0.09, 0.0, 0.0], axis=1)
    assert radii == pytest.approx(np.hypot(0.03, 0.045), rel=1e-12)
    # half a step of 96 along the circle at the most
    assert nearest(SLOT.replace("CURVE", "{center: [90, 0]}")).max() < 0.0541 * np.pi / 96.0


def test_an_arc_ends_where_it_does() -> None:
    model = mk.loads(SLOT.replace("CURVE", "{arc: [[60, -45], [40, 0], [60, 45]]}"))
    track = drawn_track(model.problem.mechanism.joints["D"])
    assert track is not None
    assert not track.closed
    assert track.line[[0, -1]] == pytest.approx(
        np.array([[0.06, -0.045, 0.0], [0.06, 0.045, 0.0]]), abs=1e-12
    )


def test_a_groove_on_a_drum_turns_with_it() -> None:
    assert nearest(GROOVE).max() < 0.035 * np.pi / 96.0
    # drawn where it stands: x = 30 cos(u), y = 30 sin(u), z = 9 sin(2 u)
    track = drawn_track(mk.loads(GROOVE).problem.mechanism.joints["D"])
    assert track is not None
    x, y, z = track.line.T
    assert np.hypot(x, y) == pytest.approx(0.03, rel=1e-12)
    assert z == pytest.approx(0.018 * x * y / 0.03**2, abs=1e-12)


@pytest.mark.parametrize(
    ("surface", "formula"),
    [
        ("{sphere: [0, 5, 0], radius: 30}", lambda x, y, z: (x * x + (y - 5) ** 2 + z * z, 900.0)),
        ("{cylinder: [0, 5, 0], radius: 30}", lambda x, y, z: (x * x + (y - 5) ** 2, 900.0)),
        (
            "{torus: [0, 5, 0], radius: 22, tube: 8}",
            lambda x, y, z: ((np.hypot(x, y - 5) - 22) ** 2 + z * z, 64.0),
        ),
    ],
)
def test_surfaces_are_drawn_on_their_equations(surface, formula) -> None:
    point = f"[{np.sqrt(900.0 - 25.0)!r}, 0, 0]".replace("np.float64(", "").replace(")", "")
    text = BALL.replace("POINT", point).replace("SURFACE", surface)
    track = drawn_track(mk.loads(text).problem.mechanism.joints["D"])
    assert track is not None
    assert track.is_surface
    left, right = formula(*(1e3 * track.line.T))
    assert left == pytest.approx(right, rel=1e-10)
    # what has no end is drawn about the ball, not far beyond
    assert np.abs(track.line).max() < 0.2


@pytest.mark.parametrize("text", [SLOT.replace("CURVE", "{center: [90, 0]}"), GROOVE])
def test_pictures_have_the_curve_between_two_walls(text: str) -> None:
    """One wide line of ink, and a narrower one of paper, through all places of it."""
    analysis = mk.loads(text).analyze(tables=[])
    svg = mechanism_picture(analysis.result, analysis.model.view_settings).splitlines()
    wide = [line for line in svg if 'stroke-width="13.0"' in line]
    (inside,) = [line for line in svg if 'class="p" stroke-width="10.6"' in line]
    assert len(wide) == 1
    assert wide[0].count("L") == inside.count("L") == 95


def test_pages_have_places_of_curves_and_surfaces() -> None:
    """On the joint's second link; straight grooves have none."""
    slot = data(mk.loads(SLOT.replace("CURVE", "{center: [90, 0]}")), modes=False)
    FORM.validate(slot)
    tracks = {joint["name"]: joint["track"] for joint in slot["joints"]}
    assert tracks["A"] is tracks["B"] is None
    (row,) = tracks["D"]["rows"]
    assert tracks["D"]["closed"]
    assert np.hypot(*(np.array(row)[:, :2] - [90.0, 0.0]).T) == pytest.approx(np.hypot(30.0, 45.0))
    straight = data(mk.loads(SLOT.replace("curve: CURVE", "slot: [0, 1]")), modes=False)
    assert [joint["track"] for joint in straight["joints"]] == [None] * 3
    text = BALL.replace("POINT", "[30, 0, 0]").replace("SURFACE", "{sphere: [0, 0, 0], radius: 30}")
    ball = data(mk.loads(text), modes=False)
    FORM.validate(ball)
    (track,) = (joint["track"] for joint in ball["joints"] if joint["name"] == "D")
    assert np.linalg.norm(np.array(track["rows"]), axis=2) == pytest.approx(30.0)
