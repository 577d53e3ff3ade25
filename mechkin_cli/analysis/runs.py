"""What a caller may ask of a run, checked, and the runs themselves: sweeps and responses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import response as response_room, statics, tolerances
from mechkin_cli.analysis.analysis import Analysis
from mechkin_cli.analysis.design import Design
from mechkin_cli.arguments import (
    Setting,
    a_setting,
    a_text,
    a_whole_number,
    settings,
    shown,
    texts,
)
from mechkin_cli.building import build, is_tiny_length, used_quantities
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.expressions import ExpressionError, constant_in_file_units, lookup
from mechkin_cli.kernel.functions import check_threads, check_width
from mechkin_cli.mechanism import DrivenInput, Problem, dimension_of, read_by
from mechkin_cli.memo import remembered
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.schema import CoordinateWindow, Equilibrium, section_of, section_with
from mechkin_cli.session import Packing, Session, turn_of
from mechkin_cli.structure import UnsolvableGraph
from mechkin_cli.sweep import Sweep, refuse_loaded_spin
from mechkin_cli.tables import TableLayout, chosen, row_texts
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.analysis.analysis import Solvable
    from mechkin_cli.analysis.stream import Stream
    from mechkin_cli.building import Built
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.mechanism import AnyBalance, ResponseProblem
    from mechkin_cli.sweep import Result
    from mechkin_cli.tables import CoefficientsLayout

QUANTITIES = (
    "quantities are such as J.theta, J.force of a joint J, or p.position of a point p, or "
    "expressions of them: J.force.x"
)


def a_packing(lanes: object, threads: object) -> Packing:
    """How rows are packed.

    Raises:
        UsageError: no numbers, or a width that the machine lacks.
    """
    # what is asked again and again was right before; True is no number
    known = type(lanes) is int and type(threads) is int
    return _known_packing(lanes, threads) if known else _packing(lanes, threads)


def _packing(lanes: object, threads: object) -> Packing:
    lanes = a_whole_number("lanes", lanes, "rows at a time")
    threads = a_whole_number("threads", threads, "threads")
    check_width(lanes)
    check_threads(threads)
    return Packing(lanes, threads)


_known_packing = cache(_packing)
_ANY_PACKING = Packing()


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


def response_name(problem: Problem, name: str | None) -> str:
    """The response that is meant; without a name the only one.

    Raises:
        UsageError: there is none, or none of this name.
    """
    known = [run for run, one in problem.responses.items() if one.search is None]
    if not known:
        raise UsageError(
            "the file has no responses; add responses: {NAME: {start: {...}, time: {...}}}"
        )
    if name is None:
        if len(known) > 1:
            raise UsageError(f"respond() needs a name; responses are {', '.join(known)}")
        return known[0]
    a_text("name", name, f'"{known[0]}"')
    if name not in known:
        hint = nearest_hint(name, known) or f"responses are {', '.join(known)}"
        raise UsageError(f"there is no response {name[:LONGEST_NAME]}; {hint}")
    return name


def equilibrium_name(problem: Problem, name: str | None) -> str:
    """The equilibria that are meant; without a name the only ones.

    Raises:
        UsageError: there are none, or none of this name.
    """
    known = [run for run, one in problem.responses.items() if one.search is not None]
    if not known:
        raise UsageError(
            "the file has no equilibria; add equilibria: {NAME: {near: {...}}}, or ask for one: "
            'equilibrium(near={"A.theta": 20})'
        )
    if name is None:
        if len(known) > 1:
            raise UsageError(f"equilibrium() needs a name; equilibria are {', '.join(known)}")
        return known[0]
    a_text("name", name, f'"{known[0]}"')
    if name not in known:
        hint = nearest_hint(name, known) or f"equilibria are {', '.join(known)}"
        raise UsageError(f"there are no equilibria {name[:LONGEST_NAME]}; {hint}")
    return name


def input_values(problem: Problem, at: Setting | Mapping[str, Setting]) -> dict[str, float]:
    """Inputs by name in the file's units; a bare value is for the first input that is swept.

    Raises:
        UsageError: an unknown input, or an invalid value.
    """
    inputs = {item.name: item for item in problem.motion.inputs}
    if not isinstance(at, Mapping):
        swept = [name for name, item in inputs.items() if np.ptp(item.written) > 0.0]
        names = swept or list(inputs)
        if not names:
            raise UsageError(f"{problem.mechanism.name} has no input to be put at {shown(at)}")
        at = {names[0]: a_setting("at", at)}
    places = {}
    for name, value in settings("at", at, '{"O1.theta": 170}').items():
        if name not in inputs:
            raise UsageError(
                f"{name[:LONGEST_NAME]} is no input; inputs are {', '.join(inputs) or 'none'}"
            )
        places[name] = _input_value(problem, inputs[name], value)
    return places


def _input_value(problem: Problem, item: DrivenInput, value: Setting) -> float:
    """A value of an input in the file's units."""
    text = value if isinstance(value, str) else repr(value)
    dimension = dimension_of(item.coordinate)
    resolve = lookup(problem.parameters)
    try:
        found = constant_in_file_units(text, dimension, problem.units, resolve)
        if is_tiny_length(problem.units.to_si(found, dimension), dimension):
            raise ExpressionError("this length is too small", 0, "check its exponent and unit")
        turn = turn_of(problem, item)
        largest = tolerances.LARGEST_TURNS * float(turn) if turn else tolerances.LARGEST_NUMBER
        if not abs(found) <= largest:
            large = f"this is too large to compute with (limit {largest:.4g})"
            raise ExpressionError(large, 0, "check its exponent and unit")
        return found
    except ExpressionError as error:
        hint = f"; {error.hint}" if error.hint else ""
        raise UsageError(f"{item.name} at {text[:LONGEST_NAME]}: {error.message}{hint}") from None


