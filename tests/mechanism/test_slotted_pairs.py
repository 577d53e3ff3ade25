"""Ss, Sc and Cp against the same mechanisms built of R, P, U and E with links without mass.

The pairs are passed both ways as each joint of the loop closes it in turn.
"""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest
import yaml
from mechanism.slotted_pairs import CASES

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism.derived import DERIVED_KINDS

LIMIT = 1e-13
"""Errors in parts of the largest value of a family; the closures have conditions up to 23."""

EFFORT = "O.effort"


@cache
def model(name: str) -> mk.Model:
    return mk.loads(CASES[name].text)


@cache
def run(name: str, closed_at: str | None = None, lanes: int = 0) -> mk.Analysis:
    """All quantities of the mechanism."""
    closing = None if closed_at is None else [closed_at]
    found = model(name).analyze(list(model(name).quantities), closed_at=closing, lanes=lanes)
    assert set(found["row.status"]) == {"ok"}
    return found


@cache
def equivalent(name: str) -> mk.Analysis:
    other = mk.loads(CASES[name].equivalent)
    found = other.analyze(list(other.quantities))
    assert set(found["row.status"]) == {"ok"}
    return found


def numbers(name: str) -> list[str]:
    """Those of the kernel: an axis of a small turn is as uncertain as the turn is small."""
    known = model(name).problem.quantities().values()
    return [q.name for q in known if q.owner != "row" and q.kind not in DERIVED_KINDS]


def family(quantity: str) -> str:
    """What is measured against its largest value together: the last word of the name."""
    return quantity.rpartition(".")[2].replace("theta1", "theta").replace("theta2", "theta")


def agree(one: mk.Analysis, other: mk.Analysis, pairs: list[tuple[str, str]]) -> None:
    sizes: dict[str, float] = {}
    for quantity, _ in pairs:
        size = float(np.max(np.abs(one[quantity])))
        sizes[family(quantity)] = max(size, sizes.get(family(quantity), 0.0))
    for quantity, expression in pairs:
        error = float(np.max(np.abs(one[quantity] - other[expression])))
        assert error <= LIMIT * sizes[family(quantity)], quantity


CLOSINGS = [
    (name, joint)
    for name, case in CASES.items()
    for joint in ("A", "B", "D")
    if f"  {joint}: " in case.joints
]


@pytest.mark.parametrize(("name", "joint"), CLOSINGS)
def test_the_choice_of_closing_joint_changes_no_answer(name: str, joint: str) -> None:
    agree(run(name), run(name, joint), [(quantity, quantity) for quantity in numbers(name)])


@pytest.mark.parametrize("name", CASES)
def test_the_same_answers_as_the_mechanism_of_simple_pairs(name: str) -> None:
    there = set(mk.loads(CASES[name].equivalent).quantities)
    shared = [(q, q) for q in numbers(name) if q in there]
    assert ("ground.shaking_moment", "ground.shaking_moment") in shared
    assert (EFFORT, EFFORT) in shared
    agree(run(name), equivalent(name), [*shared, *CASES[name].same])


@pytest.mark.parametrize(("name", "joint"), CLOSINGS)
def test_power_is_balanced(name: str, joint: str) -> None:
    assert run(name, joint)["row.power_error"].max() <= 1e-13


@pytest.mark.parametrize("lanes", [4, 8])
@pytest.mark.parametrize(("name", "joint"), CLOSINGS)
def test_the_width_of_the_packs_changes_no_bit(name: str, joint: str, lanes: int) -> None:
    if lanes > _kernel.widest:
        pytest.skip(f"this machine has packs of {_kernel.widest} lanes at most")
    for quantity in model(name).quantities:
        if quantity not in ("row.status", "row.mode"):
            expected = run(name, joint, 2)[quantity]
            assert run(name, joint, lanes)[quantity].tobytes() == expected.tobytes(), quantity


def turned(texts: list[float], *, shift: float = 0.0) -> list[float]:
    """A quarter turn about z, for points with a shift along x."""
    x, y, z = texts
    return [shift - y, x, z]


def redrawn(text: str) -> str:
    """The rod drawn elsewhere: its joints have a place and directions per link."""
    data = yaml.safe_load(text)
    rod = data["links"]["rod"]
    rod["center_of_mass"] = turned(rod["center_of_mass"], shift=5.0)
    xx, yy, zz, xz = (rod["inertia"][key] for key in ("xx", "yy", "zz", "xz"))
    rod["inertia"] = {"xx": yy, "yy": xx, "zz": zz, "yz": xz}
    for joint in data["joints"].values():
        if "rod" not in joint["links"]:
            continue
        (other,) = set(joint["links"]) - {"rod"}
        for key in {"point", "axis", "pin", "slot", "normal"} & set(joint):
            shift = 5.0 if key == "point" else 0.0
            joint[key] = {"rod": turned(joint[key], shift=shift), other: joint[key]}
    return json.dumps(data)


@pytest.mark.parametrize("closed_at", ["A", "D"])
@pytest.mark.parametrize("name", ["Sc and Sc", "Cp and Ss"])
def test_a_link_may_be_drawn_anywhere(name: str, closed_at: str) -> None:
    elsewhere = mk.loads(redrawn(CASES[name].text))
    found = elsewhere.analyze(numbers(name), closed_at=[closed_at])
    agree(run(name), found, [(quantity, quantity) for quantity in numbers(name)])


DRIVEN = [
    (name, f"{joint.name}.{coordinate}")
    for name in CASES
    for joint in model(name).problem.mechanism.joints.values()
    if joint.letter in ("Ss", "Sc", "Cp")
    for coordinate in joint.type.coordinates
]


@pytest.mark.parametrize(("name", "coordinate"), DRIVEN)
def test_each_coordinate_can_be_the_input(name: str, coordinate: str) -> None:
    """Driven as it moved in one row, it moves the crank as the crank moved it, by the same
    power."""
    row, before = 7, run(name)
    value, rate, acceleration = (
        repr(float(before[coordinate + suffix][row])) for suffix in ("", "_dot", "_ddot")
    )
    theta = float(before["O.theta"][row])
    motion = f"{coordinate}: {{at: {value}, rate: {rate}, acceleration: {acceleration}}}"
    case = CASES[name]
    others = set(model(name).problem.mechanism.coordinates) - {coordinate}
    places = ", ".join(f"{other}: {float(before[other][row])!r}" for other in sorted(others))
    near = f"assembly: {{near: {{{places}}}}}\n"
    driven = mk.loads(case.text.replace(case.motion, motion) + near)
    effort = f"{coordinate}.effort"
    after = driven.analyze(["O.theta", "O.theta_dot", "O.theta_ddot", effort])
    assert after["O.theta"][0] == pytest.approx(theta, abs=1e-12)
    assert after["O.theta_dot"][0] == pytest.approx(2, rel=1e-10)
    assert after["O.theta_ddot"][0] == pytest.approx(-3, rel=1e-9)
    power = before["O.effort"][row] * 2
    assert after[effort][0] * float(rate) == pytest.approx(power, rel=1e-9)


@pytest.mark.parametrize("name", CASES)
def test_mobility_by_count_and_by_rank(name: str) -> None:
    """One freedom either way; the equivalent's bodies between the turns change nothing."""
    for found in (model(name).mobility(), mk.loads(CASES[name].equivalent).mobility()):
        assert (found.count, found.mobility) == (1, 1)
        assert not found.redundant
