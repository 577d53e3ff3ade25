"""The example of the page on mechanisms in a plane gives what it shows."""

from pathlib import Path

import pytest
from documents.reading import blocks, page

from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files


def test_what_the_example_prints(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (text,), (table,) = (blocks(page("docs/planar.md"), language) for language in ("yaml", "text"))
    monkeypatch.chdir(tmp_path)
    Path("shaper.yaml").write_text(text, encoding="utf-8")
    analyze_files(AnalyzeCommand([Path("shaper.yaml")], None, []))
    assert capsys.readouterr().out == f"{table}\n"
