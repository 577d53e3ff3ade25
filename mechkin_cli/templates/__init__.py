"""Mechanism files to start from: each of this folder's YAML files is a template, whose first line
says what it is."""

from __future__ import annotations

from importlib.resources import files

from mechkin_cli.diagnostics import UsageError, nearest_hint

USUAL = "four-bar"
"""The template where none is named."""


def template_names() -> list[str]:
    """The names of all templates, in order."""
    own = (one.name for one in files(__name__).iterdir())
    return sorted(name.removesuffix(".yaml") for name in own if name.endswith(".yaml"))


def template_text(name: str) -> str:
    """The text of a template.

    Raises:
        UsageError: there is none of this name.
    """
    known = template_names()
    if name not in known:
        hint = nearest_hint(name, known) or f"templates are {', '.join(known)}"
        raise UsageError(f"there is no template {name[:40]}; {hint}")
    return files(__name__).joinpath(f"{name}.yaml").read_text(encoding="utf-8")


def purpose(text: str) -> str:
    """What a template is, as its first line says: a mechanism, and what is done with it."""
    return text.partition("\n")[0].removeprefix("#").strip()
