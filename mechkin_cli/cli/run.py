"""A command line to its exit code: exceptions become messages.

A plain `mechkin analyze` is run without typer, whose import and checks take longer than an
analysis; everything else, help and mistakes included, goes to `app`.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.interrupts import said
from mechkin_cli.cli.messages import say, say_diagnostics, stdout_failed, tell_as
from mechkin_cli.cli.plain import plain_analysis
from mechkin_cli.diagnostics import InvalidFile, MechkinError, UsageError


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
            return int(_analyze_files()(**given))
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


def _analyze_files() -> Callable[..., int]:
    """Loads what a plain analysis needs, and no more than that."""
    # an analysis multiplies no large matrices: one thread of BLAS per core would only be started
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if "mechkin_cli.interface" not in sys.modules:
        _load_without_collecting()
    from mechkin_cli.cli.analyze import analyze_files

    return analyze_files


def _load_without_collecting() -> None:
    """Modules live as long as the process: looking for garbage among them is a tenth of a short
    run. What else there is at the time is never collected either, so this is for the first analysis
    of a process."""
    import gc

    gc.disable()
    try:
        import mechkin_cli.cli.analyze
        import mechkin_cli.interface  # noqa: F401
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
