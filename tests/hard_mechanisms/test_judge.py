"""The judge can find every kind of fault: right answers are spoilt on purpose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.stress.block import drawn, run_block
from benchmarks.stress.certify import contradicted
from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.judge import Found, Judged, judge
from benchmarks.stress.numbers.double_double import DEGREE
from benchmarks.stress.quantity import Truth
from benchmarks.stress.solve import solve
from benchmarks.stress.tally import Tally, of_record
from mechkin_cli.bench.runs import StressVerdict
from mechkin_cli.verdict import Proof, Status

ROW = 7


@pytest.fixture(scope="module")
def solved() -> tuple[Found, Truth]:
    """One R S S R, whose first rows all exist."""
    block = drawn(FAMILIES["sizes"], 1, [0])
    truth = block.truth(block.places)
    found, _, refused = solve(block.texts, block.places.shape[1], truth.cells())
    assert not refused
    assert truth.exists[0, : ROW + 1].all()
    return found, truth


def spoilt(found: Found, name: str, value: float) -> Found:
    values = {key: cells.copy() for key, cells in found.values.items()}
    values[name][0, ROW] = value
    return replace(found, values=values)


def verdict(judged: Judged) -> StressVerdict:
    others = np.delete(judged.verdict[0], ROW)
    assert np.isin(others, (StressVerdict.right, StressVerdict.rightly_none)).all()
    return StressVerdict(judged.verdict[0, ROW])


def test_nothing_is_wrong_as_it_is(solved: tuple[Found, Truth]) -> None:
    assert verdict(judge(*solved)) == StressVerdict.right


def test_a_row_on_the_other_branch(solved: tuple[Found, Truth]) -> None:
    found, truth = solved
    (quantity,) = truth.quantities
    other = float((quantity.other / DEGREE).high[0, ROW])
    assert verdict(judge(spoilt(found, "D.theta", other), truth)) == StressVerdict.false_ok


def test_a_row_that_is_off(solved: tuple[Found, Truth]) -> None:
    found, truth = solved
    near = found.values["D.theta"][0, ROW] * (1.0 + 1e-7)
    assert verdict(judge(spoilt(found, "D.theta", near), truth)) == StressVerdict.false_ok


def test_the_same_with_a_warning(solved: tuple[Found, Truth]) -> None:
    found, truth = solved
    codes = found.codes.copy()
    codes[0, ROW] = Status.near_singular
    off = spoilt(replace(found, codes=codes), "D.theta", 1.0)
    assert verdict(judge(off, truth)) == StressVerdict.wrong_warned


def test_rates_that_are_off(solved: tuple[Found, Truth]) -> None:
    found, truth = solved
    fast = found.values["D.theta_dot"][0, ROW] + 1e-5
    assert verdict(judge(spoilt(found, "D.theta_dot", fast), truth)) == StressVerdict.rates_lost


@pytest.mark.parametrize("key", ["C.force.y", "A.effort"])
def test_forces_that_are_off(key: str) -> None:
    block = drawn(FAMILIES["forces"], 1, [0])
    truth = block.truth(block.places)
    found, _, _ = solve(block.texts, block.places.shape[1], truth.cells())
    assert verdict(judge(found, truth)) == StressVerdict.right
    off = float(truth.heaviest[0, ROW] * truth.size[0, 0]) * 1e-6  # type: ignore[index]
    assert off > 0.0
    near = found.values[key][0, ROW] * (1.0 + 1e-5) + off
    assert verdict(judge(spoilt(found, key, near), truth)) == StressVerdict.rates_lost
    assert verdict(judge(spoilt(found, key, np.nan), truth)) == StressVerdict.rates_lost


def test_a_row_that_is_lost(solved: tuple[Found, Truth]) -> None:
    found, truth = solved
    codes = found.codes.copy()
    codes[0, ROW] = Status.branch_lost
    assert verdict(judge(replace(found, codes=codes), truth)) == StressVerdict.false_alarm


def test_a_row_that_cannot_be(solved: tuple[Found, Truth]) -> None:
    found, truth = solved
    exists = truth.exists.copy()
    exists[0, ROW] = False
    assert verdict(judge(found, replace(truth, exists=exists))) == StressVerdict.false_ok


def test_what_a_run_says_it_takes_as_drawn_is_no_fault(solved: tuple[Found, Truth]) -> None:
    found, truth = solved
    noted = replace(spoilt(found, "D.theta", 1.0), noted=np.ones((1, 1), bool))
    assert verdict(judge(noted, truth)) == StressVerdict.taken_as_drawn


@pytest.mark.parametrize("key", ["D.theta", "D.theta_dot", "D.theta_ddot", "C.force.y", "A.effort"])
def test_an_enclosure_beside_the_closed_form(key: str) -> None:
    block = drawn(FAMILIES["forces"], 1, [0])
    truth = block.truth(block.places)
    found, proofs, _ = solve(block.texts, block.places.shape[1], truth.cells(), proven=[0])
    assert (proofs.codes[0, : ROW + 1] == Proof.proven).all()
    assert block.written is not None
    written = block.written(block.places)
    assert not contradicted(proofs, found, truth, written).any()
    cells = np.array([proofs.low[key][0, ROW], proofs.high[key][0, ROW]])
    # beside the true value by twice the width of the enclosure, or some roundings
    off = 2.0 * (cells[1] - cells[0]) + 4.0 * np.spacing(np.abs(cells).max())
    for side in (proofs.low, proofs.high):
        side[key][0, ROW] += off
    assert np.flatnonzero(contradicted(proofs, found, truth, written)[0]).tolist() == [ROW]


def test_a_proof_of_a_row_that_cannot_be() -> None:
    block = drawn(FAMILIES["sizes"], 1, [0])
    truth = block.truth(block.places)
    found, proofs, _ = solve(block.texts, block.places.shape[1], truth.cells(), proven=[0])
    exists = truth.exists.copy()
    exists[0, ROW] = False
    assert block.written is not None
    written = block.written(block.places)
    wrong = contradicted(proofs, found, replace(truth, exists=exists), written)
    assert np.flatnonzero(wrong[0]).tolist() == [ROW]


def test_parts_of_a_family_add_up_to_the_whole() -> None:
    whole = run_block("many turns", 3, [0, 3, 6])
    parts = Tally("many turns")
    for number in (6, 0, 3):
        parts.merge(of_record(run_block("many turns", 3, [number]).record()))
    assert parts.in_order().record() == whole.in_order().record()


def test_a_file_that_is_refused_ends_no_other() -> None:
    block = drawn(FAMILIES["sizes"], 1, [0])
    truth = block.truth(block.places)
    texts = ["format: 2\n", block.texts[0]]
    found, _, refused = solve(texts, block.places.shape[1], truth.cells())
    assert list(refused) == [0]
    assert "InvalidFile" in refused[0]
    assert (found.codes[0] == Status.not_assembled).all()
    assert (found.codes[1, : ROW + 1] == Status.ok).all()
