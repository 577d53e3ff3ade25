"""What `mechkin tolerances` does: stacks of tolerances, and what each of them contributes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import expressions, sensitivities, tables
from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    model_of,
    parameters,
    put,
    put_json,
    refusal,
    say,
    shown,
    stem_of,
    values_by_name,
)
from mechkin_cli.cli.plot import listed
from mechkin_cli.cli.progress import working
from mechkin_cli.cli.show import files_line, shown_table
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.arguments import Setting
    from mechkin_cli.model import Model
    from mechkin_cli.sensitivities import Tolerances


FORMATS = ("csv", "md")


def tolerances(
    file: Path,
    *,
    tolerance: list[str] | None = None,
    of: list[str] | None = None,
    at: list[str] | None = None,
    samples: int = 1024,
    method: str = "latin",
    seed: int = 0,
    distribution: str = "uniform",
    out: Path | None = None,
    format_: str | None = None,
    plot: bool = False,
    set_: list[str] | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """Worst case, root sum square and samples of quantities."""
    record: Record = {}
    code = ExitCode.OK
    try:
        formats = _formats(format_)
        model = model_of(file, parameters(set_))
        bands = _bands(model, tolerance or [])
        quantities = [name for text in of or () for name in listed(text)] or _columns(model)
        with working(f"{shown(file)}: tolerances", quiet or json) as tell:
            try:
                found = model.tolerances(
                    bands,
                    quantities,
                    at or None,
                    samples=samples,
                    method=method,
                    seed=seed,
                    distribution=distribution,
                )
            except expressions.ExpressionError as error:
                raise UsageError(str(error)) from error
            tell(f"{shown(file)}: {samples} samples")
            files = found.files(formats)
            if plot:
                tell(f"{shown(file)}: picture")
                files["tolerances.svg"] = found.picture().image("svg")
        folder = Path("out") / stem_of(file) if out is None else out
        written = []
        if not json or out is not None or plot or format_ is not None:
            written = tables.write_files(folder, files)
        if json:
            record = found.record() | {"files": [str(path) for path in written]}
        else:
            _show(found, folder, written, quiet)
        if any(np.isnan(found.nominal(quantity)).any() for quantity in quantities):
            code = ExitCode.ROWS_MISSING
    except (InvalidFile, UsageError) as error:
        code, record = refusal(file, error)
    if json:
        put_json({"file": shown(file), **record})
    return code


def _formats(text: str | None) -> tuple[str, ...]:
    names = FORMATS if text is None else tuple(listed(text))
    for name in names:
        if name not in FORMATS:
            raise UsageError(f"--format {name}: formats of tolerances are {' and '.join(FORMATS)}")
    return names


def _bands(model: Model, texts: list[str]) -> dict[str, Setting | list[Setting]]:
    """The bands by name: half a width, or both ends with a comma between them."""
    if not texts:
        names = ", ".join(model.problem.parameters) or "none"
        raise UsageError(
            f"name what scatters, as --tolerance P1=0.01mm; parameters of {model.name} are {names}"
        )
    expected = "NAME=HALF or NAME=LEAST,LARGEST, for example --tolerance P1=-0.01in,0.02in"
    found: dict[str, Setting | list[Setting]] = {}
    for name, text in values_by_name("--tolerance", texts, expected).items():
        ends: list[Setting] = [*listed(text.removeprefix("[").removesuffix("]"))]
        found[name] = ends if len(ends) != 1 else ends[0]
    return found


def _columns(model: Model) -> list[str]:
    """Labels of the numbers in the first table of the first run, without its inputs."""
    layouts = model.built.tables_of(model.runs[0])
    inputs = {f"{joint}.{name}" for joint, name in model.problem.motion.driven}
    labels = [
        column.label
        for layout in layouts[:1]
        for column in layout.columns
        if column.expression.text.strip() not in inputs
        and not column.expression.text.strip().startswith("row.")
    ]
    if not labels:
        raise UsageError("the file has no table; name the quantities, as --of B.theta")
    return labels


def _show(found: Tolerances, folder: Path, written: list[Path], quiet: bool) -> None:
    shown_tables = (sensitivities.extremes_table(found), sensitivities.contributions_table(found))
    for table in shown_tables:
        count = table.columns[0].rows
        put(shown_table(table, count) + "\n")
    if quiet:
        return
    say(found.listing.head)
    for note in found.listing.notes:
        say(f"  {note}")
    say(files_line(folder, written, []))
