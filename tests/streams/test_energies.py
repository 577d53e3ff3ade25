"""Energies of sweeps whose rows pass by are those of all rows at once, bit for bit: their integrals
carry over the borders of parts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from derived.test_energy_ledger import BLOCK, NAMES, SLIDER
from streams.written import written_alike
from sweep.cut import cut

import mechkin_cli as mk
from mechkin_cli import tolerances

BALL = SLIDER.replace("C: {{type: R,", "C: {{type: S,").replace(
    ", axis: [0, 0, 1]}}\n  D", "}}\n  D"
)
TEXTS = {
    "a slider": SLIDER.format(count=51),
    "a block that turns round": BLOCK.format(count=61),
    "few rows": BLOCK.format(count=19),
    "balls": BALL.format(count=31)
    + "  - {type: friction, joint: C, coefficient: 0.1, radius: 10 mm}\n",
    "lost rows": SLIDER.format(count=61)
    .replace("[0.1, 0, 0]", "[0.31, 0, 0]")
    .replace("point: [0.4, 0, 0]", "point: [0.6, 0, 0]"),
}

TEXTS["lost rows and friction"] = (
    TEXTS["lost rows"].replace("count: 61", "count: 37")
    + "  - {type: friction, joint: A, coefficient: 0.2, radius: 0.01}\n"
)


@pytest.mark.parametrize("rows", [4, 5, 8, 16])
@pytest.mark.parametrize("name", TEXTS)
def test_integrals_carry_over_borders(
    name: str, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    once = mk.loads(TEXTS[name]).analyze(NAMES)
    cut(monkeypatch, rows)
    model = mk.loads(TEXTS[name])
    whole = model.analyze(NAMES)
    stream = model.stream(NAMES, rows=7)
    assert stream.in_blocks
    found = [[block[each] for each in NAMES] for block in stream]
    for number, each in enumerate(NAMES):
        values = np.concatenate([block[number] for block in found])
        assert values.tobytes() == whole[each].tobytes()
        # a run in one part has the same up to the rounding of its states
        assert np.array_equal(np.isnan(values), np.isnan(once[each]))
        assert np.abs(np.nan_to_num(values - once[each])).max() < 1e-11
    assert {str(one) for one in stream.diagnostics} == {str(one) for one in whole.diagnostics}
    assert stream.verdicts.rows == whole.rows


def test_what_is_known_behind_the_run_alone_is_not_guessed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A block has no energies that were not asked for, as its rows do not tell them."""
    cut(monkeypatch, 8)
    block = next(iter(mk.loads(TEXTS["a slider"]).stream(["A.theta"], rows=7)))
    with pytest.raises(mk.UsageError, match="depend on all rows before it"):
        _ = block["row.work"]


def test_the_run_is_made_as_often_as_its_end_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    cut(monkeypatch, 8)
    from mechkin_cli.sweep import sweep

    begun = []
    parts = sweep.parts_of
    monkeypatch.setattr(sweep, "parts_of", lambda *given: (begun.append(1), parts(*given))[1])
    for name, asked, times in (
        ("a slider", ["A.theta"], 1),
        ("a slider", ["row.work", "row.dissipated"], 1),
        ("a slider", NAMES, 2),
        ("a block that turns round", ["row.work"], 2),
        ("a block that turns round", NAMES, 3),
    ):
        begun.clear()
        for _ in mk.loads(TEXTS[name]).stream(asked, rows=7):
            pass
        assert len(begun) == times, (name, asked)
        begun.clear()
        mk.loads(TEXTS[name]).analyze(asked)
        assert len(begun) == 1 + (name != "a slider"), (name, asked)


@pytest.mark.parametrize("name", ["a slider", "a block that turns round"])
def test_the_command_writes_what_it_does_of_a_whole_run(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    count = tolerances.LONG_RUN + 3
    text = (SLIDER if name == "a slider" else BLOCK).format(count=count)
    columns = "time, row.work, row.dissipated, row.energy_error"
    text += f"tables: [{{name: t, columns: [{columns}], summary: [max, mean]}}]\n"
    assert len(written_alike(tmp_path, text, monkeypatch, capsys)) == 3
