"""A command line to its exit code: exceptions become messages.

A plain `mechkin analyze` is run without typer, whose import and checks take longer than an
analysis; everything else, help and mistakes included, goes to `app`.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mechkin_cli.cli.interrupts import said
from mechkin_cli.cli.messages import ExitCode, say, say_diagnostics, stdout_failed, tell_as
from mechkin_cli.diagnostics import InvalidFile, MechkinError, UsageError
from mechkin_cli.record import NamedTuple

# Plain command lines of `mechkin analyze`, read without typer.
#
# Plain is: files (or `-`), known options in full, each with its value as a word of its own that is
# not empty and does not start with a dash, nothing given twice that is wanted once. Of all else
# typer is to judge.


class Option(NamedTuple):
    """An option: the field of `AnalyzeCommand`, what turns its word into a value (None: a flag),
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
    """The fields of `AnalyzeCommand` that a command line means; None where it is not plain."""
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


def run() -> int:
    """Runs the command line of the process; its exit code."""
    tell_as(None)
    code = _run()
    if code == ExitCode.INTERRUPTED:
        said()
    return code


def _run() -> int:
    try:
        given = plain_analysis(sys.argv[1:])
        if given is not None:
            return _analyzed(given)
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


def _analyzed(given: dict[str, Any]) -> int:
    """A plain analysis; it loads what that needs, and no more."""
    # an analysis multiplies no large matrices: one thread of BLAS per core would only be started
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if "mechkin_cli.model.model" not in sys.modules:
        _load_without_collecting()
    from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files

    return int(analyze_files(AnalyzeCommand(**given)))


def _load_without_collecting() -> None:
    """Modules live as long as the process: looking for garbage among them is a tenth of a short
    run. What else there is at the time is never collected either, so this is for the first analysis
    of a process."""
    import gc

    gc.disable()
    try:
        from mechkin_cli.model import Model  # noqa: F401
    finally:
        gc.freeze()
        gc.enable()


def _failed(error: Exception) -> int:
    if isinstance(error, MemoryError):
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
