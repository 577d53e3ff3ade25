"""Small pictures of mechanisms: projection, symbols, what stands where, the same bytes."""

from __future__ import annotations

import re
from math import cos, radians, sin, sqrt
from xml.etree import ElementTree

import numpy as np
import pytest
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.mechanism.pairs import JOINT_TYPES, PLANE_JOINT_TYPES
from mechkin_cli.view.drawing import (
    HEIGHT,
    WIDTH,
    Isometric,
    isometric,
    mechanism_picture,
)
from mechkin_cli.view.symbols import Disc, Half, Stroke, slide_stops, symbol, turn_stops
from mechkin_cli.view.wheels import (
    facing_teeth,
    facing_threads,
    is_solid,
    runs_of,
    toothed_faces,
)

FOUR_BAR = """\
format: 1
links: {crank: {}, rod: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [0.4, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, rocker], point: [1, 0.8, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [1, 0, 0], axis: [0, 0, 1]}
points: {tip: {link: rod, at: [0.8, 0.9, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10}}}
"""


def drawn(text: str) -> str:
    analysis = mk.loads(text).analyze(tables=[])
    return mechanism_picture(analysis.result, analysis.model.view_settings)


def test_the_three_axes_are_seen_alike():
    """Each shortened by sqrt(2/3), 120 degrees apart, the upright one upwards."""
    for up in range(3):
        for down in (False, True):
            seen = Isometric(up, down).seen(np.eye(3))
            np.testing.assert_allclose(np.hypot(*seen.T[:2]), sqrt(2 / 3), rtol=1e-15)
            np.testing.assert_allclose(seen @ seen.T, np.eye(3), atol=1e-15)
            upright = seen[up] * (-1 if down else 1)
            np.testing.assert_allclose(upright[:2], [0.0, sqrt(2 / 3)], atol=1e-15)
            assert np.linalg.det(seen) == pytest.approx(1.0)


def test_up_is_against_gravity_else_of_the_plane():
    assert isometric(mk.loads(FOUR_BAR).problem.mechanism) == Isometric(1)
    heavy = FOUR_BAR + "loads: [{type: gravity, g: [9.81, 0, 0]}]\n"
    assert isometric(mk.loads(heavy).problem.mechanism) == Isometric(0, True)
    assert isometric(mk.load(RCSR).problem.mechanism) == Isometric(2)


def test_a_picture_is_svg_of_one_size_with_one_decimal_inside_its_frame():
    for path in list(FILE_OF.values()):
        text = (path.with_suffix("") / "picture.svg").read_text(encoding="utf-8")
        root = ElementTree.fromstring(text)
        assert root.get("viewBox") == f"0 0 {WIDTH:.0f} {HEIGHT:.0f}"
        places = []
        for element in root.iter():
            numbers = re.findall(r"-?\d+(?:\.\d+)?", element.get("d", ""))
            places += list(zip(numbers[::2], numbers[1::2], strict=True))
            if element.get("cx") is not None:
                places.append((element.get("cx"), element.get("cy")))
        assert places, path
        assert all(re.fullmatch(r"-?\d+\.\d", number) for place in places for number in place)
        assert "-0.0" not in text
        middle = np.array(places, dtype=float)
        assert (middle >= -20.0).all(), path
        assert (middle <= [WIDTH + 20.0, HEIGHT + 20.0]).all(), path


def test_links_end_where_the_closed_form_has_them():
    """The crank at 0 degrees, drawn upright: right is x/sqrt(2), up (2y - x)/sqrt(6)."""
    text = FOUR_BAR.replace("points: {tip: {link: rod, at: [0.8, 0.9, 0]}}\n", "")
    root = ElementTree.fromstring(drawn(text))
    rods = [e for e in root.iter() if e.get("stroke-width") == "3.2"]
    ends = [[float(n) for n in re.findall(r"-?\d+\.\d", rod.get("d", ""))] for rod in rods]
    pins = np.array([[0, 0], [0.4, 0], [1, 0.8], [1, 0]])
    seen = np.stack([pins[:, 0] / sqrt(2), (2 * pins[:, 1] - pins[:, 0]) / sqrt(6)], axis=1)
    # one scale and one shift take them to the picture, y downwards
    lines = {(0, 1), (1, 2), (2, 3)}
    span = np.ptp(seen, axis=0)
    scale = min((WIDTH - 48) / span[0], (HEIGHT - 48) / span[1])
    middle = (seen.max(axis=0) + seen.min(axis=0)) / 2
    places = (seen - middle) * [scale, -scale] + [WIDTH / 2, HEIGHT / 2 - 4]
    expected = {tuple(np.round(sorted(places[list(pair)].tolist()), 1).ravel()) for pair in lines}
    assert {tuple(np.round(end, 1)) for end in ends} == expected


