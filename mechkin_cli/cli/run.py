"""A command line to its exit code: exceptions become messages.

A plain command line is run without typer, whose import and checks take longer than an analysis;
everything else, help and mistakes included, goes to `app`.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from mechkin_cli.cli.commands import COMMANDS
from mechkin_cli.cli.interrupts import said
from mechkin_cli.cli.messages import (
    ExitCode,
    put,
    say,
    say_diagnostics,
    stdout_failed,
    tell_as,
    tell_notes,
    version_text,
)
from mechkin_cli.cli.words import Command, Word
from mechkin_cli.diagnostics import InvalidFile, MechkinError, UsageError

TYPE_CHECKING = False  # typing is not loaded for its flag alone
if TYPE_CHECKING:
    from typing import Any

# Plain command lines, read without typer.
#
# Plain is: a command, its arguments, known options in full, each with its value as a word of its
# own that is not empty and does not start with a dash, nothing given twice that is wanted once. Of
# all else typer is to judge.


def plain_line(words: Sequence[str]) -> tuple[Command, dict[str, Any]] | None:
    """The command that a line means and the values of its parameters; None where it is not
    plain."""
    command = COMMANDS.get(words[0]) if words else None
    if command is None or "_MECHKIN_COMPLETE" in os.environ:
        return None
    options = {name: word for word in command.words for name in word.names}
    arguments = [word for word in command.words if not word.names]
    given: dict[str, Any] = {}
    rest = iter(words[1:])
    for text in rest:
        if text.startswith("-") and text != "-":
            if text not in options or not _add(given, options[text], rest):
                return None
        elif not arguments or not _put(given, arguments[0], text):
            return None
    if any(word.required and word.parameter not in given for word in arguments):
        return None
    return command, given


def _add(given: dict[str, Any], option: Word, rest: Iterator[str]) -> bool:
    """Whether an option, with the word behind it where it takes one, is plain."""
    if option.kind == "flag":
        is_new = option.parameter not in given
        given[option.parameter] = True
        return is_new
    text = next(rest, "-")
    return bool(text) and not text.startswith("-") and _put(given, option, text)


def _put(given: dict[str, Any], word: Word, text: str) -> bool:
    """Whether a text is plain as the value of a word."""
    if word.kind == "whole" and not (text.isascii() and text.isdecimal()):
        return False
    if word.parameter in given and not word.repeated:
        return False
    kind = {"text": str, "whole": int}.get(word.kind, Path)
    if word.repeated:
        given.setdefault(word.parameter, []).append(kind(text))
    else:
        given[word.parameter] = kind(text)
    return True


def run() -> int:
    """Runs the command line of the process; its exit code."""
    tell_as(None)
    tell_notes(True)
    code = _run()
    if code == ExitCode.INTERRUPTED:
        said()
    return code


def _run() -> int:
    try:
        if sys.argv[1:] == ["--version"] and "_MECHKIN_COMPLETE" not in os.environ:
            put(version_text())
            return ExitCode.OK
        plain = plain_line(sys.argv[1:])
        if plain is not None:
            command, given = plain
            tell_notes(not given.get("quiet"))
            return command.call(given)
        from mechkin_cli.cli.app import run

        return run()
    except InvalidFile as error:
        say_diagnostics(error.diagnostics)
        return ExitCode.INVALID_FILE
    except ImportError as error:
        return _failed(error)
    except MechkinError as error:
        say(f"mechkin: {error}")
        return ExitCode.USAGE
    except KeyboardInterrupt:
        return ExitCode.INTERRUPTED
    except Exception as error:
        return _failed(error)


def _failed(error: Exception) -> int:
    # a thread's stack is memory, too
    if isinstance(error, MemoryError) or "can't start new thread" in str(error):
        say("mechkin: the memory is used up; take fewer rows, columns or tables")
        return ExitCode.USAGE
    if isinstance(error, OSError) and error.filename is None:
        # help and benchmarks, which are not printed by `put`
        try:
            stdout_failed(error)
        except UsageError as refused:
            say(f"mechkin: {refused}")
            return ExitCode.USAGE
        return ExitCode.OK
    from mechkin_cli.kernel import KernelMissing

    if isinstance(error, KernelMissing):
        say(f"mechkin: {error}")
        return ExitCode.INTERNAL
    if os.environ.get("MECHKIN_DEBUG"):
        raise error
    say(
        f"mechkin: internal error, {type(error).__name__}: {error}; this is a defect of mechkin: "
        "please report it with the file; MECHKIN_DEBUG=1 shows where"
    )
    return ExitCode.INTERNAL
