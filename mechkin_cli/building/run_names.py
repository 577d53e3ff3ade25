"""Runs that a file names: the sweep and its responses."""

from __future__ import annotations

from collections.abc import Collection

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.runs import SWEEP
from mechkin_cli.schema.file import MechanismFile


def runs_of(file: MechanismFile) -> tuple[str, ...]:
    """The runs of a file by name, the sweep first; a file of responses alone has no sweep."""
    swept = file.motion is not None or not file.responses
    return (*((SWEEP,) if swept else ()), *file.responses)


def unknown_run(fields: Fields, path: Path, name: str, known: Collection[str]) -> None:
    """Notes that the name at `path` is no run."""
    if name == SWEEP:
        text, hint = "there is no sweep: the file has no motion:", "name a response, or add motion:"
    else:
        text = f"there is no run {name}"
        hint = nearest_hint(name, list(known)) or f"runs are {', '.join(known)}"
    fields.error("unknown-run", path, text, hint)
