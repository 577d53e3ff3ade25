"""`mechkin bench`: what a row costs on this machine."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from mechkin_cli.cli import stress_options as options
from mechkin_cli.cli.messages import put_json
from mechkin_cli.cli.options import Json

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from mechkin_cli.benchmark.report import Table


def bench(
    quick: Annotated[
        bool, typer.Option("--quick", help="Few rounds: seconds, and rougher.")
    ] = False,
    json: Json = False,
    stress: options.Stress = False,
    rows: options.Rows = 2_000,
    seed: options.Seed = 1,
    family: options.Family = None,
    only: options.Only = None,
    page: options.Page = None,
    check: options.Check = False,
    processes: options.Processes = 0,
) -> None:
    """Measure run times on the RCSR mechanism and a general 7R.

    With --stress: hard mechanisms by the thousand, every row decided by a closed form.
    """
    if stress:
        from mechkin_cli.cli.bench_stress import Stress, stress_command

        asked = Stress(round(rows), seed, family, only, page, check, processes, json)
        code = stress_command(asked, lambda found: _print(iter(found)))
        if code:
            raise typer.Exit(code)
        return
    from mechkin_cli.benchmark.machine import machine
    from mechkin_cli.benchmark.runs import timing_tables

    described = machine()
    tables = timing_tables(quick=quick)
    if json:
        record: dict[str, object] = {"machine": described}
        put_json(record | {table.name: table.record() for table in tables})
        return
    sys.stdout.write(", ".join(f"{name} {value}" for name, value in described.items()) + "\n")
    _print(tables)


def _print(tables: Iterator[Table]) -> None:
    """Each table as soon as it is there: styled on a terminal wide enough, else aligned text."""
    from mechkin_cli.benchmark.report import plain_text, width

    if not sys.stdout.isatty():
        for table in tables:
            sys.stdout.write("\n" + plain_text(table))
            sys.stdout.flush()
        return
    from rich.console import Console

    console = Console()
    for table in tables:
        console.print()
        # a table that does not fit would lose digits
        if width(table) > console.width:
            console.out(plain_text(table), end="", highlight=False)
            continue
        console.print(_styled(table))
        for note in table.notes:
            console.print(note, style="dim", highlight=False, markup=False)


def _styled(table: Table) -> RichTable:
    from rich import box
    from rich.table import Table as RichTable

    styled = RichTable(
        title=table.title,
        title_justify="left",
        title_style="bold",
        header_style="",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, 1, 0, 0),
    )
    for column in table.columns:
        justify = "left" if column.kind == "text" else "right"
        styled.add_column(column.label, justify=justify, vertical="bottom", no_wrap=True)  # type: ignore[arg-type]
    for row in table.texts():
        styled.add_row(*row)
    return styled
