"""Mobility against theory: known linkages, general loops of any pairs, idle and redundant
freedoms."""

from __future__ import annotations

import cmath
import random
import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from classics import platforms, rings
from classics.drawing import Classic
from classics.platforms import wren
from mobility.overconstrained import (
    Z,
    bricard,
    coaxial_hinge,
    double_spherical,
    general,
    leg,
    planar,
    ring,
    sarrus,
    stretched,
)
from references import FILE_OF

import mechkin_cli as mk

SQUARE = [(1, 1), (-1, 1), (-1, -1), (1, -1)]


def table(x: float, y: float) -> str:
    """A table on four legs of length 1 from the corners of a square, drawn displaced."""
    z = -((1.0 - x * x - y * y) ** 0.5)
    lines = ["format: 1", "links: {top: {}, l0: {}, l1: {}, l2: {}, l3: {}}", "joints:"]
    for k, (a, b) in enumerate(SQUARE):
        lines.append(f"  A{k}: {{type: S, links: [ground, l{k}], point: [{a}, {b}, 0]}}")
        lines.append(
            f"  B{k}: {{type: S, links: [l{k}, top], point: [{a + x!r}, {b + y!r}, {z!r}]}}"
        )
    return "\n".join(lines)


SCREW_JACK = ring("RHP", [(0, 0, 0), (0, 0, 1), (0, 0, 2)], [Z] * 3, lead=0.1)


@pytest.mark.parametrize(
    ("text", "count", "mobility", "redundant"),
    [
        pytest.param(planar(), -2, 1, 3, id="planar four-bar"),
        pytest.param(sarrus(), 0, 1, 1, id="Sarrus"),
        pytest.param(bricard(), 0, 1, 1, id="Bricard"),
        pytest.param(SCREW_JACK, -3, 1, 4, id="R-H-P on one axis"),
        pytest.param(general("PRPRRH", lead=0.3), 0, 0, 0, id="PRPRRH"),
        pytest.param(general("RPRHRRR", lead=0.3), 1, 1, 0, id="RPRHRRR"),
        pytest.param(general("RRRRRRH", lead=0.3), 1, 1, 0, id="RRRRRRH"),
        pytest.param(general("RPRRHC", lead=0.3), 1, 1, 0, id="RPRRHC"),
        pytest.param(general("PPHCHP", lead=0.3), 1, 1, 0, id="PPHCHP"),
        pytest.param(general("RCSR"), 1, 1, 0, id="RCSR"),
        pytest.param(double_spherical(), 2, 2, 0, id="RSSR"),
        pytest.param(general("RRRR"), -2, 0, 2, id="general 4R"),
    ],
)
def test_count_truth_and_redundancy(text: str, count: int, mobility: int, redundant: int) -> None:
    found = mk.loads(text).mobility()
    assert found.diagnostics == ()
    assert (found.count, found.mobility, found.loops) == (count, mobility, 1)
    assert sum(item.number for item in found.redundant) == redundant


@pytest.mark.parametrize("name", ["bennett", "parallelogram", "hooke", "slider_crank"])
def test_committed_overconstrained_mechanisms(name: str) -> None:
    found = mk.load(FILE_OF[name]).mobility()
    assert (found.count, found.mobility) == (-2, 1)
    assert [item.number for item in found.redundant] == [3]
    assert "3 constraints are redundant" in found.verdict


def test_a_planar_loop_carries_a_force_and_two_moments() -> None:
    (item,) = mk.loads(planar()).mobility().redundant
    assert item.joints == ("J1", "J2", "J3", "J4")
    assert item.wrenches == "moments about x and y, force along z"
    assert item.sentence.startswith("the loop through J1, J2, J3, J4 carries 3 redundant")


def test_a_cure_leaves_nothing_redundant() -> None:
    text = planar()
    (item,) = mk.loads(text).mobility().redundant
    assert item.cure == "none is left with J1 as S and J2 as C"
    cured = text.replace("J1: {type: R", "J1: {type: S").replace("J2: {type: R", "J2: {type: C")
    cured = cured.replace("point: [0, 0, 0], axis: [0, 0, 1]", "point: [0, 0, 0]")
    found = mk.loads(cured).mobility()
    assert (found.count, found.mobility, found.redundant) == (1, 1, ())


