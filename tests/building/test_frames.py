"""Home drawing: where points stand at a coordinate, against poses worked out by hand."""

import pytest
from mpmath import mp

import mechkin_cli as mk

ARM = """\
format: 1
units: {length: in, angle: deg}
links: {arm: {}}
joints: {J: JOINT}
points: {p: {link: arm, at: [1, 2, 3]}}
motion: {inputs: INPUT}
"""
TURN = "{J.theta: {values: [0, 90]}}"


def places(joint: str, motion: str = TURN) -> list[list[float]]:
    """Where the point drawn at (1, 2, 3) goes, row by row."""
    text = ARM.replace("JOINT", joint).replace("INPUT", motion)
    found = mk.loads(text).analyze()["p.position"]
    return [[float(x) for x in row] for row in found]


def near(rows: list[list[float]]) -> list[object]:
    return [pytest.approx(row, abs=1e-14) for row in rows]


def test_one_axis_turns_the_drawing_about_it() -> None:
    found = places("{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 7]}")
    assert found == near([[1, 2, 3], [-2, 1, 3]])


def test_the_second_link_moves_against_the_first() -> None:
    found = places("{type: R, links: [arm, ground], point: [0, 0, 0], axis: [0, 0, 1]}")
    assert found == near([[1, 2, 3], [2, -1, 3]])


def test_the_axis_stands_in_the_point() -> None:
    found = places("{type: R, links: [ground, arm], point: [1, 0, 9], axis: [0, 0, 1]}")
    assert found == near([[1, 2, 3], [-1, 0, 3]])


def test_a_point_per_link_brings_the_second_to_the_first() -> None:
    points = "{ground: [10, 0, 0], arm: [1, 0, 0]}"
    found = places(f"{{type: R, links: [ground, arm], point: {points}, axis: [0, 0, 1]}}")
    assert found == near([[10, 2, 3], [8, 0, 3]])


AXES = "axis: {ground: [0, 0, 1], arm: [1, 0, 0]}"


def test_an_axis_per_link_comes_into_line_by_the_shortest_turn() -> None:
    # x of the arm onto z of the ground: a quarter turn about -y, so z goes to -x
    found = places(f"{{type: R, links: [ground, arm], point: [0, 0, 0], {AXES}}}")
    assert found == near([[-3, 2, 1], [-2, -3, 1]])


def test_opposite_axes_come_into_line_by_half_a_turn() -> None:
    axes = "axis: {ground: [0, 0, 1], arm: [0, 0, -1]}"
    (found,) = places(
        f"{{type: R, links: [ground, arm], point: [0, 0, 0], {axes}}}", "{J.theta: {at: 0}}"
    )
    assert found[2] == pytest.approx(-3)
    assert found[0] ** 2 + found[1] ** 2 == pytest.approx(5)


@pytest.mark.parametrize("direction", ["[0, 1, 0]", "[0, 2, 0]", "[5, 1, 0]"])
def test_zero_says_which_directions_are_in_line(direction: str) -> None:
    # x of the arm onto z, y onto x (seen along the axis), hence z onto y
    zero = f"zero: {{ground: [1, 0, 0], arm: {direction}}}"
    found = places(f"{{type: R, links: [ground, arm], point: [0, 0, 0], {AXES}, {zero}}}")
    assert found == near([[2, 3, 1], [-3, 2, 1]])


def test_a_slide_goes_along_the_unit_vector_of_the_axis() -> None:
    joint = "{type: P, links: [ground, arm], point: [0, 0, 0], axis: [3, 0, 4]}"
    found = places(joint, "{J.s: {values: [0, 10, 2.54 cm]}}")
    assert found == near([[1, 2, 3], [7, 2, 11], [1.6, 2, 3.8]])


def test_a_helical_joint_slides_its_lead_in_a_turn() -> None:
    joint = "{type: H, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1], lead: 8}"
    assert places(joint) == near([[1, 2, 3], [-2, 1, 5]])
    assert places(joint, "{J.s: {values: [0, 2]}}") == near([[1, 2, 3], [-2, 1, 5]])


def test_a_cylindric_joint_turns_and_slides() -> None:
    joint = "{type: C, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}"
    found = places(joint, "{J.theta: {at: 90}, J.s: {at: -1}}")
    assert found == near([[-2, 1, 2]])


@pytest.mark.parametrize(
    ("axes", "expected"),
    [
        ("", (1, 2, 3, 0.1, 0.2, 0.3)),
        # z of the axes is x of the ground, x is y, y is z
        (", axes: {x: [0, 1, 0], y: [0, 0, 5]}", (3, 1, 2, 0.2, 0.3, 0.1)),
        # xx reversed with y and z: the products with x change sign
        (", axes: {x: [-1, 0, 0], y: [0, 1, 0]}", (1, 2, 3, -0.1, 0.2, -0.3)),
    ],
)
def test_tensor_entries_stand_in_their_axes(axes: str, expected: tuple[float, ...]) -> None:
    tensor = f"{{xx: 1, yy: 2, zz: 3, xy: .1, xz: .2, yz: .3{axes}}}"
    joint = "{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}"
    text = ARM.replace("JOINT", joint).replace("INPUT", TURN).replace("{length: in", "{length: m")
    model = mk.loads(text.replace("{arm: {}}", f"{{arm: {{inertia: {tensor}}}}}"))
    assert model.problem.mechanism.links["arm"].inertia == pytest.approx(expected, abs=1e-15)


def test_a_tensor_in_turned_axes() -> None:
    # 25 a a' + 50 b b' for a = (3, 4, 0)/5, b = (-4, 3, 0)/5
    tensor = "{xx: 25, yy: 50, zz: 60, axes: {x: [3, 4, 0], y: [-4, 3, 0]}}"
    joint = "{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}"
    text = ARM.replace("JOINT", joint).replace("INPUT", TURN).replace("{length: in", "{length: m")
    model = mk.loads(text.replace("{arm: {}}", f"{{arm: {{inertia: {tensor}}}}}"))
    inertia = model.problem.mechanism.links["arm"].inertia
    assert inertia == pytest.approx((41, 34, 60, -12, 0, 0), abs=1e-13)


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
def test_nearly_opposite_axes_come_into_line_by_the_shortest_turn(off: float) -> None:
    """Rodrigues' formula at 40 digits, for the axis (3, 4, 0) sin(off)/5 - z of the arm."""
    with mp.workdps(40):
        axis = [mp.mpf(3) / 5 * mp.sin(off), mp.mpf(4) / 5 * mp.sin(off), -mp.cos(off)]
        arm = "[" + ", ".join(mp.nstr(x, 30) for x in axis) + "]"
        n, p, angle = mp.matrix([0.8, -0.6, 0]), mp.matrix([1, 2, 3]), mp.pi - off
        n /= mp.norm(n)
        across = mp.matrix([n[1] * p[2] - n[2] * p[1], -n[0] * p[2], n[0] * p[1] - n[1] * p[0]])
        along = n * (n.T * p)[0]
        turned = [float(x) for x in along + mp.cos(angle) * (p - along) + mp.sin(angle) * across]
    axes = f"axis: {{ground: [0, 0, 1], arm: {arm}}}"
    found = places(f"{{type: R, links: [ground, arm], point: [0, 0, 0], {axes}}}")
    # the axis itself is known to a rounding, its azimuth to one over `off`
    assert found[0] == pytest.approx(turned, abs=1e-15 / off + 1e-14)