def chosen_tables(built: Built, names: Sequence[str] | None, run: str) -> tuple[TableLayout, ...]:
    """The tables of a run that are wanted; None: all.

    Raises:
        UsageError: the run has no such table.
    """
    if isinstance(names, list | tuple) and not names:
        return ()
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
    """The quantities that tables of a run read, then those asked for, by themselves or in
    expressions; `session` is the run's. What there is, is asked only where something is wanted.

    Raises:
        UsageError: an unknown quantity.
    """
    asked = () if quantities is None else texts("quantities", quantities, '["O4.theta"]')
    if not layouts and not asked:
        return []
    always = row_texts(run)
    used = _read_by(session, tuple(layouts))
    return [*used, *(n for text in asked if text not in always for n in _named_in(session, text))]


def _named_in(session: Session, text: str) -> list[str]:
    """A quantity, or those that an expression reads."""
    problem = session.problem
    known = problem.quantities()
    if text in known:
        return [text]
    try:
        names = sorted(problem.definitions.parse(text).names)
    except ExpressionError:
        names = [text]
    found = [name for name in names if name not in problem.parameters]
    for name in found:
        if name not in known:
            near = nearest_hint(name, problem.told_quantities)
            hint = problem.why_not(name) or near or QUANTITIES
            raise UsageError(f"there is no quantity {name[:LONGEST_NAME]}; {hint}")
    return found


@remembered
def _read_by(session: Session, layouts: tuple[TableLayout, ...]) -> list[str]:
    return used_quantities(layouts, session.problem.quantities())


def refuse_unknown_mode(diagnostics: Iterable[Diagnostic]) -> None:
    """Of a run in a mode that was asked for, by what it says.

    Raises:
        UsageError: there is no such mode.
    """
    for diagnostic in diagnostics:
        if diagnostic.code == "no-such-mode":
            raise UsageError(f"{diagnostic.message}: {diagnostic.measured}")


class _Asked(NamedTuple):
    """A sweep that is asked for: with its tables, the quantities that they read beside those named,
    and what else the file wants of it."""

    sweep: Sweep
    layouts: tuple[TableLayout, ...]
    names: tuple[str, ...]
    systems: tuple[CoefficientsLayout, ...]
    balances: tuple[AnyBalance, ...]


def _asked(
    model: Solvable,
    quantities: Iterable[str] | None,
    tables: Sequence[str] | None,
    mode: str | None,
    closed_at: Sequence[str] | None,
    packing: Packing,
) -> _Asked:
    """The sweep of a model as it is asked for, with the balances of the file; arguments and errors
    are those of `Model.analyze`."""
    if SWEEP not in model.runs:
        raise UsageError(
            f"{model.name} has no sweep: its file has no motion:; its responses are run by "
            f'respond("{model.runs[0]}")'
        )
    if mode is not None:
        a_text("mode", mode, '"A"')
    named = None if quantities is None else texts("quantities", quantities, '["O4.theta"]')
    of_tables = None if tables is None else texts("tables", tables, '["table_03"]')
    if closed_at is None:
        return _asked_as_driven(model.design, named, of_tables, mode, packing)
    session = _closed_at(model.problem, closed_at)
    return _asked_of(model.design, session, named, of_tables, mode, packing)


@remembered
def _asked_as_driven(
    design: Design,
    quantities: tuple[str, ...] | None,
    tables: tuple[str, ...] | None,
    mode: str | None,
    packing: Packing,
) -> _Asked:
    """The same with the loops closed as the file's are: a script asks one model again and again."""
    return _asked_of(design, design.session, quantities, tables, mode, packing)


