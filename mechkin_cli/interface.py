"""The Python interface: load a mechanism file, analyze it, read quantities by name.

The commands are thin calls of these.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis.idle import spin_errors
from mechkin_cli.analysis.problem import Problem
from mechkin_cli.analysis.result import Result
from mechkin_cli.analysis.sweep import analyze as run_sweep
from mechkin_cli.building.build import Built, build
from mechkin_cli.building.columns import used_quantities
from mechkin_cli.building.source import open_file, open_text
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.expressions import Expression, Vector, parse
from mechkin_cli.kernel.width import check_width
from mechkin_cli.mechanism.derived_quantities import hint_of
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.graph import ANGLES, SolverGraph
from mechkin_cli.tables.columns import Columns, evaluate, mode_words, status_words
from mechkin_cli.tables.layout import ROW_TEXTS, TableLayout
from mechkin_cli.tables.uniqueness import unique_cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.mobility import Mobility
    from mechkin_cli.analysis.modes import Modes
    from mechkin_cli.analysis.ranges import Ranges

_NO_PARAMETERS: Mapping[str, str] = MappingProxyType({})


Setting = str | float


def _texts(parameters: Mapping[str, Setting]) -> dict[str, str]:
    """Parameters as texts; a number stands for itself, without a unit."""
    return {k: v if isinstance(v, str) else repr(float(v)) for k, v in parameters.items()}


def load(path: str | Path, parameters: Mapping[str, Setting] = _NO_PARAMETERS) -> Model:
    """Reads and checks a mechanism file.

    Args:
        path: the YAML file.
        parameters: what replaces values of its `parameters:`, such as {"P1": "0.6 in"}; a number
            has no unit.

    Raises:
        UsageError: the file cannot be read, or an unknown parameter.
        InvalidFile: with every independent error and its place.

    Example:
        >>> load("mechanisms/rcsr.yaml").name
        'RCSR'
    """
    return Model(build(open_file(path, _texts(parameters))), Path(path).stem)


def loads(
    text: str, name: str = "text", parameters: Mapping[str, Setting] = _NO_PARAMETERS
) -> Model:
    """As `load`, for the text of a mechanism file; `name` stands for the file in messages."""
    return Model(build(open_text(text, name, _texts(parameters))), Path(name).stem)


class Model:
    """A checked mechanism file."""

    def __init__(self, built: Built, stem: str) -> None:
        self._built = built
        self.stem = stem

    @property
    def name(self) -> str:
        """The mechanism's name."""
        return self.problem.mechanism.name

    @property
    def source(self) -> str:
        """Where the mechanism comes from, as its file says; "" where it does not."""
        return self._built.source

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        return self._built.problem

    @property
    def graph(self) -> SolverGraph:
        """Tree, closing joints and blocks.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        graph = self._built.graph
        if isinstance(graph, Diagnostic):
            raise InvalidFile([*self.diagnostics, graph])
        return graph

    @property
    def tables(self) -> tuple[TableLayout, ...]:
        """Layouts of the file's tables; without any, the one table `sweep`."""
        return self._built.tables

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Warnings of the file."""
        return self.problem.diagnostics

    @cached_property
    def quantities(self) -> frozenset[str]:
        """Names of all quantities that columns and `Analysis` can use."""
        return frozenset(self.problem.quantities())

    def analyze(
        self,
        quantities: Iterable[str] | None = None,
        *,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
        closed_at: Sequence[str] | None = None,
        lanes: int = 0,
    ) -> Analysis:
        """Runs the sweep.

        Args:
            quantities: names to compute beside what the tables read; None: nothing beside them.
            tables: names of the tables wanted; None: all, [] none.
            mode: assembly mode at the first row instead of the file's choice.
            closed_at: closing joints to use (the answers do not depend on them).
            lanes: width of the kernel's packs, 0 for the widest (nor on this).

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: an unknown table, quantity or mode, or a width that the machine lacks.
        """
        check_width(lanes)
        problem, _ = self.problem, self.graph
        if mode is not None:
            problem = replace(problem, assembly=replace(problem.assembly, near={}, mode=mode))
        layouts = self._chosen_tables(tables)
        names = [*used_quantities(layouts, problem.quantities()), *(quantities or ())]
        for name in names:
            if name not in self.quantities:
                hint = hint_of(name)
                raise UsageError(f"there is no quantity {name}" + (f"; {hint}" if hint else ""))
        self._refuse_loaded_spin(problem, names)
        closings = list(closed_at) if closed_at else None
        sweep = partial(run_sweep, problem, closed_at=closings, lanes=lanes)
        analysis = Analysis(self, layouts, sweep, names)
        for diagnostic in analysis.diagnostics if mode is not None else ():
            if diagnostic.code == "no-such-mode":
                raise UsageError(f"{diagnostic.message}: {diagnostic.measured}")
        return analysis

    def _refuse_loaded_spin(self, problem: Problem, names: Iterable[str]) -> None:
        """Forces need what spins freely to have no cause to spin."""
        known = problem.quantities()
        if demand_of(problem.mechanism, [known[name] for name in names]) & Demand.FORCES:
            for _, diagnostic in spin_errors(problem):
                raise UsageError(str(diagnostic))

    def modes(self, at: Setting | Mapping[str, Setting] | None = None) -> Modes:
        """All assembly modes at the first row, or at another place.

        Args:
            at: the input there (of several, the first that the file sweeps), or inputs by name;
                a number is in the file's units, a text may carry its own ("0.5 rad"). Inputs that
                are not given keep their value of the first row.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: an unknown input, or a value that is none.

        Example:
            >>> [mode.name for mode in load("mechanisms/rcsr.yaml").modes(at=170).modes]
            ['A', 'B']
        """
        from mechkin_cli.analysis.modes import find_modes

        places = None if at is None else self._places(at)
        return find_modes(self.problem, self.graph, places)

    def ranges(self, input: str | None = None, outputs: Iterable[str] = ()) -> Ranges:
        """The ranges of an input over which each mode assembles, and the circuits they form.

        Args:
            input: an input's name; None: the first that the file sweeps. Others are held as in the
                first row.
            outputs: coordinates whose dead centres (extremes) are wanted, too.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: no input, or an unknown input or coordinate.
        """
        from mechkin_cli.analysis.ranges import find_ranges

        return find_ranges(self.problem, self.graph, input, tuple(outputs))

    def mobility(self) -> Mobility:
        """What can move: Kutzbach's count, the true mobility, idle freedoms, redundant constraints.

        Inputs need not be declared.

        Example:
            >>> load("mechanisms/bennett.yaml").mobility().mobility
            1
        """
        from mechkin_cli.analysis.mobility import find_mobility

        return find_mobility(self.problem)

    def _places(self, at: Setting | Mapping[str, Setting]) -> dict[str, float]:
        """Inputs by name in the file's units."""
        inputs = {item.name: item for item in self.problem.motion.inputs}
        if not isinstance(at, Mapping):
            swept = [name for name, item in inputs.items() if np.ptp(item.written) > 0.0]
            names = swept or list(inputs)
            if not names:
                raise UsageError(f"{self.name} has no input to be put at {at}")
            at = {names[0]: at}
        places = {}
        for name, value in at.items():
            if name not in inputs:
                raise UsageError(f"{name} is no input; inputs are {', '.join(inputs) or 'none'}")
            places[name] = self._input_value(name, value)
        return places

    def _input_value(self, name: str, value: Setting) -> float:
        """A value of an input in the file's units."""
        from mechkin_cli.expressions import ExpressionError, constant_in_file_units, lookup
        from mechkin_cli.units import ANGLE, LENGTH

        text = value if isinstance(value, str) else repr(float(value))
        dimension = ANGLE if name.partition(".")[2] in ANGLES else LENGTH
        resolve = lookup(self.problem.parameters)
        try:
            return constant_in_file_units(text, dimension, self.problem.units, resolve)
        except ExpressionError as error:
            hint = f"; {error.hint}" if error.hint else ""
            raise UsageError(f"{name} at {text}: {error.message}{hint}") from None

    def _chosen_tables(self, names: Sequence[str] | None) -> tuple[TableLayout, ...]:
        if names is None:
            return self.tables
        known = {table.name: table for table in self.tables}
        for name in names:
            if name not in known:
                raise UsageError(f"there is no table {name}; tables are {', '.join(known)}")
        return tuple(known[name] for name in dict.fromkeys(names))


