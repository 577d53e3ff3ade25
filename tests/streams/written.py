"""What `mechkin analyze` prints and writes of a long run, streamed and held whole."""

from __future__ import annotations

from pathlib import Path

import pytest

from mechkin_cli.__main__ import main
from mechkin_cli.cli import long_runs


def written_alike(
    folder: Path, text: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> set[str]:
    """The names of the CSV files of a run, which are the same both ways, as is what is printed."""
    path = folder / "f.yaml"
    path.write_text(text)
    printed, files = [], []
    for way in ("streamed", "whole"):
        if way == "whole":
            monkeypatch.setattr(long_runs, "streamed_runs", lambda *_: [])
        words = ["mechkin", "analyze", str(path), "--out", str(folder / way), "--format", "csv"]
        monkeypatch.setattr("sys.argv", words)
        with pytest.raises(SystemExit) as ended:
            main()
        assert not ended.value.code
        printed.append(capsys.readouterr().out.replace(str(folder / way), "out"))
        own = sorted((folder / way).iterdir())
        files.append({file.name: file.read_bytes() for file in own if file.suffix == ".csv"})
    assert printed[0] == printed[1]
    assert files[0] == files[1]
    return set(files[0])
