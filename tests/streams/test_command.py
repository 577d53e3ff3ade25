"""What the command writes and prints of sweeps whose rows are not held."""

from __future__ import annotations

from pathlib import Path

import pytest
from references import FILE_OF

from mechkin_cli import tolerances
from mechkin_cli.__main__ import main

FOUR_BAR = """format: 1
plane: xy
units: {{length: m, angle: deg}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, coupler], point: [0, 1]}}
  C: {{type: R, links: [coupler, rocker], point: [4, 3]}}
  D: {{type: R, links: [ground, rocker], point: [4, 0]}}
motion: {{inputs: {{A.theta: {{from: -90, to: 630, count: {count}}}}}}}
tables:
  - {{name: t, columns: [A.theta, D.theta, row.status], summary: [max, min, mean, rms]}}
"""


def run(monkeypatch: pytest.MonkeyPatch, *words: str) -> None:
    monkeypatch.setattr("sys.argv", ["mechkin", "analyze", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code


@pytest.mark.parametrize("more", [1, 2, 3, 29, 30, 31, 100])
def test_the_last_part_may_have_few_rows(
    more: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Files and what is printed are those of the whole run, which `md` needs."""
    path = tmp_path / "f.yaml"
    path.write_text(FOUR_BAR.format(count=tolerances.LONG_RUN + more))
    printed = []
    for name, formats in (("streamed", "csv"), ("whole", "csv,md")):
        run(monkeypatch, str(path), "--format", formats, "--out", str(tmp_path / name))
        printed.append(capsys.readouterr().out.replace(str(tmp_path / name), "out"))
    assert printed[0] == printed[1]
    for file in ("t.csv", "t.summary.csv", "rows.csv"):
        streamed = (tmp_path / "streamed" / file).read_bytes()
        assert streamed == (tmp_path / "whole" / file).read_bytes()


@pytest.mark.parametrize("name", ["rcsr", "planar_four_bar", "slider_crank"])
def test_a_short_sweep_is_summed_up(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(monkeypatch, str(FILE_OF[name]), "--summary-only", "--quiet", "--out", str(tmp_path / "o"))
    written = {file.name for file in (tmp_path / "o").iterdir()} - {".mechkin-files"}
    assert written
    assert all(file.endswith(".summary.csv") for file in written)
