"""`python -m benchmarks`: run time against error of mechkin and others, and hard mechanisms."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmarks.stress import options
from benchmarks.stress.command import Stress, stress_command
from benchmarks.suite import OF_FILES, WHOLE
from mechkin_cli.cli.bench import STRESS_IS_ALONE, Out, Quick, measure, refuse_options, show
from mechkin_cli.cli.messages import say, say_diagnostics
from mechkin_cli.cli.options import Json
from mechkin_cli.diagnostics import InvalidFile, MechkinError

OF_STRESS = ("rows", "seed", "family", "only", "page", "check", "processes", "small")
OF_TIMES = ("files", "quick", "out")
STRESS_IS_MISSING = "without --stress there is nothing for {}; add --stress, or leave it out"

app = typer.Typer(
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


@app.command()
def benchmarks(
    context: typer.Context,
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Mechanism files to measure instead of the eight of its own.", metavar="FILE"
        ),
    ] = None,
    quick: Quick = False,
    out: Out = None,
    json: Json = False,
    stress: options.Stress = False,
    rows: options.Rows = 2_000,
    seed: options.Seed = 1,
    family: options.Family = None,
    only: options.Only = None,
    page: options.Page = None,
    check: options.Check = False,
    processes: options.Processes = 0,
    small: options.Small = None,
) -> None:
    """Measure run time against error, mechkin's and others'.

    Without files it measures eight mechanisms, variants and responses. Other libraries are measured
    if they are installed (pip install -r benchmarks/requirements.txt). With --stress it runs hard
    mechanisms by the thousand instead, and decides every row in double-double.
    """
    if stress:
        refuse_options(context, OF_TIMES, STRESS_IS_ALONE)
        asked = Stress(round(rows), seed, family, only, page, check, processes, small, json)
        code = stress_command(asked, show)
    else:
        refuse_options(context, OF_STRESS, STRESS_IS_MISSING)
        suite = OF_FILES if files else WHOLE
        code = measure(suite, files or [], quick=quick, out=out, json=json)
    if code:
        raise typer.Exit(code)


def main() -> None:
    """Runs the command line; what is wrong with it or a file is told in words."""
    try:
        app(prog_name="python -m benchmarks")
    except InvalidFile as error:
        say_diagnostics(error.diagnostics)
        raise SystemExit(3) from None
    except MechkinError as error:
        say(f"benchmarks: {error}")
        raise SystemExit(2) from None


if __name__ == "__main__":
    main()
