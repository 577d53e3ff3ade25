"""The mechanisms that are measured where no file is named."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from benchmarks import rcsr, sevenr, train
from mechkin_cli.bench.scene import BenchScene
from mechkin_cli.model import loads

FOLDER = Path(__file__).parent / "mechanisms"

RCSR_MOTION = "from: 150 deg, to: 202 deg, step: 0.25 deg"
PLATFORM_ROWS = 201
LAWS = ("cycloidal", "harmonic")
"""Of the platform's legs, by turns."""


def texts() -> dict[str, Callable[[], str]]:
    """The files by the mechanisms' names."""
    return {
        "RCSR": lambda: rcsr.dimensions().text(RCSR_MOTION),
        "RSSR": lambda: _kept("rssr"),
        "7R": sevenr.text,
        "RCSR-CSR": lambda: _kept("rcsr_csr"),
        "RCHCH": lambda: _kept("rchch"),
        "Stewart": lambda: _kept("stewart"),
        "ten-loop train": train.text,
        "platform on laws": lambda: platform(PLATFORM_ROWS),
    }


def known_scenes() -> list[BenchScene]:
    """The same, read, checked and closed."""
    return [BenchScene(name, loads(text(), name)) for name, text in texts().items()]


def platform(rows: int) -> str:
    """The Stewart platform whose legs move by laws of time, along a curved path."""
    text = re.sub(
        r"L(\d)\.s: \{from: 0, to: (\S+), count: \d+, rate: \S+\}",
        lambda m: f"L{m[1]}.s: {{law: {LAWS[int(m[1]) % 2]}, from: 0, to: {m[2]}}}",
        _kept("stewart"),
    )
    return text.replace("motion:\n", f"motion:\n  time: {{from: 0, to: 1, count: {rows}}}\n")


def _kept(name: str) -> str:
    return (FOLDER / f"{name}.yaml").read_text(encoding="utf-8")
