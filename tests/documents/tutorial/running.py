"""Runs the steps of the tutorial in a folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from documents.tutorial.steps import Step, Written, steps

INSTALLED = f'mechkin() {{ "{sys.executable}" -P -m mechkin_cli "$@"; }}\n'
"""The command of the environment that runs this, whatever the path says."""


def runs(
    folder: Path, prelude: str = INSTALLED, *, install: bool = False
) -> Iterator[tuple[Step, str]]:
    """Each step with what it printed; without `install` the first, which installs, is left out."""
    for number, step in enumerate(steps()):
        if isinstance(step, Written):
            (folder / step.name).write_text(step.text, encoding="utf-8")
        elif number or install:
            yield step, printed(folder, prelude + step.commands)


def printed(folder: Path, script: str) -> str:
    """What commands print on both streams.

    Raises:
        subprocess.CalledProcessError: one of them failed.
    """
    return subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script],
        cwd=folder,
        env=os.environ | {"PYTHONUNBUFFERED": "1", "COLUMNS": "100"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=True,
    ).stdout


def comparable(text: str) -> str:
    """The text without the size of the page that shows a mechanism, which grows with the page."""
    return re.sub(r"\d+ kB", "some kB", text)
