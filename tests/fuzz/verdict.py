"""What must hold for any bytes: a model, or a refusal whose places lie inside the text."""

from __future__ import annotations

import json

from work import calls

import mechkin_cli as mk
from mechkin_cli.reading.text import decoded, lines_of

FILE = "fuzz.yaml"
MOST_CALLS = 3_000_000
"""Of functions for the bytes of one file; the largest sound one takes 110 000."""


def verdict(content: bytes) -> str:
    """Reads and builds a mechanism file: 'model' or the code of the first refusal.

    Whatever else is raised is a defect, as is a place outside the text or a slow answer.
    """
    diagnostics: tuple[mk.Diagnostic, ...] = ()

    def answer() -> None:
        nonlocal diagnostics
        try:
            mk.loads(decoded(content, FILE), FILE)
        except mk.InvalidFile as invalid:
            diagnostics = invalid.diagnostics
        for diagnostic in diagnostics:
            check(diagnostic, content)

    count = calls(answer)
    assert count < MOST_CALLS, f"{count} calls, limit {MOST_CALLS}"
    return diagnostics[0].code if diagnostics else "model"


def check(diagnostic: mk.Diagnostic, content: bytes) -> None:
    str(diagnostic).encode()
    json.dumps(diagnostic.record(), allow_nan=False)
    if diagnostic.code == "more":
        return
    assert diagnostic.place is not None, diagnostic
    file, line, column = diagnostic.place
    lines = lines_of(content.decode(errors="replace").removeprefix("\ufeff"))
    assert file == FILE, diagnostic
    assert 1 <= line <= len(lines), diagnostic
    assert 1 <= column <= len(lines[line - 1]) + 1, diagnostic