def test_the_axes_of_a_spherical_linkage_bear_forces_through_their_point() -> None:
    axes = [(1, 0, 0), (1, 1, 0.2), (0.3, 1, 1), (0, 0, 1)]
    points = [tuple(2 * c for c in axis) for axis in axes]
    found = mk.loads(ring("RRRR", points, axes)).mobility()
    assert found.mobility == 1
    assert [item.wrenches for item in found.redundant] == [
        "forces along all axes through one point"
    ]


def test_a_link_between_two_spheres_spins() -> None:
    found = mk.loads(double_spherical()).mobility()
    assert [item.sentence for item in found.idle] == ["L2 spins freely about J2-J3"]
    assert found.useful == 1


def test_the_two_halves_of_a_leg_spin_together() -> None:
    found = mk.loads(leg()).mobility()
    assert found.mobility == 2
    assert [item.sentence for item in found.idle] == ["tube and rod spin together freely about A-C"]


def test_a_collar_between_coaxial_hinges_turns() -> None:
    found = mk.loads(coaxial_hinge()).mobility()
    assert found.mobility == 2
    (idle,) = found.idle
    assert idle.sentence == "L2 turns freely about the common axis of J2, J3"


def test_a_motion_of_first_order_is_no_mobility() -> None:
    found = mk.loads(stretched()).mobility()
    assert (found.first_order, found.mobility) == (1, 0)
    assert found.verdict.startswith("nothing can move but to first order")


def test_coordinates_that_never_move_are_named() -> None:
    text = planar().replace("J2: {type: R", "J2: {type: C")
    found = mk.loads(text).mobility()
    assert (found.mobility, found.fixed) == (1, ("J2.s",))


def test_inputs_are_not_needed_but_checked() -> None:
    text = planar() + "motion: {inputs: {J1.theta: {at: 0}, J4.theta: {at: 0}}}\n"
    (error,) = mk.loads(text).mobility().diagnostics
    assert (error.code, error.measured) == ("inputs-dependent", "2 inputs drive one freedom")


def test_a_locked_input_is_named() -> None:
    text = planar().replace("J2: {type: R", "J2: {type: C")
    found = mk.loads(text + "motion: {inputs: {J2.s: {at: 0}}}\n").mobility()
    assert [d.code for d in found.diagnostics] == ["input-locked", "undriven-freedom"]


def test_what_cannot_be_assembled_has_a_count_only() -> None:
    text = ring("RRR", [(0, 0, 0), (1, 0, 0), (3, 0, 0)], [Z] * 3)
    text = text.replace("point: [3, 0, 0]", "point: {L2: [3, 0, 0], ground: [9, 0, 0]}")
    found = mk.loads(text).mobility()
    assert (found.mobility, found.count) == (None, -3)
    (error,) = found.diagnostics
    assert error.code == "not-assembled"


def test_motions_of_several_dimensions_are_named() -> None:
    found = mk.loads(wren(5)).mobility()
    assert (found.mobility, found.dimensions, found.first_order) == (2, (2, 1), 3)
    assert found.verdict.startswith("motions of 1 and 2 freedoms meet (3 to first order); ")


def test_dimensions_that_nearly_fit_are_no_motion_of_their_own() -> None:
    """Bricard's loop with seven digits is open by more than a motion, by less than what is surely
    rigid."""
    bricard = next(case.text for case in rings.CASES if case.name == "Bricard trihedral")
    found = mk.loads(rounded(bricard, 7)).mobility()
    (error,) = found.diagnostics
    assert (found.mobility, found.first_order) == (None, 1)
    assert error.code == "mobility-unclear"
    assert "the loops are open by" in (error.measured or "")


@pytest.mark.parametrize(
    "case", [case for case in platforms.CASES if "6" in case.name], ids=lambda case: case.name
)
def test_nine_digits_are_enough(case: Classic) -> None:
    found = mk.loads(rounded(case.text, 9)).mobility()
    assert (found.dimensions, found.first_order) == (case.dimensions, case.first_order)


def rounded(text: str, digits: int) -> str:
    """A file whose numbers have some digits behind the point."""
    number = re.compile(r"-?\d+\.\d+(e-?\d+)?")
    return number.sub(lambda found: f"{float(found.group()):.{digits}f}", text)


