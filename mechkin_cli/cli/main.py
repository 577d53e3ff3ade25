"""The app: registers the commands and turns exceptions into messages and exit codes."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import Any, NoReturn

import typer

from mechkin_cli.cli.analyze import analyze
from mechkin_cli.cli.bench import bench
from mechkin_cli.cli.check import check
from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import put, say, say_diagnostics, stdout_failed
from mechkin_cli.cli.mobility import mobility
from mechkin_cli.cli.modes import modes
from mechkin_cli.cli.ranges import ranges
from mechkin_cli.cli.schema import schema
from mechkin_cli.cli.tables import tables
from mechkin_cli.diagnostics import InvalidFile, MechkinError, UsageError

app = typer.Typer(
    name="mechkin",
    help="Displacement, rates, reactions and tables of spatial mechanisms from YAML files.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
for command in (analyze, check, modes, ranges, mobility, tables, schema, bench):
    app.command()(command)


@app.callback(invoke_without_command=True)
def _options(
    version: bool = typer.Option(False, "--version", help="Print the version and exit."),
) -> None:
    if version:
        put(f"mechkin {_version()}\n")
        raise typer.Exit()


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("mechkin")
    except PackageNotFoundError:
        return "(source folder, not installed)"


def main() -> NoReturn:
    """Runs the command line and exits with its code."""
    _end_like_ctrl_c()
    code = _run()
    if code == ExitCode.INTERRUPTED:
        say("mechkin: interrupted; files written so far are whole")
    sys.exit(code)


def _end_like_ctrl_c() -> None:
    """Lets a request to end (kill, a closed terminal) clean up as Ctrl-C does."""
    import signal

    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        # nohup and parents that ignore a signal are obeyed
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)


def _run() -> int:
    try:
        code = app(standalone_mode=False, prog_name="mechkin")
    except InvalidFile as error:
        say_diagnostics(error.diagnostics)
        return ExitCode.INVALID_FILE
    except ImportError as error:
        return _failed(error)
    except MechkinError as error:
        say(f"mechkin: {error}")
        return ExitCode.USAGE
    except (KeyboardInterrupt, typer.Abort):
        return ExitCode.INTERRUPTED
    except Exception as error:
        if hasattr(error, "exit_code") and hasattr(error, "show"):
            _show(error)
            for file in filter(os.path.isfile, sys.argv[1:2]):
                say(f"To run a mechanism file: mechkin analyze {file}")
            return int(error.exit_code)
        return _failed(error)
    return int(code or 0)


def _show(error: Any) -> None:
    """A usage error of the command line itself, as typer words it."""
    with contextlib.suppress(OSError):
        if sys.stderr is not None:
            error.show()


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