def corners(text: str, width: str) -> np.ndarray:
    """Of the closed lines of a width, in the picture."""
    root = ElementTree.fromstring(drawn(text))
    found = [e.get("d") for e in root.iter() if e.get("stroke-width") == width]
    numbers = [re.findall(r"-?\d+\.\d", d) for d in found if d.endswith("Z")]
    return np.array(numbers, dtype=float).reshape(-1, 2)


def test_a_thin_wheel_is_the_ellipse_that_a_circle_is_seen_as():
    """Its diameter is not shortened; its axis, seen under 54.7 degrees, shortens it across by the
    square root of 3."""
    text = FOUR_BAR.replace("points: {tip: {link: rod, at: [0.8, 0.9, 0]}}\n", "")
    text += "view: {shapes: {crank: {kind: wheel, radius: 0.4, width: 1e-6}}}\n"
    rim = corners(text, "2.4")
    x, y = (rim - rim.mean(axis=0)).T
    # the conic a x^2 + 2 b xy + c y^2 + d x + e y = 1 through its corners
    (a, b, c, *_), *_ = np.linalg.lstsq(
        np.stack([x * x, 2 * x * y, y * y, x, y], axis=1), np.ones(len(rim)), rcond=None
    )
    low, high = np.linalg.eigvalsh([[a, b], [b, c]])
    assert sqrt(high / low) == pytest.approx(sqrt(3.0), rel=0.01)


def test_a_cylinder_is_as_thick_as_it_is_to_scale():
    """An oblong from A to B of the crank: 0.4 long, 0.1 thick, its length seen as sqrt(2/3)."""
    text = FOUR_BAR + "view: {shapes: {crank: {kind: cylinder, radius: 0.05}}}\n"
    a, b, c, d = corners(text, "1.6")
    assert a - b == pytest.approx(d - c, abs=0.11)
    long, thick = np.hypot(*(b - a)), np.hypot(*(c - b))
    assert long / thick == pytest.approx(0.4 * sqrt(2 / 3) / 0.1, rel=0.03)


def test_hidden_links_are_not_in_the_picture():
    assert drawn(FOUR_BAR).count('class="l0"') == 1
    assert 'class="l0"' not in drawn(FOUR_BAR + "view: {hidden: [crank]}\n")


@pytest.mark.parametrize("letter", sorted(JOINT_TYPES))
def test_every_joint_has_a_symbol_of_its_own(letter):
    kind = JOINT_TYPES[letter]
    if not kind.has_point or kind.is_free:
        return
    half = Half((50.0, 50.0), (0.6, 0.5), (0.7, -0.2), (0.1, -0.8))
    moved = half._replace(place=(56.0, 55.0))
    marks = symbol(kind, half, moved)
    assert marks
    assert all(isinstance(mark, Stroke | Disc) for mark in marks)
    others = [
        symbol(other, half, moved)
        for name, other in JOINT_TYPES.items()
        if name != letter and other.has_point and not other.is_free
    ]
    same = [other for other in others if other == marks]
    # a slotted sphere is a universal joint in another shape
    assert len(same) == (1 if letter in ("U", "Ss") else 0)


def test_a_pin_seen_end_on_is_a_disc():
    end_on = Half((0.0, 0.0), (0.01, 0.0), (1.0, 0.0), (0.0, 1.0))
    assert all(isinstance(mark, Disc) for mark in symbol(JOINT_TYPES["R"], end_on, end_on))


