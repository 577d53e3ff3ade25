"""`python -m benchmarks`: run time against error of mechkin and others, and hard mechanisms."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from benchmarks.stress import options
from benchmarks.stress.command import Stress, stress_command
from benchmarks.suite import OF_FILES, WHOLE
from mechkin_cli.cli.app import folder
from mechkin_cli.cli.bench import STRESS_IS_ALONE, measure, refuse_options, show
from mechkin_cli.cli.messages import say, say_diagnostics
from mechkin_cli.diagnostics import InvalidFile, MechkinError

OF_STRESS = ("rows", "seed", "family", "only", "page", "check", "processes", "small")
OF_TIMES = ("files", "quick", "out")
STRESS_IS_MISSING = "without --stress there is nothing for {}; add --stress, or leave it out"

app = typer.Typer(
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


Quick = Annotated[
    bool, typer.Option("--quick", help="Few rounds: takes seconds, and measures less well.")
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        parser=folder,
        help="Also write bench.json, bench.csv, bench.md, bench.svg.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON object on stdout and nothing else.")]


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
        refuse_options(_given(context, OF_TIMES), STRESS_IS_ALONE)
        asked = Stress(round(rows), seed, family, only, page, check, processes, small, json)
        code = stress_command(asked, show)
    else:
        refuse_options(_given(context, OF_STRESS), STRESS_IS_MISSING)
        suite = OF_FILES if files else WHOLE
        code = measure(suite, files or [], quick=quick, out=out, json=json)
    if code:
        raise typer.Exit(code)


def _given(context: typer.Context, names: Sequence[str]) -> dict[str, bool]:
    """Which of the parameters stand on the command line."""
    sources = {name: context.get_parameter_source(name) for name in names}
    return {
        name: source is not None and source.name == "COMMANDLINE"
        for name, source in sources.items()
    }


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
