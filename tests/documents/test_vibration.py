"""What docs/vibration.md shows is what comes out."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest
from documents.reading import blocks, page

import mechkin_cli as mk
from mechkin_cli.__main__ import main

ROOT = Path(__file__).parents[2]
PAGE = page("docs/vibration.md")


def ran(words: str, monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    monkeypatch.setattr(sys, "argv", [*shlex.split(words), "--out", str(folder)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code


def test_commands(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(ROOT)
    first, last = (text.strip() for text in blocks(PAGE, "bash"))
    ran(first, monkeypatch, tmp_path)
    (shown,) = blocks(PAGE, "text")
    assert capfd.readouterr().out.strip() == shown.strip()
    ran(last, monkeypatch, tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    told = set(re.findall(r"`([a-zA-Z]+\.(?:csv|svg))`", PAGE))
    assert names == told


def test_the_picture() -> None:
    model = mk.load(ROOT / "mechanisms" / "vibration" / "engine_mounts.yaml")
    shown = (ROOT / "docs" / "engine_modes.svg").read_text(encoding="utf-8")
    assert shown == model.vibration(row=2).picture()


def test_the_script(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(ROOT)
    (script,) = blocks(PAGE, "python")
    found: dict = {}
    exec(script, found)
    frequencies = found["v"].frequencies
    assert f"{frequencies[0]:.5g}" == "6.7595"
    assert found["answer"].amplitude.shape == (1, 50)
    assert found["s"].C.shape == (2, 12)
    # stiffer mounts, higher modes
    assert (found["v"].sensitivity("k") > -1e-9).all()
    assert np.isfinite(found["v"].effective_stiffness("sump.position.z"))