def test_a_pin_in_a_slot_stands_between_two_walls():
    half = Half((50.0, 50.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    pin = half._replace(place=(56.0, 50.0), axis=(0.0, 0.0))
    one, other, *_ = symbol(PLANE_JOINT_TYPES["Ps"], pin, half)
    # along the slot, twelve points beyond its own place and the pin
    assert one.places == ((38.0, 42.5), (68.0, 42.5))
    assert other.places == ((38.0, 57.5), (68.0, 57.5))


def test_size_place_units_names_and_order_change_nothing():
    plain = drawn(FOUR_BAR)
    larger = FOUR_BAR.replace("format: 1\n", "format: 1\nunits: {length: km}\n")
    assert drawn(larger) == plain
    renamed = re.sub(r"\b([ABCD])\b", r"J\1", FOUR_BAR).replace("rocker", "swing")
    assert drawn(renamed) == plain
    shift = {"[0, 0, 0]": "[3, 1, 0]", "[0.4, 0, 0]": "[3.4, 1, 0]", "[1, 0.8, 0]": "[4, 1.8, 0]"}
    shift |= {"[1, 0, 0]": "[4, 1, 0]", "[0.8, 0.9, 0]": "[3.8, 1.9, 0]"}
    moved = re.sub(r"\[[\d.]+, [\d.]+, 0\]", lambda at: shift.get(at[0], at[0]), FOUR_BAR)
    assert moved != FOUR_BAR
    assert drawn(moved) == plain


def test_the_way_of_a_point_is_drawn_over_all_rows():
    root = ElementTree.fromstring(drawn(FOUR_BAR))
    (way,) = (e for e in root.iter() if "t" in e.get("class", "").split())
    assert way.get("d", "").count("L") == 36


def test_a_single_position_and_one_without_solution_are_drawn():
    assert "<path" in drawn(FOUR_BAR.replace("from: 0, to: 360, step: 10", "at: 0"))
    lost = FOUR_BAR.replace("point: [1, 0.8, 0]", "point: {rod: [0.5, 0, 0], rocker: [9, 9, 0]}")
    analysis = mk.loads(lost).analyze(tables=[])
    assert not analysis.result.solved.any()
    assert "<path" in mechanism_picture(analysis.result)


def test_a_turned_input_turns_the_crank():
    """At 90 degrees the crank's end stands at y = 0.4."""

    def crank_end(angle: float) -> tuple[float, float]:
        text = "format: 1\nlinks: {arm: {}}\njoints: {A: {type: R, links: [ground, arm], point: "
        text += "[0, 0, 0], axis: [0, 0, 1]}}\npoints: {tip: {link: arm, at: [0.4, 0, 0]}}\n"
        found = drawn(text + f"motion: {{inputs: {{A.theta: {{at: {angle}}}}}}}\n")
        rod = next(
            e for e in ElementTree.fromstring(found).iter() if e.get("stroke-width") == "3.2"
        )
        a, b, c, d = (float(n) for n in re.findall(r"-?\d+\.\d", rod.get("d", "")))
        return c - a, b - d

    for angle in (10.0, 60.0):
        x, y = cos(radians(angle)), sin(radians(angle))
        right, up = crank_end(angle)
        assert up / right == pytest.approx((2 * y - x) / sqrt(6) / (x / sqrt(2)), abs=0.01)


@pytest.mark.parametrize("lead", [0.3, -0.3, 2.0, 40.0])
@pytest.mark.parametrize("starts", [1, 3])
def test_threads_are_helices_as_far_as_they_face_the_eye(lead: float, starts: int):
    """z = lead (turn/2 pi - start/starts) on a radius of .2, between -1 and 1.5; its z is aslant to
    the eye, x square to it."""
    axes = np.array([[1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.0, -0.8, 0.6]])
    origin = np.array([3.0, -2.0, 0.5])
    lines = facing_threads(origin, axes, 0.2, lead, starts, (-1.0, 1.5))
    assert len(lines) >= abs(2.5 / lead) * starts - 2
    for places in lines:
        x, y, z = axes @ (places - origin).T
        np.testing.assert_allclose(np.hypot(x, y), 0.2, rtol=1e-12)
        off = starts * (z / lead - np.arctan2(y, x) / (2.0 * np.pi))
        np.testing.assert_allclose((off + 0.5) % 1.0, 0.5, atol=1e-9)
        assert (0.8 * y > -1e-12).all()
        assert -1.0 - 1e-12 < z.min() < z.max() < 1.5 + 1e-12


def test_teeth_run_on_cones_and_helices():
    bevel = mk.load(FILE_OF["bevel_differential"]).view_settings.wheels[0]
    helical = mk.load(FILE_OF["worm_gear"]).view_settings.wheels[1]
    for wheel in (bevel, helical):
        assert is_solid(wheel)
        on = np.array([wheel.on.x, wheel.on.y, wheel.on.z])
        faces = [(face - np.array(wheel.on.o)) @ on.T for face in toothed_faces(wheel)]
        low, high = (face.reshape(-1, 4, 3) for face in faces)
        heights = [-wheel.width / 2.0, wheel.width / 2.0]
        np.testing.assert_allclose([low[:, :, 2].mean(), high[:, :, 2].mean()], heights)
        sizes = [np.hypot(*face[0, 1, :2]) for face in (low, high)]
        turns = [np.arctan2(face[0, 1, 1], face[0, 1, 0]) for face in (low, high)]
        if wheel.apex:
            ratio = (wheel.apex - heights[1]) / (wheel.apex - heights[0])
            assert sizes[1] / sizes[0] == pytest.approx(ratio)
        else:
            assert sizes[1] == pytest.approx(sizes[0])
        turned = wheel.lean * wheel.width / wheel.radius
        assert turns[1] - turns[0] == pytest.approx(turned, abs=1e-12)


def test_half_the_teeth_of_a_cylinder_face_the_eye_and_all_of_a_flat_cone():
    wheel = mk.load(FILE_OF["worm_gear"]).view_settings.wheels[1]
    beside = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    facing = facing_teeth(wheel, beside)
    turns = 2.0 * np.pi * np.arange(wheel.teeth) / wheel.teeth
    clear = np.abs(np.cos(turns)) > 1e-9
    np.testing.assert_array_equal(facing[clear], (np.cos(turns) > 0.0)[clear])
    (run,) = runs_of(facing)
    assert (np.diff(run) % wheel.teeth == 1).all()
    assert sorted(run) == list(np.flatnonzero(facing))
    cone = wheel._replace(apex=0.5 * wheel.radius, lean=0.0)
    assert facing_teeth(cone, np.eye(3)).all()
    assert not facing_teeth(cone._replace(apex=-cone.apex), np.eye(3)).any()
    assert runs_of(np.zeros(5, dtype=bool)) == []


RAIL_HALF = Half((50.0, 60.0), (0.8, -0.4), (0.4, 0.8), (0.0, 0.0))


def test_stops_of_a_slide_are_where_its_block_touches():
    """A block of 7 to both sides, along an axis that is shortened to sqrt(.8)."""
    for ends in ((-30.0, 40.0), (None, 40.0), (-30.0, None)):
        marks = slide_stops(RAIL_HALF, RAIL_HALF, ends)
        across = [mark for mark in marks if isinstance(mark, Stroke)][1::2]
        middles = [np.mean(mark.places, axis=0) for mark in across]
        wanted = [(end, side) for end, side in zip(ends, (-1, 1), strict=True) if end is not None]
        for middle, (end, side) in zip(middles, wanted, strict=True):
            way = ((middle - [50.0, 60.0]) @ [0.8, -0.4]) / 0.8
            assert way == pytest.approx(end + side * 8.5)
    assert slide_stops(RAIL_HALF._replace(axis=(0.1, 0.0)), RAIL_HALF, (0.0, 1.0)) == []


def test_stops_of_a_turn_end_its_arc():
    half = Half((50.0, 60.0), (0.0, 0.0), (1.0, 0.0), (0.0, -1.0))
    arc, *ends = turn_stops(half, half, (-0.5, 2.0))
    assert isinstance(arc, Stroke)
    out = np.array(arc.places) - [50.0, 60.0]
    np.testing.assert_allclose(np.hypot(*out.T), 16.0)
    np.testing.assert_allclose(np.arctan2(-out[[0, -1], 1], out[[0, -1], 0]), [-0.5, 2.0])
    assert len(ends) == 2
    assert len(turn_stops(half, half, (None, 2.0))) == 2
    assert turn_stops(half, half, (-4.0, 4.0)) == []


LIMITED = FOUR_BAR + "limits: {A.theta: [-1 rad, 380 deg], D.theta: [-60 deg, 60 deg]}\n"


def test_stops_are_drawn_at_limits_alone():
    """An arc and two ends; a range of more than a turn has none."""
    assert drawn(LIMITED).count("<path") == drawn(FOUR_BAR).count("<path") + 3
