"""Diagnostics as annotations of GitHub: workflow commands, one line each.

The runner takes them from either stream of a step and shows them at the line of the file:
https://docs.github.com/actions/reference/workflow-commands-for-github-actions
"""

from __future__ import annotations

import os

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.legible import legible

_LEVELS = {"error": "error", "warning": "warning", "note": "notice"}


def annotation(diagnostic: Diagnostic, file: str | None = None) -> str:
    """The workflow command of a diagnostic; one without a place is put at the top of `file`."""
    place = diagnostic.place
    fields = {"title": f"mechkin {diagnostic.code}"}
    if place is not None and place.in_file:
        at = {"file": _from_the_top(place.file), "line": str(place.line), "col": str(place.column)}
        fields = at | fields
    elif file is not None:
        fields = {"file": _from_the_top(file)} | fields
    shown = diagnostic._replace(place=None)
    sentence = str(shown).removeprefix(f"{diagnostic.severity}: ")
    if place is not None and not place.in_file:
        sentence = f"{place}: {sentence}"
    listed = ",".join(f"{name}={_property(value)}" for name, value in fields.items())
    return f"::{_LEVELS[diagnostic.severity]} {listed}::{_data(legible(sentence))}"


def _from_the_top(file: str) -> str:
    """The file as the repository knows it: a step may run in a folder of it."""
    top = os.environ.get("GITHUB_WORKSPACE")
    if not top:
        return file
    path = os.path.relpath(os.path.abspath(file), os.path.abspath(top))
    return file if path.startswith(os.pardir) else path.replace(os.sep, "/")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
