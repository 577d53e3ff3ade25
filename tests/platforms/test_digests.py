"""What compares the bytes of platforms sees a difference of one bit."""

from __future__ import annotations

from pathlib import Path

import pytest
from platforms import digests

STEM = "plane/slider_crank"


def test_a_bit_is_seen(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.argv", ["digests"])
    monkeypatch.setattr(digests, "stems", lambda: [STEM])
    known, copy = tmp_path / "known.txt", tmp_path / "mechanisms"
    digests.write(known)
    assert digests.compare(known, [], "--lanes", "2") == 0
    file = copy / f"{STEM}.yaml"
    file.parent.mkdir(parents=True)
    text = (digests.MECHANISMS / f"{STEM}.yaml").read_text(encoding="utf-8")
    length = "rod: 0.35 m"
    assert length in text
    file.write_text(text.replace(length, "rod: 0.35000000000000003 m"), encoding="utf-8")
    monkeypatch.setattr(digests, "MECHANISMS", copy)
    assert digests.compare(known, ["slider_crank"]) == 1
    assert "DIFFERENT" in capsys.readouterr().out
