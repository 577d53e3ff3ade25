"""Balances of the same machine written otherwise, and of machines twice as heavy or as fast."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracle.document import document, to_text
from oracle.numerics import mp
from oracle.transforms import moved, renamed, reordered, rotation_matrix

import mechkin_cli as mk

MACHINE = """format: 1
links:
  crank: {mass: 2, center_of_mass: [0.03, 0.01, 0], inertia: {zz: 0.02}}
  rod: {mass: 1.5, center_of_mass: [0.25, 0, 0.02], inertia: {zz: 0.03}}
  slider: {mass: 3, center_of_mass: [0.4, 0, 0]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: U, links: [crank, rod], point: [0.1, 0, 0], axis: [0, 0, 1], axis2: [0, 1, 0]}
  C: {type: S, links: [rod, slider], point: [0.4, 0, 0]}
  D: {type: P, links: [ground, slider], point: [0.4, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10, rate: 20 rad/s}}}
loads:
  - {type: gravity, g: [1, -9.81, 0.5]}
  - {type: damper, joint: D, coordinate: s, damping: 12}
  - {type: force, joint: D, value: "-30 N - 20 N*sin(A.theta)"}
"""
BALANCES = [
    {"name": "work", "type": "work"},
    {"name": "force", "type": "harmonics", "of": ["ground.shaking_force"], "orders": ["1", "2"]},
    {"name": "torque", "type": "harmonics", "of": ["A.effort"], "orders": ["0", "1", "2", "3"]},
    {"name": "wheel", "type": "flywheel", "unevenness": "0.02", "rate": "20 rad/s"},
]
SAME = 1e-11
Tables = dict[str, dict[str, np.ndarray[Any, Any]]]


def machine() -> dict[str, Any]:
    data = document(MACHINE)
    data["balances"] = [dict(each) for each in BALANCES]
    return data


def balances(data: dict[str, Any] | str) -> Tables:
    found = mk.loads(data if isinstance(data, str) else to_text(data)).analyze()
    assert set(found["row.status"]) == {"ok"}
    return dict(found.balances)


@pytest.fixture(scope="module", name="original")
def _original() -> Tables:
    return balances(machine())


def off(found: Any, wanted: Any) -> float:
    wanted = np.asarray(wanted, dtype=float)
    return float(np.max(np.abs(np.asarray(found, dtype=float) - wanted)) / np.max(np.abs(wanted)))


def check(found: Tables, wanted: Tables, factor: float = 1.0) -> None:
    """The same numbers, in the order in which they stand, times a factor."""
    assert off(np.sort(found["work"]["work"]), factor * np.sort(wanted["work"]["work"])) < SAME
    for name in ("cosine", "sine", "amplitude"):
        for table in ("force", "torque"):
            assert off(found[table][name], factor * wanted[table][name]) < SAME, (table, name)
    for name in ("flywheel", "estimate", "drive", "work_fluctuation", "largest_inertia"):
        assert off(found["wheel"][name], factor * wanted["wheel"][name]) < SAME, name


def test_the_original_has_something_to_tell(original: Tables) -> None:
    assert np.max(np.abs(original["work"]["work"])) > 1.0
    assert np.min(np.max(np.abs(original["force"]["amplitude"]))) > 1.0
    assert original["wheel"]["flywheel"][0] > 0.0


def test_other_names(original: Tables) -> None:
    data = renamed(machine(), {"B": "z9", "D": "aa", "rod": "Q", "slider": "a1"})
    check(balances(data), original)


@pytest.mark.parametrize("seed", [1, 2])
def test_another_order(seed: int, original: Tables) -> None:
    data = reordered(machine(), seed)
    data["balances"] = [dict(each) for each in BALANCES]
    check(balances(data), original)


def test_a_drawing_that_is_shifted(original: Tables) -> None:
    still = rotation_matrix(1, 0, 0, 0)
    check(balances(moved(machine(), still, [mp.mpf(7), mp.mpf(-3), mp.mpf(2)])), original)


def test_a_drawing_that_is_turned(original: Tables) -> None:
    """Shaking forces turn with it; efforts and works stay."""
    turn = rotation_matrix(3, -1, 2, 5)
    found = balances(moved(machine(), turn, [mp.mpf(0)] * 3))
    turned = np.array(turn, dtype=float)
    for name in ("cosine", "sine"):
        # rows: components, each with its orders
        own = original["force"][name].reshape(3, -1)
        order = [list(original["force"]["of"]).index(f"ground.shaking_force.{a}") for a in "xyz"]
        assert order == sorted(order)
        assert off(found["force"][name], (turned @ own).ravel()) < SAME
        assert off(found["torque"][name], original["torque"][name]) < SAME
    assert off(found["work"]["work"], original["work"]["work"]) < SAME
    assert off(found["wheel"]["flywheel"], original["wheel"]["flywheel"]) < SAME


def test_a_joint_written_from_the_other_side(original: Tables) -> None:
    text = to_text(machine())
    data = document(text)
    data["joints"]["D"]["links"] = data["joints"]["D"]["links"][::-1]
    data["loads"][2]["value"] = "30 N + 20 N*sin(A.theta)"
    check(balances(data), original)


def test_twice_the_masses_and_loads(original: Tables) -> None:
    data = machine()
    for body in data["links"].values():
        body["mass"] = repr(2 * float(body["mass"]))
        inertia = body.get("inertia", {})
        body["inertia"] = {key: repr(2 * float(value)) for key, value in inertia.items()}
    data["loads"][1]["damping"] = "24"
    data["loads"][2]["value"] = "-60 N - 40 N*sin(A.theta)"
    check(balances(data), original, 2.0)


def test_a_link_in_two_halves(original: Tables) -> None:
    """Half of the rod's mass and inertia is a link of its own, welded on."""
    data = machine()
    rod = data["links"]["rod"]
    half = {
        "mass": repr(float(rod["mass"]) / 2),
        "center_of_mass": list(rod["center_of_mass"]),
        "inertia": {"zz": repr(float(rod["inertia"]["zz"]) / 2)},
    }
    data["links"]["rod"], data["links"]["other"] = half, dict(half)
    data["joints"]["weld"] = {"type": "W", "links": ["rod", "other"]}
    check(balances(data), original)


