"""Blocks of responses are those of the whole run, bit for bit, whatever their size: the march takes
the same steps."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest
from references import FILE_OF
from streams.motions import BENT, REDUNDANT

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.__main__ import main
from mechkin_cli.analysis import ended
from mechkin_cli.response.march import March
from mechkin_cli.sweep import RunVerdicts
from mechkin_cli.tables import TableColumn, Words, rows_table

PENDULUM = """format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{bob: {{mass: 1, center_of_mass: [0, -1], inertia: 0.1}}}}
joints: {{O: {{type: R, links: [ground, bob], point: [0, 0]}}}}
loads: [{{type: gravity, g: [0, -9.80665]}}]
responses:
  swing:
    start: {{O.theta: 1}}
    time: {{from: 0, to: {to}, count: {count}}}
    stop: [{stop}]
tables:
  - name: t
    run: swing
    columns: [time, O.theta, O.theta_dot, O.force.y, row.event, row.work, row.energy_error]
    summary: [max, min, mean, rms]
"""
DOUBLE = """format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [0.5, 0], inertia: 0.1}
  two: {mass: 2, center_of_mass: [1.5, 0], inertia: 0.2}
joints:
  A: {type: R, links: [ground, one], point: [0, 0]}
  B: {type: R, links: [one, two], point: [1, 0]}
loads:
  - {type: gravity, g: [0, -9.80665]}
  - {type: friction, joint: A, coefficient: 0.3, radius: 0.1}
responses:
  fall: {start: {A.theta: 0.3, B.theta: 1}, time: {from: 0, to: 3, count: 101}}
tables:
  - {name: t, run: fall, columns: [time, A.theta, B.theta, B.force.x, row.dissipated]}
"""
DRIVEN = """format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [0.5, 0], inertia: 0.1}
  two: {mass: 2, center_of_mass: [1.5, 0], inertia: 0.2}
joints:
  A: {type: R, links: [ground, one], point: [0, 0]}
  B: {type: R, links: [one, two], point: [1, 0]}
loads: [{type: gravity, g: [0, -9.80665]}]
responses:
  pull:
    start: {B.theta: 1}
    driven:
      A.theta:
        law: sequence
        from: 0.3
        segments:
          - {for: 0.5, to: 2.3, law: cycloidal}
          - {for: 0.5, law: dwell}
          - {for: 1, to: 0.3, law: harmonic}
    time: {from: 0, to: 2, count: 61}
tables:
  - {name: t, run: pull, columns: [time, A.theta, B.theta, B.theta_ddot, A.effort, row.work]}
"""
LOST = """format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {bob: {mass: 1, center_of_mass: [0, -1], inertia: 0.1}}
joints: {O: {type: R, links: [ground, bob], point: [0, 0]}}
loads: [{type: force, link: bob, point: [0, -1], force: [1 N * sqrt(2 - time / 1 s), 0]}]
responses:
  swing: {start: {O.theta: 0}, time: {from: 0, to: 4, count: 41}}