def _asked_of(
    design: Design,
    session: Session,
    quantities: tuple[str, ...] | None,
    tables: tuple[str, ...] | None,
    mode: str | None,
    packing: Packing,
) -> _Asked:
    built, problem = design.built, design.problem
    if mode is not None:
        session = session.in_mode(mode)
    if problem.motion.rest is not None:
        session = statics.rested(session)
    layouts = chosen_tables(built, tables, SWEEP)
    balances = chosen(built.balances, tables)
    named = wanted_names(session, SWEEP, (), quantities)
    names = [*wanted_names(session, SWEEP, layouts, None), *named]
    asked = tuple(names)
    if balances:
        names += read_by(balances, problem)
    refuse_loaded_spin(session, names)
    # the table of a file that has none shows rates, too
    own = tuple(table for table in layouts if table.name == SWEEP)
    unasked = {*wanted_names(session, SWEEP, own, None)} - {*named} if own else set()
    packed = session if packing == session.packing else session.packed(packing)
    sweep = Sweep(packed, names, unasked=unasked)
    return _Asked(sweep, layouts, asked, chosen(built.coefficients, tables), balances)


def run_sweep(
    model: Solvable,
    quantities: Iterable[str] | None,
    *,
    tables: Sequence[str] | None,
    mode: str | None,
    closed_at: Sequence[str] | None,
    lanes: int,
    threads: int,
    errors: bool,
) -> Analysis:
    """Runs the sweep of a model; arguments and errors are those of `Model.analyze`."""
    packing = a_packing(lanes, threads)
    asked = _asked(model, quantities, tables, mode, closed_at, packing)
    result = asked.sweep.run()
    analysis = Analysis(
        model, asked.layouts, result, SWEEP, asked.systems, asked.balances, asked.names
    )
    if mode is not None:
        refuse_unknown_mode(analysis.diagnostics)
    if errors:
        _ = analysis.errors
    return analysis


def stream_run(
    model: Solvable,
    run: str | None,
    quantities: Iterable[str] | None,
    rows: int,
    tables: Sequence[str] | None,
    mode: str | None,
    lanes: int,
    threads: int,
) -> Stream:
    """A run of a model block by block; arguments and errors are those of `Model.stream`."""
    if run is None or run == SWEEP:
        return _stream_sweep(model, quantities, rows, tables, mode, lanes, threads)
    return _stream_response(model, run, quantities, rows, tables, mode, lanes, threads)


def _stream_sweep(
    model: Solvable,
    quantities: Iterable[str] | None,
    rows: int,
    tables: Sequence[str] | None,
    mode: str | None,
    lanes: int,
    threads: int,
) -> Stream:
    from mechkin_cli.analysis.stream import Beside, Stream

    packing = a_packing(lanes, threads)
    rows = a_whole_number("rows", rows, "rows of a block", least=1)
    asked = _asked(model, quantities, tables, mode, None, packing)
    if mode is not None:
        refuse_unknown_mode(asked.sweep.start.diagnostics)
    beside = Beside(asked.systems, asked.balances)
    return Stream(model, asked.layouts, asked.sweep, rows, wanted=beside)


def _stream_response(
    model: Solvable,
    name: str,
    quantities: Iterable[str] | None,
    rows: int,
    tables: Sequence[str] | None,
    mode: str | None,
    lanes: int,
    threads: int,
) -> Stream:
    from mechkin_cli.analysis.stream import Stream

    packing = a_packing(lanes, threads)
    rows = a_whole_number("rows", rows, "rows of a block", least=1)
    run = response_name(model.design.at_responses.problem, name)
    asked = _asked_run(model, run, quantities, tables, mode)
    blocks = response_room.ResponseBlocks(
        asked.problem, asked.response, asked.names, packing, asked.session
    )
    if mode is not None:
        refuse_unknown_mode(blocks.start.diagnostics)
    return Stream(model, asked.layouts, blocks, rows, asked.response.name)


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
        return Session.of(problem, closed_at=closings)
    except UnsolvableGraph as error:
        why = f"closed_at {', '.join(closings) or 'nothing'}: {error.diagnostic.message}"
        cure = "leave out closed_at, or choose other closing joints"
        raise UsageError(f"{why}; {cure}") from None


class _AskedRun(NamedTuple):
    """A response or equilibria that are asked for, with their tables and the quantities that these
    read beside those named."""

    problem: Problem
    response: ResponseProblem
    session: Session
    layouts: tuple[TableLayout, ...]
    names: tuple[str, ...]


