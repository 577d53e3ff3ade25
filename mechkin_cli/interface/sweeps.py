"""`Model.analyze`: the sweep of the file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from mechkin_cli.analysis.sweep import analyze
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.interface.analysis import Analysis
from mechkin_cli.interface.arguments import a_text, texts
from mechkin_cli.interface.asking import a_packing, chosen_tables, known_mode, wanted_names
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.runs import SWEEP
from mechkin_cli.solver.demand import needs_all_links
from mechkin_cli.solver.graph import UnsolvableGraph
from mechkin_cli.solver.session import Session
from mechkin_cli.tables.layout import chosen

if TYPE_CHECKING:
    from mechkin_cli.interface.model import Model
    from mechkin_cli.mechanism.problem import Problem


def run_sweep(
    model: Model,
    quantities: Iterable[str] | None,
    tables: Sequence[str] | None,
    mode: str | None,
    closed_at: Sequence[str] | None,
    lanes: int,
    threads: int,
    errors: bool,
) -> Analysis:
    """Runs the sweep of a model; arguments and errors are those of `Model.analyze`."""
    packing = a_packing(lanes, threads)
    if SWEEP not in model.runs:
        raise UsageError(
            f"{model.name} has no sweep: its file has no motion:; its responses are run by "
            f'respond("{model.runs[0]}")'
        )
    session, problem = model.session, model.problem
    if closed_at is not None:
        session = _closed_at(problem, closed_at)
    if mode is not None:
        a_text("mode", mode, '"A"')
        session = session.assembled(replace(problem.assembly, mode=mode))
    layouts = chosen_tables(model.built, tables, SWEEP)
    balances = chosen(model.built.balances, tables)
    names = wanted_names(session, SWEEP, layouts, quantities)
    asked = tuple(names)
    if balances:
        from mechkin_cli.mechanism.balance import read_by

        names += read_by(balances, problem)
    refuse_loaded_spin(session, names)
    result = analyze(session.packed(packing), names)
    systems = chosen(model.built.coefficients, tables)
    analysis = Analysis(model, layouts, result, SWEEP, systems, balances, asked)
    analysis = analysis if mode is None else known_mode(analysis)
    if errors:
        _ = analysis.errors
    return analysis


def _closed_at(problem: Problem, names: Sequence[str]) -> Session:
    """The session whose loops are closed at some joints."""
    closings = list(texts("closed_at", names, '["O3"]'))
    joints = problem.mechanism.joints
    for name in closings:
        if name not in joints:
            known = ", ".join(joints)
            raise UsageError(
                f"closed_at: there is no joint {name[:LONGEST_NAME]}; joints are {known}"
            )
    try:
        return Session(problem, closed_at=closings)
    except UnsolvableGraph as error:
        why = f"closed_at {', '.join(closings) or 'nothing'}: {error.diagnostic.message}"
        cure = "leave out closed_at, or choose other closing joints"
        raise UsageError(f"{why}; {cure}") from None


def refuse_loaded_spin(session: Session, names: Sequence[str]) -> None:
    """Forces and energies need what spins freely to have no cause to spin.

    Raises:
        UsageError: one of some quantities is such, and something would spin.
    """
    problem = session.problem
    if not names or not (find_legs(problem.mechanism) or problem.held):
        return
    from mechkin_cli.mechanism.spins import spin_errors

    for _, diagnostic in session.own("causes of spin", lambda: list(spin_errors(problem))):
        known = problem.quantities()
        if needs_all_links(problem.mechanism, [known[name] for name in names]):
            raise UsageError(str(diagnostic))
