"""Parallelograms and coupled wheels at their branch points, with the key that passes them."""

from __future__ import annotations

import math
import os

import numpy as np
import pytest

import mechkin_cli as mk
from benchmarks.rows_of_loops import text as falling

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

JOINT = "  {name}: {{type: {kind}, links: [{links}], point: [{x}, {y}, 0]{axis}}}\n"


def joint(name: str, kind: str, links: str, x: float, y: float) -> str:
    axis = "" if kind == "S" else ", axis: [0, 0, 1]"
    return JOINT.format(name=name, kind=kind, links=links, x=x, y=y, axis=axis)


def wheels(count: int, pairs: str, motion: str, more: str) -> str:
    """Wheels of radius 3 in a row, 10 apart, each on a rod to the one before, drawn upright."""
    links, joints = ["wheel0"], joint("A", "R", "ground, wheel0", 0, 0)
    for k in range(1, count):
        links += [f"rod{k}", f"wheel{k}"]
        joints += joint(f"P{k}", pairs[0], f"wheel{k - 1}, rod{k}", 10 * (k - 1), 3)
        joints += joint(f"Q{k}", pairs[1], f"rod{k}, wheel{k}", 10 * k, 3)
        joints += joint(f"D{k}", "R", f"ground, wheel{k}", 10 * k, 0)
    return (
        "format: 1\nname: wheels\nunits: {length: mm, angle: deg}\n"
        f"links: {{{', '.join(f'{link}: {{}}' for link in links)}}}\njoints:\n{joints}"
        f"motion: {{inputs: {{A.theta: {motion}}}}}\n{more}"
    )


STRAIGHT = "assembly: {at_branch_points: straight}\n"


@pytest.mark.parametrize("pairs", ["SS", "RR", "CS", "RC"])
@pytest.mark.parametrize("count", [2, 3, 4])
@pytest.mark.parametrize("motion", [
    "{from: 0, to: 720, step: 7}", "{from: 0, to: -3600, step: 77}", "{from: 0, to: 360, step: 90}",
])  # fmt: skip
def test_straight_on_wheels_turn_together(count: int, pairs: str, motion: str) -> None:
    result = mk.loads(wheels(count, pairs, motion, STRAIGHT)).analyze()
    turned = result["A.theta"]
    # at the branch points themselves a row may be anything that says so
    at = np.abs(np.remainder(turned - 90 + 1e-6, 180)) < 2e-6
    for k in range(1, count):
        assert np.abs(result[f"D{k}.theta"] - turned)[~at].max() < 1e-6
    assert set(result["row.status"][~at].tolist()) <= {"ok", "near-singular"}
    assert any("branch point" in str(note) for note in result.diagnostics)


@pytest.mark.parametrize("pairs", ["SS", "RR", "CS", "RC", "RS", "SR"])
@pytest.mark.parametrize("count", [4, 6, 11])
def test_many_loops_lie_singular_at_once(pairs: str, count: int) -> None:
    result = mk.loads(wheels(count, pairs, "{from: 0, to: 720, step: 7}", STRAIGHT)).analyze()
    turned = result["A.theta"]
    at = np.abs(np.remainder(turned - 90 + 1e-6, 180)) < 2e-6
    assert np.abs(result[f"D{count - 1}.theta"] - turned)[~at].max() < 1e-6
    assert set(result["row.status"][~at].tolist()) <= {"ok", "near-singular"}


@pytest.mark.parametrize("count", [5, 10, 20, 40, *([30, 60, 120] if TIMES > 1 else [])])
def test_parallelograms_in_a_row_turn_together(count: int) -> None:
    """Between rows they pass the place where all lie flat at once."""
    links, joints = [], ""
    for k in range(count + 1):
        links.append(f"crank{k}")
        joints += f"  A{k}: {{type: R, links: [ground, crank{k}], point: [{k}, 0]}}\n"
    for k in range(count):
        links.append(f"rod{k}")
        joints += f"  B{k}: {{type: R, links: [crank{k}, rod{k}], point: [{k}, 1]}}\n"
        joints += f"  D{k}: {{type: R, links: [rod{k}, crank{k + 1}], point: [{k + 1}, 1]}}\n"
    result = mk.loads(
        "format: 1\nname: row\nplane: xy\nunits: {length: m, angle: rad}\n"
        f"links: {{{', '.join(f'{link}: {{}}' for link in links)}}}\njoints:\n{joints}"
        f"motion: {{inputs: {{A0.theta: {{from: 0, to: 3, step: 0.25}}}}}}\n{STRAIGHT}"
    ).analyze()
    assert set(result["row.status"].tolist()) == {"ok"}
    assert np.abs(result[f"A{count}.theta"] - result["A0.theta"]).max() < 1e-12


