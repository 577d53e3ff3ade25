"""`--set NAME=VALUE` as a mapping."""

from __future__ import annotations

from mechkin_cli.diagnostics import UsageError


def parameters(settings: list[str] | None) -> dict[str, str]:
    """NAME=VALUE texts as a mapping.

    Raises:
        UsageError: a text without `=`.
    """
    found = {}
    for text in settings or ():
        name, equals, value = text.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise UsageError(f"--set {text}: expected NAME=VALUE, for example --set P1=0.6in")
        found[name.strip()] = value.strip()
    return found
