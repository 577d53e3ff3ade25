"""Enclosures of positions: they hold the positions at 60 digits, whatever the doubles in their
middle are, and what cannot be proven is not."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
import pytest
from mechanisms.runs import NAMES as RUNS, closings, run
from oracle import document, mp, read, solve, to_text
from proofs.perturbed import moved
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.analysis.certificate import Certificate
from mechkin_cli.proofs.rows import SweepProofs as Found, certify

DEGREE = mp.pi / 180
COHERENT = {"length": "in", "angle": "deg", "mass": "lbm", "force": "lbm*in/s^2"}
NAMES = ("rcsr", "sevenr", "rchch", "rcsr_csr", "rccc", "rcrcr", "phchc", "rprhrrr", "rrrrrrh")
ROWS = (0, 4, 10)


def proofs_of(result: Any) -> Found:
    """Of rows whose states may have been changed."""
    return certify(result.session, result.row_states.states, result.solved)


@cache
def certificate(name: str) -> Certificate:
    return mk.load(FILE_OF[name]).certify()


@cache
def mechanism(name: str) -> Any:
    return read(to_text(document(FILE_OF[name]) | {"units": COHERENT}))


def true_coordinates(name: str, row: int) -> dict[str, Any]:
    """All coordinates at 60 digits, in degrees and the file's lengths."""
    analysis, guess = certificate(name).analysis, {}
    for joint, its in mechanism(name).joints.items():
        for coordinate in its.coordinates:
            value = float(analysis[f"{joint}.{coordinate}"][row])
            guess[f"{joint}.{coordinate}"] = value * (DEGREE if coordinate == "theta" else 1)
    found = solve(mechanism(name), mechanism(name).row(row), guess)
    return {n: found[n] / (DEGREE if n.endswith("theta") else 1) for n in guess}


def enclosed(proofs: Certificate) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """The coordinates that are enclosed: those of the tree that Newton's method finds."""
    found = {}
    for name in proofs.analysis.result.coordinates:
        try:
            found[name] = proofs.enclosure(name)
        except mk.UsageError:
            continue
    return found


@pytest.mark.parametrize("name", NAMES)
def test_true_positions_are_enclosed(name: str) -> None:
    proofs = certificate(name)
    boxes = enclosed(proofs)
    assert set(proofs.status) == {"proven"}
    assert boxes
    for row in ROWS:
        true = true_coordinates(name, row)
        for coordinate, (low, high) in boxes.items():
            turns = 0
            if coordinate.endswith("theta") and not name.startswith("h"):
                turns = 360 * round((low[row] - float(true[coordinate])) / 360)
            assert low[row] <= true[coordinate] + turns <= high[row], (row, coordinate)
            assert high[row] - low[row] < 1e-9


@pytest.mark.parametrize("name", RUNS)
def test_boxes_about_wrong_places_hold_the_right_ones(name: str) -> None:
    """Whatever is proven holds the true position, for all pairs and all choices of closing
    joints: no equation and no column is wrong."""
    proven = 0
    for number, closed_at in enumerate((None, *closings(name)[:4])):
        result = run(name, closed_at).result
        for by in (1e-9, 1e-5, 1e-3, 1e-2):
            boxes, off = moved(result, by, number)
            rows = boxes.proven
            assert (np.abs(off) <= boxes.radius + 1e-12)[:, rows].all()
            assert not rows.any() or boxes.radius[:, rows].max() < 100 * by + 1e-9
            proven += rows.sum()
    assert proven > 0


def perturbed(by: float, row: int) -> Any:
    """The RCSR's rows with one row's states off by some rad and lengths."""
    result = mk.load(RCSR).analyze(tables=[]).result
    states = result.row_states.states
    free = np.ones(len(states), dtype=bool)
    edge = result.session.layout.edge_number["O1"]
    free[result.session.layout.state(edge, 0)] = False
    states[free, row] += by
    return result


def test_a_place_that_is_far_off_is_not_proven() -> None:
    found = proofs_of(perturbed(0.3, 10))
    assert not found.boxes.proven[10]
    assert list(found.gaps) == [
        (10, 10, "box"),
        (11, 26, "branch"),
    ]


def test_nothing_is_said_of_rows_without_a_position() -> None:
    text = RCSR.read_text().replace("to: 202", "to: 210")
    proofs = mk.loads(text).certify()
    assert proofs.status.tolist() == ["proven"] * 28 + ["not proven"] * 3
    assert "rows 29 to 31 are not proven: there is no position" in str(proofs.diagnostics[0])
    assert not proofs.is_one_branch


def test_a_singular_place_is_not_proven() -> None:
    """The two ends of a dead centre meet where the crank and the coupler are in line."""
    text = """
format: 1
units: {length: m, angle: deg}
links: {crank: {}, rod: {}, block: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [1, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, block], point: [3, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, block], point: [3, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {D.s: {values: [-0.5, -0.1, -1e-3, 0]}}}
assembly: {near: {A.theta: 40}}
"""
    proofs = mk.loads(text).certify()
    assert proofs.status[:3].tolist() == ["proven"] * 3
    assert proofs.status[3] == "not proven"


def test_overconstrained_loops_are_proven_to_closure() -> None:
    proofs = mk.load(FILE_OF["bennett"]).certify()
    assert set(proofs.status) == {"proven to closure"}
    assert 0.0 < proofs.closure.max() < 1e-12
    # a loop in planes that are written exactly holds exactly
    assert set(mk.load(FILE_OF["slider_crank"]).certify().status) == {"proven"}


def test_a_response_has_no_proofs() -> None:
    analysis = mk.load(FILE_OF["rcsr_response"]).respond()
    with pytest.raises(mk.UsageError, match="proofs are of sweeps"):
        _ = analysis.certificate


@pytest.mark.parametrize(
    "tiny",
    [
        "1e-200*1e-200",
        "1e-200*1e-200/3",
        "1e-200/1e200",
        "2^-1200",
        "exp(-1000)",
        "exp(-1000)/1e300",
    ],
)
def test_what_is_too_small_for_a_double_is_not_zero(tiny: str) -> None:
    """The axis of B is tilted by what rounds to nothing, and the plane loop has no position."""
    text = FILE_OF["slider_crank"].read_text(encoding="utf-8")
    tilted = re.sub(r"(B: .*axis: )\[0, 0, 1\]", rf'\1["{tiny}", 0, 1]', text)
    assert tilted != text
    assert set(mk.loads(tilted).certify().status) == {"proven to closure"}
