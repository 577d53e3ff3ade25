"""One branch from end to end: proven where it is one, and never across a jump."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from oracle import document, in_other_units, moved, renamed, reordered, rotation_matrix, to_text
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.proofs.rows import SweepProofs as Found, certify
from mechkin_cli.sweep.result import Result

SWEPT = (
    "rcsr",
    "rssr",
    "sevenr",
    "rcsr_csr",
    "rchch",
    "five_link_suspension",
    "stewart",
    "slider_crank",
    "bennett",
    "rsgc",
)


def proofs_of(result: Result) -> Found:
    """Of rows whose states may have been changed."""
    return certify(result.session, result.row_states.states, result.solved)


@pytest.mark.parametrize("name", SWEPT)
def test_sweeps_are_one_branch(name: str) -> None:
    proofs = mk.load(FILE_OF[name]).certify()
    assert proofs.is_one_branch
    assert proofs.tubes > 0
    assert proofs.diagnostics == ()


def four_bar(gap: float, motion: str) -> str:
    """A parallelogram whose frame is too long by `gap`^2: its two branches, parallel and crossed,
    come as near as about `gap` where the crank points along the frame."""
    return f"""
format: 1
units: {{length: m, angle: deg}}
parameters: {{d: 2 m + {gap * gap!r} m}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [crank, coupler], point: [0, 1, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [coupler, rocker], point: [2, 1, 0], axis: [0, 0, 1]}}
  D: {{type: R, links: [ground, rocker], point: {{ground: [d, 0, 0], rocker: [2, 0, 0]}},
      axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {motion}}}}}
"""


@cache
def branches(gap: float) -> tuple[Result, Result]:
    """Both branches over rows on either side of the place where they are nearest."""
    model = mk.loads(four_bar(gap, "{from: -60, to: -120, step: 4}"))
    modes = [mode.name for mode in model.modes().modes]
    assert len(modes) == 2
    one, other = (model.analyze(tables=[], mode=mode).result for mode in modes)
    return one, other


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-6])
def test_a_jump_is_never_proven(gap: float) -> None:
    """Rows that go over to the other branch, before, at and behind the narrowest place."""
    one, other = branches(gap)
    assert one.solved.all()
    assert other.solved.all()
    states = one.row_states.states.copy()
    for row in (3, 7, 8, 12):
        one.row_states.states[:, row:] = other.row_states.states[:, row:]
        found = proofs_of(one)
        one.row_states.states[:] = states
        assert not found.on_branch[row:].any()
        assert found.on_branch[: row - 1].all()
        assert found.gaps[-1][2] == "branch"
        assert not found.is_complete


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-6])
def test_a_branch_is_followed_through_the_gap(gap: float) -> None:
    for branch in branches(gap):
        found = proofs_of(branch)
        assert found.is_complete


def test_one_row_of_another_branch_is_found() -> None:
    """Every row's box is proven, the one on the other branch included."""
    one, other = branches(1e-1)
    states = one.row_states.states.copy()
    one.row_states.states[:, 5] = other.row_states.states[:, 5]
    found = proofs_of(one)
    one.row_states.states[:] = states
    assert found.boxes.proven.all()
    assert found.on_branch.tolist() == [True] * 5 + [False] * 11


def verdicts(data: Any) -> list[str]:
    return mk.loads(to_text(data)).certify().status.tolist()


OTHERWISE = {
    "turned": lambda d: moved(d, rotation_matrix(3, 1, -2, 5), [3, -1, 2]),
    "in other units": lambda d: in_other_units(
        d, {"length": "mm", "angle": "rad", "mass": "kg", "force": "N"}
    ),
    "renamed": lambda d: renamed(d, {"O1": "Crank", "rocker": "lever", "crank": "wheel"}),
    "reordered": lambda d: reordered(d, 7),
}


@pytest.mark.parametrize("otherwise", OTHERWISE)
@pytest.mark.parametrize("name", ["rcsr", "rssr", "rcsr_csr"])
def test_written_otherwise(name: str, otherwise: str) -> None:
    data = document(FILE_OF[name])
    data.pop("tables", None)
    known = verdicts(data)
    assert set(known) == {"proven"}
    assert verdicts(OTHERWISE[otherwise](data)) == known