class Analysis:
    """Results of a sweep: `r["O2.theta"]` is an array over the rows, in the file's units."""

    def __init__(
        self,
        model: Model,
        layouts: tuple[TableLayout, ...],
        sweep: Callable[[Iterable[str]], Result],
        names: Iterable[str],
    ) -> None:
        self.model = model
        self.layouts = layouts
        self.result = sweep(names)
        self._sweep = sweep
        self._more: dict[str, Result] = {}

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.result.rows

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything that the run has to say."""
        return self.result.diagnostics

    @cached_property
    def tables(self) -> tuple[Columns, ...]:
        """The tables that were asked for, evaluated in the file's units."""
        return tuple(evaluate(layout, self.result) for layout in self.layouts)

    def __getitem__(self, text: str) -> NDArray[Any]:
        """A quantity or an expression of quantities, in the file's units.

        Returns (rows,), for a vector (rows, 3); nan where a row has no solution; `row.status` and
        `row.mode` are arrays of words. What the run did
        not compute is computed now.

        Raises:
            ExpressionError: no such quantity, or dimensions that do not fit.
        """
        if text in ROW_TEXTS:
            words = mode_words if text == "row.mode" else status_words
            return np.array(words(self.result).texts())
        for given in (self.result.inputs, self.result.input_rates):
            if text in given:
                return given[text].copy()
        expression = parse(text)
        result = self._with(expression.names)
        columns = self._columns(expression, result)
        others = [self._columns(expression, other) for other in result.alternatives]
        settled = [
            unique_cells(column, [other[i] for other in others]) for i, column in enumerate(columns)
        ]
        return np.stack(settled, axis=1) if len(settled) > 1 else settled[0]

    def _columns(self, expression: Expression, result: Result) -> list[NDArray[np.float64]]:
        """The value of an expression in the file's units: one column, or three of a vector."""
        found = expression.evaluate(result.quantity, result.units)
        value = found.value
        parts = [value.x, value.y, value.z] if isinstance(value, Vector) else [value]
        return [self._column(part, found.dimension) for part in parts]

    def _column(self, value: object, dimension: object) -> NDArray[np.float64]:
        rows = np.array(np.broadcast_to(np.asarray(value, float), (self.rows,)))
        return np.asarray(self.result.units.from_si(rows, dimension), float)  # type: ignore[arg-type]

    def _with(self, names: Iterable[str]) -> Result:
        """A result that has all the quantities among some dotted names."""
        known = self.model.quantities
        wanted = []
        for name in names:
            quantity = name if name in known else name.rpartition(".")[0]
            if quantity in known and quantity not in self.result.slots:
                wanted.append(quantity)
        computed = sorted(name for name in wanted if name != "time")
        wanted = [name for name in computed if not name.startswith("row.")]
        if not wanted:
            return self.result
        key = " ".join(wanted)
        if key not in self._more:
            every = [*self.result.slots, *wanted]
            self._more[key] = self._sweep(every)
        return self._more[key]
