"""`mechkin plot`: pictures of a run, of its tables or of what is named; and `mechkin view`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import expressions, plots, tables
from mechkin_cli.analysis import run_name
from mechkin_cli.cli.analyze import run_all
from mechkin_cli.cli.long_runs import is_long
from mechkin_cli.cli.messages import (
    ExitCode,
    model_of,
    parameters,
    put,
    refusal,
    say_diagnostics,
    shown,
    stem_of,
)
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis, Stream
    from mechkin_cli.model import Model
    from mechkin_cli.plots import Picture

    Drawn = tuple[Analysis | Stream, str | None]
    """A run, and the table of it that is drawn; None: what is named."""


ENDING = "svg"
"""Format of pictures whose file is not named."""


def plot(
    file: Path,
    *,
    x: str | None = None,
    y: list[str] | None = None,
    table: list[str] | None = None,
    run: str | None = None,
    out: Path | None = None,
    mode: str | None = None,
    set_: list[str] | None = None,
    quiet: bool = False,
) -> ExitCode:
    """Draws curves, coupler curves and polar diagrams of a file."""
    ending = ENDING if out is None else plots.format_of(out)
    names = [name for text in y or () for name in listed(text)]
    if names and table:
        raise UsageError("--y names what is drawn, --table too; leave one of them out")
    try:
        with working(f"{shown(file)}: reading", quiet) as tell:
            model = model_of(file, parameters(set_))
            tell(f"{shown(file)}: rows")
            analyses = _tables(model, table, run, mode) if not names else {}
            if names:
                analyses[stem_of(file)] = _run(model, run, mode), None
            files = {}
            for name, drawn in analyses.items():
                tell(f"{shown(file)}: picture of {name}")
                picture = _picture(drawn, names, x)
                if out is None:
                    target = f"{name}.{ending}"
                else:
                    target = out.name if len(analyses) == 1 else f"{out.stem}_{name}{out.suffix}"
                files[target] = plots.image(picture, ending)
    except (InvalidFile, UsageError) as error:
        return refusal(file, error)[0]
    _write(file, out, files, quiet)
    runs = [analysis for analysis, _ in analyses.values()]
    say_diagnostics(
        dict.fromkeys(one for analysis in runs for one in analysis.diagnostics), shown(file)
    )
    complete = all(analysis.complete for analysis in runs)
    return ExitCode.OK if complete else ExitCode.ROWS_MISSING


def _picture(drawn: Drawn, names: list[str], x: str | None) -> Picture:
    """The picture of a run: of what is named, or of its table."""
    analysis, table = drawn
    try:
        return analysis.picture(tuple(names), x, table)
    except expressions.ExpressionError as error:
        raise UsageError(str(error)) from error


def listed(text: str) -> list[str]:
    """Names with commas between them; commas in brackets do not separate.

    >>> listed("A.effort, dot(A.force, d)")
    ['A.effort', 'dot(A.force, d)']
    """
    parts, depth = [""], 0
    for character in text:
        depth += (character in "([") - (character in ")]")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts if part.strip()]


def _run(model: Model, run: str | None, mode: str | None) -> Analysis | Stream:
    """The run that is named, or the first; block by block, where its rows are many."""
    name = model.runs[0] if run is None else run
    if name in model.runs and is_long(model, name):
        return model.stream(run=name, mode=mode)
    return model.analyze(mode=mode) if name == SWEEP else model.run_free(name, mode=mode)


def _tables(
    model: Model, names: list[str] | None, run: str | None, mode: str | None
) -> dict[str, Drawn]:
    """The tables that are drawn, by name, with their runs.

    Raises:
        UsageError: there is no such run, or it has no such table.
    """
    if run is not None:
        run_name(model.runs, run)
    long = [one for one in model.runs if is_long(model, one)]
    runs: list[Analysis | Stream] = [_streamed(model, names, one, mode) for one in long]
    runs += run_all(model, names, mode, done=long)
    drawn: dict[str, Drawn] = {
        layout.name: (analysis, layout.name)
        for analysis in runs
        for layout in analysis.layouts
        if run in (None, analysis.run)
    }
    if not drawn:
        whose = f"run {run} has" if run is not None else "the file has"
        which = "no table of that name" if names else "no table"
        raise UsageError(f"{whose} {which}; name what is drawn, for example --y A.theta")
    return drawn


def _streamed(model: Model, names: list[str] | None, run: str, mode: str | None) -> Stream:
    """A run of many rows, with its tables of some names; None: all."""
    own = None
    if names is not None:
        own = [one.name for one in tables.chosen(tuple(model.tables), names) if one.run == run]
    return model.stream(run=run, tables=own, mode=mode)


def _write(file: Path, out: Path | None, files: dict[str, bytes], quiet: bool) -> None:
    folder = Path("out") / stem_of(file) if out is None else out.parent
    written = tables.write_files(folder, files)
    for path in () if quiet else written:
        put(f"{path}\n")