def test_backwards() -> None:
    text = FILE_OF["rcsr"].read_text()
    back = text.replace("from: 150, to: 202, step: 2", "from: 202, to: 150, step: 2").replace(
        "near: {O2.theta: -104, O2.s: -9, O4.theta: 37}", "near: {O4.theta: -5}"
    )
    there, again = mk.loads(text).certify(), mk.loads(back).certify()
    assert there.is_one_branch
    assert again.is_one_branch
    one, other = there.enclosure("O4.theta"), again.enclosure("O4.theta")
    assert (np.maximum(one[0], other[0][::-1]) <= np.minimum(one[1], other[1][::-1])).all()


def test_closed_at_another_joint() -> None:
    model = mk.load(FILE_OF["sevenr"])
    assert model.certify(closed_at=["J4"]).is_one_branch


def test_towards_a_dead_centre() -> None:
    """Five tubes a decade at most, down to 1e-9 degrees from where the branch ends."""
    text = FILE_OF["rcsr"].read_text()
    model = mk.loads(text.replace("from: 150, to: 202, step: 2", "from: 150, to: 210, step: 2"))
    notes = [d for d in model.analyze(tables=[]).diagnostics if d.code == "dead-centre"]
    end = next(n.value for n in notes[0].numbers if n.name == "O1.theta")
    counts = []
    for decade in range(1, 10):
        rows = f"values: [200, {end - 10.0**-decade!r}]"
        proofs = mk.loads(text.replace("from: 150, to: 202, step: 2", rows)).certify()
        if not proofs.is_one_branch:
            break
        counts.append(proofs.tubes)
    assert len(counts) >= 8
    assert max(np.diff(counts)) <= 5


def test_turns_of_the_input() -> None:
    text = FILE_OF["rssr"].read_text()
    proofs = mk.loads(text.replace("from: 0, to: 360, step: 10", "from: 0, to: 1440, step: 15"))
    assert proofs.certify().is_one_branch


CRANK_ROCKER = """
format: 1
units: {length: m, angle: deg}
links: {crank: {}, coupler: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, coupler], point: [1, 0, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [3, 0, 0], axis: [0, 0, 1]}
  C:
    type: R
    links: [coupler, rocker]
    point: {coupler: [4, 0, 0], rocker: [5.5, 0, 0]}
    axis: [0, 0, 1]
motion: {inputs: {A.theta: {values: ROWS}}}
assembly: {near: {D.theta: 90}}
"""


@pytest.mark.parametrize("rows", ["[0, 1080]", "[10, 36000, -350]", "[0, 350, 10, 700]"])
def test_rows_that_are_turns_apart(rows: str) -> None:
    model = mk.loads(CRANK_ROCKER.replace("ROWS", rows))
    assert model.certify().is_one_branch
    # the last row on the other branch
    one, other = (model.analyze(tables=[], mode=mode.name).result for mode in model.modes().modes)
    states = one.row_states.states
    states[:, -1] = other.row_states.states[:, -1]
    assert list(proofs_of(one).on_branch) == [True] * (one.rows - 1) + [False]


def test_rows_too_far_apart_for_a_proof_are_told_at_once() -> None:
    certificate = mk.loads(CRANK_ROCKER.replace("ROWS", "[0, 1e9]")).certify()
    assert not certificate.is_one_branch
    assert [str(x) for x in certificate.status] == ["proven", "not proven"]


def test_a_row_alone_and_rows_that_stand_still() -> None:
    text = FILE_OF["rcsr"].read_text()
    one = mk.loads(text.replace("from: 150, to: 202, step: 2", "values: [160]")).certify()
    assert one.is_one_branch
    assert one.tubes == 0
    still = mk.loads(
        text.replace("from: 150, to: 202, step: 2", "values: [160, 160, 160, 158, 162]")
    )
    assert still.certify().is_one_branch
