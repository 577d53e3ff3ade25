"""The part of `docs/commands.md` that tells every option, made from the commands themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from mechkin_cli.cli.app import app

PAGE = Path(__file__).parents[3] / "docs" / "commands.md"
MARK = "<!-- made by `python -P tests/documents/commands`; a test compares it -->\n"


def page() -> str:
    """The whole page: what is written by hand above the mark, and what is made below it."""
    by_hand, mark, _ = PAGE.read_text(encoding="utf-8").partition(MARK)
    if not mark:
        raise ValueError(f"{PAGE} lost the line {MARK}")
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    return by_hand + mark + "".join(_section(name, one) for name, one in commands.items())


def _section(name: str, command: Any) -> str:
    arguments = [one for one in command.params if one.param_type_name == "argument"]
    options = [one for one in command.params if one.param_type_name == "option"]
    usage = " ".join([f"mechkin {name}", *(map(_usage, arguments))])
    said = "\n".join(line.strip() for line in command.help.splitlines())
    rows = [*((f"`{_usage(one)}`", one) for one in arguments)]
    rows += [(f"`{_spelled(one)}`", one) for one in options]
    lines = [f"| {cell} | {_told(one)} |\n" for cell, one in rows if not one.hidden]
    table = "\n| | |\n|---|---|\n" + "".join(lines) if lines else ""
    return f"\n### mechkin {name}\n\n    {usage}\n\n{said}\n{table}"


def _usage(argument: Any) -> str:
    word = argument.metavar or argument.name.upper()
    repeated = f"{word}..." if argument.nargs == -1 else word
    return repeated if argument.required else f"[{repeated}]"


def _spelled(option: Any) -> str:
    names = ", ".join(option.opts)
    return names if option.is_flag else f"{names} {option.metavar or 'N'}"


def _told(one: Any) -> str:
    plain = one.help.replace("|", "\\|")
    shown = one.default not in (None, False, ()) and not callable(one.default)
    return f"{plain} Default: `{one.default}`." if shown else plain
