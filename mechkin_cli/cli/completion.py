"""What shells offer while a command line is typed: files, and the names that the file holds.

A file is only read, never solved, and one that cannot be read offers nothing: assembly modes, which
must be searched for, are not among what is offered.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import typer

Offers = list[str]


def mechanism_files(incomplete: str) -> Offers:
    """Mechanism files, and the folders on the way to them."""
    folder, _, start = incomplete.rpartition("/")
    above = f"{folder}/" if "/" in incomplete else ""
    try:
        with os.scandir(above or ".") as entries:
            found = [
                f"{above}{entry.name}{'/' if entry.is_dir() else ''}"
                for entry in entries
                if entry.name.startswith(start)
                and (start.startswith(".") or not entry.name.startswith("."))
                and (entry.is_dir() or entry.name.endswith((".yaml", ".yml")))
            ]
    except (OSError, ValueError):
        return []
    return sorted(found)


def table_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Tables and coefficients of the files."""
    sections = [data.get(name) for data in _files(ctx) for name in ("tables", "coefficients")]
    names = [table.get("name") for section in sections for table in _mappings(section)]
    return _beginning(names, incomplete)


def run_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Responses of the file."""
    return _beginning(_keys(ctx, "responses"), incomplete)


def input_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Inputs of the file's sweep."""
    names = [
        name
        for data in _files(ctx)
        if isinstance(motion := data.get("motion"), dict)
        and isinstance(inputs := motion.get("inputs"), dict)
        for name in inputs
    ]
    return _beginning(names, incomplete)


def parameter_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Parameters of the files, each with the sign behind which its value stands."""
    return _beginning([f"{name}=" for name in _keys(ctx, "parameters")], incomplete)


def format_names(incomplete: str) -> Offers:
    """Formats of results."""
    from mechkin_cli.tables.writers import WRITERS

    return _beginning(WRITERS, incomplete)


def message_forms(incomplete: str) -> Offers:
    """Forms of messages."""
    from mechkin_cli.cli.messages import FORMS

    return _beginning(FORMS, incomplete)


def _files(ctx: typer.Context) -> list[Mapping[str, Any]]:
    """The files named so far, as plain data; those that are no mechanism files are left out."""
    from mechkin_cli.diagnostics import MechkinError
    from mechkin_cli.reading.document import read_document

    # behind an option that still lacks its value, files are words that nothing has taken yet
    given = ctx.params.get("files") or ctx.params.get("file") or ctx.args
    found: list[Mapping[str, Any]] = []
    for path in [given] if isinstance(given, str | Path) else given:
        try:
            found.append(read_document(path).data)
        except MechkinError:
            continue
    return found


def _keys(ctx: typer.Context, section: str) -> list[str]:
    found = [data.get(section) for data in _files(ctx)]
    return [name for names in found if isinstance(names, dict) for name in names]


def _mappings(section: object) -> list[dict[str, Any]]:
    items = section if isinstance(section, list) else []
    return [item for item in items if isinstance(item, dict)]


def _beginning(names: Iterable[object], start: str) -> Offers:
    return [
        name for name in dict.fromkeys(names) if isinstance(name, str) and name.startswith(start)
    ]
