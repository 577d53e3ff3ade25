"""Rates up to jerks of proven rows lie in their enclosures, at 60 digits; forces of random
mechanisms: tests/properties/test_enclosures.py."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracle import solve
from proofs.test_boxes import DEGREE, ROWS, certificate, mechanism
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.analysis.certificate import not_enclosed
from mechkin_cli.proofs import rows as proven_rows

DOUBLES = 1e-13
"""Of the largest of a quantity: what doubles leave, and what bounds in doubles are apart."""


def solution(name: str, row: int) -> Any:
    analysis, guess = certificate(name).analysis, {}
    for joint, its in mechanism(name).joints.items():
        for coordinate in its.coordinates:
            value = float(analysis[f"{joint}.{coordinate}"][row])
            guess[f"{joint}.{coordinate}"] = value * (DEGREE if coordinate == "theta" else 1)
    return solve(mechanism(name), mechanism(name).row(row), guess)


@pytest.mark.parametrize("name", ["rcsr", "sevenr", "rchch", "rcrcr", "rprhrrr"])
def test_true_rates_up_to_jerks_are_enclosed(name: str) -> None:
    proofs = certificate(name)
    found = {
        f"{joint}.{coordinate}{suffix}": proofs.enclosure(f"{joint}.{coordinate}{suffix}")
        for joint, its in mechanism(name).joints.items()
        for coordinate in its.coordinates
        for suffix in ("_dot", "_ddot", "_dddot")
    }
    for row in ROWS:
        true = solution(name, row)
        for quantity, (low, high) in found.items():
            assert low[row] <= true[quantity] <= high[row], (row, quantity)
            assert high[row] - low[row] <= DOUBLES * max(abs(high[row]), 1e-3)


def test_vectors_and_efforts_have_bounds() -> None:
    proofs = mk.load(RCSR).certify()
    for name, shape in (("O2.force", (27, 3)), ("O1.effort", (27,)), ("O4.theta", (27,))):
        low, high = proofs.enclosure(name)
        assert low.shape == high.shape == shape
        off = DOUBLES * np.abs(low).max()
        assert (low <= proofs.analysis[name] + off).all()
        assert (proofs.analysis[name] <= high + off).all()
        assert (high - low <= DOUBLES * np.abs(high)).all()


def test_components_are_those_of_their_vector() -> None:
    proofs = mk.load(RCSR).certify()
    names = ["O2.force", "O2.force.x", "O3.point.z", "O3.point"]
    found = proofs.enclosures(names)
    assert list(found) == names
    for name, vector, place in (("O2.force.x", "O2.force", 0), ("O3.point.z", "O3.point", 2)):
        for part, whole in zip(found[name], proofs.enclosure(vector), strict=True):
            np.testing.assert_array_equal(part, whole[:, place])
        assert not proofs.not_enclosed(name)
    for name in ("O3.point.w", "O4.theta.x", "O3.point.", "O3.point.xy", "O3.point.x.x"):
        with pytest.raises(mk.UsageError, match="is no quantity of this mechanism"):
            proofs.enclosure(name)


def test_reactions_that_are_not_unique_have_none() -> None:
    proofs = mk.load(FILE_OF["bennett"]).certify()
    low, high = proofs.enclosure("A.force")
    assert np.isnan(low).all()
    assert np.isnan(high).all()
    (note,) = proofs.not_enclosed("A.force")
    assert note.code == "not-enclosed"
    assert f"A.force has no bounds in {len(low)} rows from 1 to {len(low)}" in note.message
    assert "not unique" in note.message


def test_nothing_is_told_where_all_rows_have_bounds() -> None:
    for name in ("O2.force", "O1.effort", "O4.theta"):
        assert certificate("rcsr").not_enclosed(name) == ()


def test_a_row_outside_its_box_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted: the text's input of one row lies elsewhere."""
    inside = proven_rows._are_inside

    def but_one(session: Any, given: Any) -> Any:
        found = inside(session, given)
        assert found.all()
        return found & (np.arange(found.size) != 4)

    monkeypatch.setattr(proven_rows, "_are_inside", but_one)
    proofs = mk.load(RCSR).certify()
    low, high = proofs.enclosure("O4.theta_dot")
    assert np.flatnonzero(np.isnan(low) | np.isnan(high)).tolist() == [4]
    (note,) = proofs.not_enclosed("O4.theta_dot")
    assert "no bounds in row 5, proven as that is: the input is farther" in note.message


def test_each_row_without_bounds_has_one_reason() -> None:
    """Of five rows: bounded, not proven, and one for each reason."""
    yes, no = True, False
    notes = not_enclosed(
        "X.force",
        proven=np.array([yes, no, yes, yes, yes]),
        has_value=np.array([yes, no, no, yes, yes]),
        is_inside=np.array([yes, no, no, no, yes]),
        bounded=np.array([yes, no, no, no, no]),
    )
    words = ("not unique", "farther from what the file's text says", "not bounded over the row's")
    assert len(notes) == 3
    for row, note, reason in zip((3, 4, 5), notes, words, strict=True):
        assert f"in row {row}," in note.message
        assert reason in note.message


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("no.such", "is no quantity"),
        ("row.condition", "not enclosed: a verdict"),
        ("row.proof", "is no quantity"),
        ("coupler.screw_pitch", "not enclosed: computed from other quantities"),
    ],
)
def test_what_is_not_enclosed_is_refused_with_the_reason(name: str, why: str) -> None:
    with pytest.raises(mk.UsageError, match=why):
        certificate("rcsr").enclosure(name)


@pytest.mark.parametrize(
    ("addition", "why"),
    [
        ("loads:\n  - {type: friction, joint: O4, coefficient: 0.1, radius: 5 mm}", "friction"),
        ("actuators: [O4.theta]\nloads:", "actuators"),
    ],
)
def test_forces_that_are_decided_in_doubles_are_refused_with_the_reason(
    addition: str, why: str
) -> None:
    text = RCSR.read_text(encoding="utf-8").split("\ntables:")[0]
    proofs = mk.loads(text.replace("\nloads:", f"\n{addition}", 1)).certify()
    with pytest.raises(mk.UsageError, match=why):
        proofs.enclosure("O2.force")
    assert np.isfinite(proofs.enclosure("O2.theta_dddot")[0]).all()


def test_forces_are_enclosed_where_an_input_is_held_at_zero() -> None:
    """Zero times a unit is enclosed with a radius, by which its box has to reach."""
    m = mk.load(Path(__file__).parents[2] / "mechanisms" / "vibration" / "engine_mounts.yaml")
    proofs = m.certify()
    for name in ("pose.rx.effort", "front_left.force"):
        low, high = proofs.enclosure(name)
        values = np.asarray(m.analyze([name])[name])
        off = DOUBLES * np.abs(values).max()
        assert ((low - off < values) & (values < high + off)).all()
        assert (high - low < 1e-9 * np.abs(values).max()).all()
        assert not proofs.not_enclosed(name)
