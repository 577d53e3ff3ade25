"""Plain command lines of `mechkin analyze`, read without typer.

Plain is: files (or `-`), known options in full, each with its value as a word of its own that is
not empty and does not start with a dash, nothing given twice that is wanted once. Of all else typer
is to judge.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple


class Option(NamedTuple):
    """An option: the argument of `analyze_files`, what turns its word into a value (None: a flag),
    and whether it may be repeated."""

    argument: str
    value: type[str] | type[int] | type[Path] | None
    repeated: bool = False


OPTIONS = {
    "--out": Option("out", Path),
    "--format": Option("format", str, True),
    "--units": Option("units", None),
    "--messages": Option("messages", str),
    "--set": Option("set_", str, True),
    "--mode": Option("mode", str),
    "--table": Option("table", str, True),
    "--lanes": Option("lanes", int),
    "--threads": Option("threads", int),
    "--certify": Option("certify", None),
    "--strict": Option("strict", None),
    "--errors": Option("errors", None),
    "--view": Option("view", None),
    "--explain": Option("explain", None),
    "--json": Option("json", None),
    "--quiet": Option("quiet", None),
}


def plain_analysis(words: Sequence[str]) -> dict[str, Any] | None:
    """The arguments of `analyze_files` that a command line means; None where it is not plain."""
    if words[:1] != ["analyze"] or "_MECHKIN_COMPLETE" in os.environ:
        return None
    given: dict[str, Any] = {"files": []}
    rest = iter(words[1:])
    for word in rest:
        if not word.startswith("-") or word == "-":
            given["files"].append(Path(word))
        elif word not in OPTIONS or not _add(given, OPTIONS[word], rest):
            return None
    return given if given["files"] else None


def _add(given: dict[str, Any], option: Option, rest: Any) -> bool:
    """Whether an option, with the word behind it where it takes one, is plain."""
    if option.argument in given and not option.repeated:
        return False
    if option.value is None:
        given[option.argument] = True
        return True
    word = next(rest, "-")
    if (
        not word
        or word.startswith("-")
        or (option.value is int and not (word.isascii() and word.isdecimal()))
    ):
        return False
    if option.repeated:
        given.setdefault(option.argument, []).append(word)
    else:
        given[option.argument] = option.value(word)
    return True