tables: [{name: t, run: swing, columns: [time, O.theta, row.status]}]
"""
LIMITED = PENDULUM.format(to=3, count=61, stop="") + "limits: {O.theta: {min: -0.5, max: 1.5}}\n"
TEXTS = {
    "to the end": PENDULUM.format(to=3, count=61, stop=""),
    "a stop between rows": PENDULUM.format(
        to=9, count=91, stop="{value: O.theta, at: 0, count: 3}"
    ),
    # the speed is zero at the start, and the swing ends where it began
    "a stop at a row": PENDULUM.format(to=4, count=41, stop="{value: time, at: 2.5 s}"),
    "friction": DOUBLE,
    "a drive": DRIVEN,
    "rows that are not reached": LOST,
    "redundant constraints": REDUNDANT,
    "a slope that jumps": BENT,
    # a row at the jump; and thrown up from it, back to it in the first row of a block of 10
    "a slope that jumps at a row": BENT.replace(
        "{A.theta: -1, A.theta_dot: 1}", "{A.theta: -0.9, A.theta_dot: 1}"
    ).replace("value: 1}]\n", "value: 0}]\n"),
    "a slope that jumps at a border": BENT.replace(
        "{A.theta: -1, A.theta_dot: 1}", "{A.theta: 0.1, A.theta_dot: 0.5}"
    ).replace("value: 1}]\n", "value: -1.045}]\n"),
    "a slope that would jump later": BENT.replace("0.1 rad", "9 rad"),
    "a limit": LIMITED,
    "a limit at the start": LIMITED.replace("max: 1.5", "max: 1").replace(
        "start: {O.theta: 1}", "start: {O.theta: 1, O.theta_dot: 1}"
    ),
    "rcsr": FILE_OF["rcsr_response"].read_text(encoding="utf-8"),
}


def cells(column: TableColumn) -> list[str] | list[bytes]:
    if isinstance(column.values, Words):
        return [str(text) for text in column.values.array()]
    return [value.tobytes() for value in np.asarray(column.numbers)]


def small_blocks(monkeypatch: pytest.MonkeyPatch, rows: int) -> None:
    monkeypatch.setattr(tolerances, "PART_ROWS", rows)
    monkeypatch.setattr(tolerances, "LEAST_PART_ROWS", rows)


@pytest.mark.parametrize("rows", [1, 2, 5, 7, 10, 20])
@pytest.mark.parametrize("name", TEXTS)
def test_blocks_have_the_bytes_of_the_run(
    name: str, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = mk.loads(TEXTS[name])
    (run,) = (one for one in model.runs if one != "sweep")
    whole = model.respond(run)
    tables = [*whole.tables, rows_table(whole.result, run)]
    expected = {(t.name, c.label): cells(c) for t in tables for c in t.columns}
    small_blocks(monkeypatch, rows)
    stream = model.stream(run=run, rows=3)
    assert stream.in_blocks
    found: dict[tuple[str, str], list] = defaultdict(list)
    for block in stream:
        for table in block.tables:
            for column in table.columns:
                assert len(cells(column)) == block.rows <= 3
                found[table.name, column.label] += cells(column)
    for part, _ in stream.parts():
        verdicts = rows_table(part.analysis.result, run)
        first = part.analysis.result.row_states.span.first
        for column in verdicts.columns:
            number = column.label == "row"
            numbered = column.with_values(column.numbers + first) if number else column
            found[verdicts.name, column.label] += cells(numbered)
    assert found == expected
    assert stream.run_rows == whole.rows == stream.verdicts.rows
    assert stream.verdicts.complete == whole.complete
    assert list(map(str, stream.diagnostics)) == list(map(str, whole.diagnostics))


@pytest.mark.parametrize(
    ("name", "asked", "marches"),
    [
        ("to the end", ["O.theta"], 1),
        ("rows that are not reached", ["O.theta"], 1),
        ("friction", ["A.theta"], 1),
        # how many rows there are
        ("a stop between rows", ["O.theta"], 2),
        # what is measured by energies of all rows
        ("to the end", ["O.theta", "row.energy_error"], 2),
        # whether it comes to a place at which a slope jumps, and then how many rows there are
        ("a slope that would jump later", ["A.theta"], 2),
        ("a slope that jumps", ["A.theta"], 3),
    ],
)
@pytest.mark.parametrize("rows", [1, 7, 41, 61])
def test_a_motion_is_gone_through_once(
    name: str, asked: list[str], marches: int, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is said of the whole run is known when its last row has been taken."""
    text = TEXTS[name]
    model = mk.loads(text)
    (run,) = model.runs
    whole = model.respond(run, asked, tables=[])
    expected = ended(whole.result)
    worst = RunVerdicts.of(whole.result)
    worst.measure("energy error", np.asarray(whole.result.energy_error))
    begun = []
    march = March.__init__

    def counted(self: March, *args: object) -> None:
        begun.append(1)
        march(self, *args)  # type: ignore[arg-type]

    small_blocks(monkeypatch, rows)
    monkeypatch.setattr(March, "__init__", counted)
    stream = model.stream(asked, run=run, tables=[], rows=5)
    values = np.concatenate([block[asked[0]] for block in stream])
    assert values.tobytes() == whole[asked[0]].tobytes()
    assert stream.ended == expected
    assert stream.verdicts.worst == worst.worst
    assert stream.verdicts.counts == worst.counts
    assert list(map(str, stream.diagnostics)) == list(map(str, whole.diagnostics))
    assert len(begun) == (marches if stream.in_blocks else 0)
    if "row.energy_error" not in asked and stream.in_blocks:
        # asked for later, it is measured by all rows all the same
        errors = np.concatenate([block["row.energy_error"] for block in stream])
        assert errors.tobytes() == whole.result.energy_error.tobytes()


def test_a_block_has_the_closed_form() -> None:
    """A body that falls from rest; 3 * 10^5 rows lie within a few steps."""
    text = PENDULUM.format(to=2, count=300_001, stop="").replace(
        "type: R, links: [ground, bob], point: [0, 0]",
        "type: P, links: [ground, bob], point: [0, 0], axis: [0, -1]",
    )
    text = text.replace("O.theta: 1", "O.s: 0").replace("O.theta", "O.s").split("tables:")[0]
    stream = mk.loads(text).stream(["O.s", "row.work"], run="swing", rows=100_000)
    assert stream.in_blocks
    first = 0
    for block in stream:
        assert block.first == first
        assert np.array_equal(block["time"], np.arange(first, first + block.rows) / 150_000)
        fallen = 0.5 * 9.80665 * block["time"] ** 2
        assert np.abs(block["O.s"] - fallen).max() < 1e-13 * fallen.max()
        first += block.rows
    assert first == 300_001