def _asked_run(
    model: Solvable,
    run: str,
    quantities: Iterable[str] | None,
    tables: Sequence[str] | None,
    mode: str | None,
) -> _AskedRun:
    """A run of a model as it is asked for; arguments and errors are those of `Model.respond`."""
    design = model.design.at_responses
    problem = design.problem
    if run not in problem.responses:
        response_name(problem, run)  # which says what there is
    session = model.design.session_of(run)
    response = problem.responses[run]
    if mode is not None:
        a_text("mode", mode, '"A"')
        assembly = replace(response.assembly, near={}, mode=mode)
        response = replace(response, assembly=assembly)
        session = session.assembled(assembly)
    layouts = chosen_tables(design.built, tables, run)
    names = wanted_names(session, run, layouts, quantities)
    return _AskedRun(problem, response, session, layouts, tuple(names))


def respond(
    model: Solvable,
    name: str | None,
    quantities: Iterable[str] | None,
    *,
    tables: Sequence[str] | None,
    mode: str | None,
    lanes: int,
    threads: int,
) -> Analysis:
    """Runs a response of a model; arguments and errors are those of `Model.respond`."""
    run = response_name(model.design.at_responses.problem, name)
    return run_free(model, run, quantities, tables, mode, a_packing(lanes, threads))


ASKED = "equilibrium"
"""The name of equilibria that are asked for and that the file does not have."""


def asking(
    design: Design,
    near: Mapping[str, Setting] | None,
    window: Mapping[str, tuple[Setting, Setting]] | None,
) -> tuple[str, Design]:
    """A design with equilibria beside those of its file, and their name.

    Raises:
        UsageError: values of no use.
        InvalidFile: too few coordinates are named, or too many.
    """
    if near is not None and window is not None:
        raise UsageError("near asks for one equilibrium, window for all: give one of them")
    built, name = design.at_responses.built, ASKED
    while name in built.runs:
        name += "_"
    places = {} if near is None else settings("near", near, '{"A.theta": 20}')
    ends = {}
    for coordinate, pair in ({} if window is None else window).items():
        if not isinstance(pair, list | tuple) or len(pair) != 2:
            raise UsageError(f"window: {coordinate} is no pair; write {{'A.theta': (-90, 90)}}")
        ends[coordinate] = [a_setting("window", each) for each in pair]
    section = section_of(
        Equilibrium,
        near={key: _written(value) for key, value in places.items()},
        window={
            key: section_of(CoordinateWindow, **{"from": _written(low), "to": _written(high)})
            for key, (low, high) in ends.items()
        },
    )
    # the file's tables belong to its own runs
    file = section_with(
        built.file, equilibria={**built.file.equilibria, name: section}, tables=(), balances=()
    )
    made = build(file, built.document, design.given)
    return name, _Asking(made, design.stem, design.given, (design, near, window))


class _Asking(Design):
    """A design with equilibria that its text does not have; `asked` is what it was made of."""

    def __init__(
        self, built: Built, stem: str, given: Mapping[str, Quantity], asked: tuple[Any, ...]
    ) -> None:
        super().__init__(built, stem, given)
        self.asked = asked

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as what it was made of."""
        return _asked_again, self.asked


def _asked_again(
    design: Design,
    near: Mapping[str, Setting] | None,
    window: Mapping[str, tuple[Setting, Setting]] | None,
) -> Design:
    return asking(design, near, window)[1]


def _written(value: Setting) -> str:
    return value if isinstance(value, str) else repr(float(value))


def equilibrium(
    model: Solvable,
    name: str | None,
    quantities: Iterable[str] | None,
    *,
    tables: Sequence[str] | None,
    mode: str | None,
    lanes: int,
    threads: int,
) -> Analysis:
    """Finds equilibria of a model; arguments and errors are those of `Model.equilibrium`."""
    run = equilibrium_name(model.design.at_responses.problem, name)
    return run_free(model, run, quantities, tables, mode, a_packing(lanes, threads))


def run_free(
    model: Solvable,
    run: str,
    quantities: Iterable[str] | None = None,
    tables: Sequence[str] | None = None,
    mode: str | None = None,
    packing: Packing = _ANY_PACKING,
) -> Analysis:
    """A response, or equilibria, by name; errors are those of `Model.respond`."""
    asked = _asked_run(model, run, quantities, tables, mode)
    args = (asked.problem, asked.response, asked.names, packing, asked.session)
    result: Result
    if asked.response.search is None:
        result = response_room.respond(*args)
    else:
        result = statics.balance(*args)
    analysis = Analysis(model, asked.layouts, result, run, asked=asked.names)
    if mode is not None:
        refuse_unknown_mode(analysis.diagnostics)
    return analysis