def test_ends_of_steps_lie_farther_from_where_many_loops_are_singular() -> None:
    """Of a hundred loops the second place at which they lie flat was not told any more."""
    text = falling(100, 1.0, 1.0).partition("loads:")[0]
    text += "motion: {inputs: {A0.theta: {from: 0, to: 6, count: 13}}}\n"
    result = mk.loads(text).analyze(["A0.theta", "A100.theta"])
    assert set(result["row.status"].tolist()) == {"ok"}
    assert np.abs(result["A100.theta"] - result["A0.theta"]).max() < 1e-11


@pytest.mark.parametrize("pairs", ["SS", "RR", "CS", "RC"])
@pytest.mark.parametrize("count", [2, 3, 4])
def test_without_the_key_the_branch_is_lost_there(count: int, pairs: str) -> None:
    result = mk.loads(wheels(count, pairs, "{from: 0, to: 200, step: 7}", "")).analyze()
    turned = result["A.theta"]
    before = turned < 90 - 1e-6
    assert set(result["row.status"][before].tolist()) == {"ok"}
    assert set(result["row.status"][~before].tolist()) == {"branch-lost"}
    for k in range(1, count):
        assert np.abs(result[f"D{k}.theta"] - turned)[before].max() < 1e-6
    (note,) = [d for d in result.diagnostics if "branch point" in d.message]
    assert any(abs(number.value - 90) < 1e-9 for number in note.numbers)


def tongs(cells: int) -> dict[str, object]:
    """Lazy tongs: crossed bars a, b of length 2 m, pinned in their middles C and at their ends; b0
    is the ground, drawn open by 40 degrees."""
    along, up = math.cos(math.radians(20)), math.sin(math.radians(20))

    def bar(kind: str, cell: int) -> str:
        return "ground" if (kind, cell) == ("b", 0) else f"{kind}{cell}"

    joints = {}
    for k in range(cells):
        x = 2 * along * k
        joints[f"C{k}"] = {"type": "R", "links": [bar("b", k), bar("a", k)], "point": [x, 0]}
    for k in range(cells - 1):
        x = 2 * along * k + along
        joints[f"T{k}"] = {"type": "R", "links": [bar("a", k), bar("b", k + 1)], "point": [x, up]}
        joints[f"B{k}"] = {"type": "R", "links": [bar("b", k), bar("a", k + 1)], "point": [x, -up]}
    bars = {bar(kind, k): {} for kind in "ab" for k in range(cells)}
    bars.pop("ground")
    return {
        "format": 1,
        "plane": "xy",
        "units": {"length": "m", "angle": "deg"},
        "links": bars,
        "joints": joints,
        "assembly": {"at_branch_points": "straight"},
    }


@pytest.mark.parametrize("step", [5, 7, 16])
@pytest.mark.parametrize("cells", [2, 3, 5, 8])
def test_lazy_tongs_pass_where_they_lie_flat(cells: int, step: int) -> None:
    """All rhombs lie flat at -40 degrees; every crossing turns as the driven one."""
    file = tongs(cells)
    file["motion"] = {"inputs": {"C0.theta": {"from": 0, "to": -80, "step": step}}}
    result = mk.load(file).analyze()
    turned = result["C0.theta"]
    flat = np.abs(turned + 40) < 1e-9
    assert set(result["row.status"][~flat].tolist()) == {"ok"}
    for k in range(1, cells):
        assert np.abs(result[f"C{k}.theta"] - turned)[~flat].max() < 1e-10
    for told in result.diagnostics:
        assert "e+308" not in str(told)