def test_who_leaves_ends_the_march(monkeypatch: pytest.MonkeyPatch) -> None:
    small_blocks(monkeypatch, 2)
    stream = mk.loads(TEXTS["to the end"]).stream(run="swing", rows=2)
    first = next(iter(stream))["O.theta"].tobytes()
    blocks = iter(stream)
    assert next(blocks)["O.theta"].tobytes() == first
    blocks.close()  # type: ignore[attr-defined]
    assert sum(block.rows for block in stream) == 61


ABANDONED = """
import sys
import mechkin_cli as mk
from mechkin_cli import tolerances
tolerances.PART_ROWS = tolerances.LEAST_PART_ROWS = 2
blocks = iter(mk.loads(sys.stdin.read()).stream(run="swing", rows=2))
print(next(blocks).rows)
"""


def test_a_program_may_end_before_its_stream() -> None:
    """The thread that marches on does not come back to an interpreter that has ended."""
    for _ in range(3):
        words = [sys.executable, "-P", "-c", ABANDONED]
        ended = subprocess.run(
            words, input=TEXTS["to the end"], capture_output=True, text=True, check=False
        )
        assert (ended.returncode, ended.stdout, ended.stderr) == (0, "2\n", "")


def test_too_many_rows_are_not_held(monkeypatch: pytest.MonkeyPatch) -> None:
    model = mk.loads(TEXTS["to the end"])
    monkeypatch.setattr(tolerances, "MOST_NUMBERS", 100)
    with pytest.raises(mk.UsageError, match=r"swing has too many rows .* 61 .*stream\(run"):
        model.respond("swing")
    small_blocks(monkeypatch, 10)
    assert sum(block.rows for block in model.stream(run="swing")) == 61


def run(monkeypatch: pytest.MonkeyPatch, *words: str) -> None:
    monkeypatch.setattr("sys.argv", ["mechkin", "analyze", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code


@pytest.mark.parametrize("more", [1, 40_000])
def test_the_command_writes_and_prints_what_it_does_of_a_whole_run(
    more: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Files and what is printed are those of the whole run, which `md` needs."""
    count = tolerances.LONG_RUN + more
    path = tmp_path / "f.yaml"
    stop = "{value: O.theta, at: 0, count: 4}"
    path.write_text(PENDULUM.format(to=5, count=count, stop=stop))
    printed = []
    for name, formats in (("streamed", "csv"), ("whole", "csv,md")):
        run(monkeypatch, str(path), "--format", formats, "--out", str(tmp_path / name))
        printed.append(capsys.readouterr().out.replace(str(tmp_path / name), "out"))
    assert printed[0] == printed[1]
    for file in ("t.csv", "t.summary.csv", "swing.rows.csv"):
        streamed = (tmp_path / "streamed" / file).read_bytes()
        assert streamed == (tmp_path / "whole" / file).read_bytes()


def test_a_response_is_summed_up_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "f.yaml"
    path.write_text(TEXTS["to the end"])
    run(monkeypatch, str(path), "--out", str(tmp_path / "whole"))
    capsys.readouterr()
    run(monkeypatch, str(path), "--summary-only", "--out", str(tmp_path / "o"))
    assert re.search(r"\n +rows( +61)+\n", capsys.readouterr().out)
    assert {file.name for file in (tmp_path / "o").iterdir()} == {"t.summary.csv", ".mechkin-files"}
    summary = (tmp_path / "o" / "t.summary.csv").read_bytes()
    assert summary == (tmp_path / "whole" / "t.summary.csv").read_bytes()


def test_equilibria_are_written_beside_what_is_summed_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = TEXTS["to the end"].replace(
        "tables: [", "tables: [{name: low, run: low, columns: [O.theta, row.event]}, "
    )
    path = tmp_path / "f.yaml"
    path.write_text(text + "equilibria: {low: {near: {O.theta: 0.2}}}\n")
    run(monkeypatch, str(path), "--summary-only", "--out", str(tmp_path / "o"))
    assert "low" in capsys.readouterr().out
    names = {file.name for file in (tmp_path / "o").iterdir()}
    assert names == {"t.summary.csv", "low.csv", "low.rows.csv", ".mechkin-files"}