@pytest.mark.parametrize("at", [(0.3, 0.2), (-0.4, 0.1), (0.5, -0.6)])
def test_motion_that_the_count_allows_needs_no_exact_dimensions(at: tuple[float, float]) -> None:
    """Lines of parallel legs r_k + t l have the rank 3, so that the table twists about l to first
    order; to second order the stress (1, -1, 1, -1) leaves -8 w_x w_y = -8 s^2 l_x l_y, which
    blocks the twist s where neither vanishes. Two translations and four spins are left, as many as
    the count of 6 for any lengths of the legs."""
    x, y = at
    line = np.array([x, y, -np.sqrt(1.0 - x * x - y * y)])
    lines = [np.concatenate([line, np.cross([a, b, 0.0], line)]) for a, b in SQUARE]
    twists = 6 - int(np.linalg.matrix_rank(lines))
    found = mk.loads(table(x, y)).mobility()
    assert (found.count, found.mobility, found.first_order) == (6, 2 + 4, twists + 4)
    assert sum(item.number for item in found.redundant) == 1
    assert found.fixed == ()
    assert found.verdict.endswith(
        "as Kutzbach's count says, though one constraint is redundant to first order"
    )


def test_the_figure_of_the_dissertation_does_not_move() -> None:
    """The six screws of PRPRRH as its file has them are independent, so that none can turn."""
    model = mk.load(FILE_OF["prprrh"])
    screws = []
    for joint in model.problem.mechanism.joints.values():
        z = np.array(joint.axis.vector)
        moment = np.cross(joint.point.vector, z)
        screws.append(
            [*np.zeros(3), *z] if joint.letter == "P" else [*z, *(moment + joint.pitch * z)]
        )
    assert np.linalg.matrix_rank(np.array(screws)) == 6
    found = model.mobility()
    assert (found.count, found.mobility, found.redundant) == (0, 0, ())
    assert set(found.fixed) == set(model.problem.mechanism.coordinates)
    assert found.verdict.startswith("nothing can move")


LINKAGES = Path(__file__).parent / "linkages"


@pytest.mark.parametrize(("name", "freedoms"), [("short_lever", 6), ("coupled_short_lever", 0)])
def test_an_equation_that_hardly_differs_from_others_is_not_redundant(
    name: str, freedoms: int
) -> None:
    """By exact ranks all equations of these plane linkages, drawn by whole numbers, are
    independent; the least singular value is 2e-5 to 5e-5 of the largest."""
    found = mk.load(LINKAGES / f"{name}.yaml").mobility()
    assert found.mobility == found.first_order == found.count == freedoms
    assert found.redundant == ()
    assert found.families == ()


def test_what_only_touches_never_moves_in_any_pose_and_order() -> None:
    """A crank square to the slide that its pin runs on: nothing of it can move. The second file is
    the first, turned, reordered and renamed."""
    one, other = (
        mk.load(LINKAGES / name).mobility() for name in ("touching.yaml", "touching_turned.yaml")
    )
    assert set(one.fixed) == set(other.fixed) >= {"J0.theta", "J1.theta", "J2.s"}
    assert (one.mobility, one.first_order) == (other.mobility, other.first_order) == (1, 2)


def test_a_family_tells_nothing_of_what_moves_by_other_parts() -> None:
    """L4 turns about its pin to ground, whatever the loops that hang on it do."""
    (family,) = mk.load(LINKAGES / "hung_part.yaml").mobility().families
    assert family.rests == ("W6.theta", "J8.theta", "J9.theta", "J10.theta")


def test_equations_that_touch_in_high_order_are_no_freedom() -> None:
    """Loops that stay open by 4e-10 over a tenth of the size, in any pose: two freedoms, or not
    clear; in every fifth pose a third one was told."""
    text = (LINKAGES / "touching_in_high_order.yaml").read_text(encoding="utf-8")
    answers = []
    for seed in range(12):
        dice = random.Random(seed)
        data = yaml.safe_load(text)
        turn = cmath.exp(1j * (dice.uniform(0.0, 6.28) if seed else 0.0))
        for joint in data["joints"].values():
            for key in {"point", "axis", "slot"} & set(joint):
                place = complex(*joint[key]) * turn
                joint[key] = [place.real, place.imag]
        for part in ("joints", "links") if seed else ():
            names = list(data[part])
            dice.shuffle(names)
            data[part] = {name: data[part][name] for name in names}
        found = mk.loads(yaml.safe_dump(data, sort_keys=False)).mobility()
        assert found.first_order == 3
        answers.append(found.mobility)
        assert found.mobility or found.diagnostics[0].code == "mobility-unclear"
    assert set(answers) <= {2, None}
    assert answers[0] == 2
    assert answers.count(2) >= 6
