"""What a caller wants of a run: its tables, and the quantities that are computed with them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from mechkin_cli.building.columns import used_quantities
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.interface.arguments import a_text, a_whole_number, texts
from mechkin_cli.kernel.width import check_threads, check_width
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.runs import SWEEP
from mechkin_cli.solver.session import Packing, Session
from mechkin_cli.tables.layout import TableLayout, row_texts

if TYPE_CHECKING:
    from mechkin_cli.building.build import Built
    from mechkin_cli.interface.analysis import Analysis

QUANTITIES = (
    "quantities are such as J.theta, J.force of a joint J, or p.position of a point p; components "
    'and expressions are read from the analysis: r["J.force.x"]'
)


def a_packing(lanes: object, threads: object) -> Packing:
    """How rows are packed.

    Raises:
        UsageError: no numbers, or a width that the machine lacks.
    """
    lanes = a_whole_number("lanes", lanes, "rows at a time")
    threads = a_whole_number("threads", threads, "threads")
    check_width(lanes)
    check_threads(threads)
    return Packing(lanes, threads)


def run_name(runs: Sequence[str], name: str | None) -> str:
    """The run that is meant; None: the first.

    Raises:
        UsageError: there is no such run.
    """
    if name is None:
        return runs[0]
    a_text("run", name, f'"{runs[0]}"')
    if name not in runs:
        hint = nearest_hint(name, runs) or f"runs are {', '.join(runs)}"
        raise UsageError(f"there is no run {name[:LONGEST_NAME]}; {hint}")
    return name


def chosen_tables(built: Built, names: Sequence[str] | None, run: str) -> tuple[TableLayout, ...]:
    """The tables of a run that are wanted; None: all.

    Raises:
        UsageError: the run has no such table.
    """
    own = built.tables_of(run)
    if names is None:
        return own
    known = {table.name: table for table in own}
    others = (*built.coefficients, *built.balances) if run == SWEEP else ()
    of_systems = [one.name for one in others]
    names = texts("tables", names, '["table_03"]')
    names = [name for name in names if name not in of_systems]
    for name in names:
        if name not in known:
            raise UsageError(
                f"there is no table {name[:LONGEST_NAME]}; "
                f"tables are {', '.join([*known, *sorted(of_systems)])}"
            )
    return tuple(known[name] for name in dict.fromkeys(names))


def wanted_names(
    session: Session,
    run: str,
    layouts: Sequence[TableLayout],
    quantities: Iterable[str] | None,
) -> list[str]:
    """The quantities that tables of a run read, then those asked for; `session` is the run's. What
    there is, is asked only where something is wanted.

    Raises:
        UsageError: an unknown quantity.
    """
    asked = () if quantities is None else texts("quantities", quantities, '["O4.theta"]')
    if not layouts and not asked:
        return []
    always, known = row_texts(run), session.problem.quantities()
    key = ("read by", run, tuple(layout.name for layout in layouts))
    used = session.once(key, lambda: used_quantities(layouts, known))
    names = [name for name in asked if name not in always]
    for name in names:
        if name not in known:
            hint = session.problem.why_not(name) or nearest_hint(name, known) or QUANTITIES
            raise UsageError(f"there is no quantity {name[:LONGEST_NAME]}; {hint}")
    return [*used, *names]


def known_mode(analysis: Analysis) -> Analysis:
    """The analysis of a mode that was asked for.

    Raises:
        UsageError: there is no such mode.
    """
    for diagnostic in analysis.diagnostics:
        if diagnostic.code == "no-such-mode":
            raise UsageError(f"{diagnostic.message}: {diagnostic.measured}")
    return analysis