def test_twice_the_speed(original: Tables) -> None:
    """Without loads but inertia: efforts four times as large, the flywheel the same."""
    data = machine()
    data["loads"] = []
    slow = balances(data)
    data["motion"]["inputs"]["A.theta"]["rate"] = "40 rad/s"
    data["balances"][3]["rate"] = "40 rad/s"
    fast = balances(data)
    for name in ("cosine", "sine"):
        assert off(fast["torque"][name], 4 * slow["torque"][name]) < SAME
        assert off(fast["force"][name], 4 * slow["force"][name]) < SAME
    # without loads the rate varies with the inertia alone
    assert slow["wheel"]["work_fluctuation"][0] == fast["wheel"]["work_fluctuation"][0] == 0.0
    assert slow["wheel"]["flywheel"][0] > 0.0
    assert off(fast["wheel"]["flywheel"], slow["wheel"]["flywheel"]) < SAME


def test_backwards(original: Tables) -> None:
    """A turn the other way: works of loads without a damper change their sign."""
    data = machine()
    del data["loads"][1]
    forth = balances(data)
    data["motion"]["inputs"]["A.theta"] |= {"from": "360", "to": "0"}
    back = balances(data)
    assert off(back["work"]["work"], -forth["work"]["work"]) < SAME
    assert off(back["torque"]["cosine"], forth["torque"]["cosine"]) < SAME
    assert off(back["torque"]["sine"], forth["torque"]["sine"]) < SAME


def test_what_nothing_reads_changes_no_bit(original: Tables) -> None:
    data = machine()
    data["points"] = {"unused": {"link": "rod", "at": ["0.3", "0.1", "0"]}}
    data["parameters"] = {"unused_too": "3 mm"}
    data["tables"] = [{"name": "t", "columns": ["A.theta", "unused.position.x"]}]
    found = balances(data)
    for name, table in original.items():
        for label, column in table.items():
            assert np.array_equal(found[name][label], column, equal_nan=column.dtype.kind == "f")
