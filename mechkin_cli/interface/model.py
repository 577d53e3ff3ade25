"""A checked mechanism file, and the questions that can be asked of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from mechkin_cli.building.build import Built
from mechkin_cli.diagnostics import Diagnostic, InvalidFile
from mechkin_cli.interface.analysis import Analysis
from mechkin_cli.interface.arguments import Setting, a_text, texts
from mechkin_cli.interface.asking import run_name
from mechkin_cli.interface.certified import Certified
from mechkin_cli.interface.fitted import Fitted
from mechkin_cli.interface.kept import Kept
from mechkin_cli.interface.settings import input_values
from mechkin_cli.interface.studied import Studied
from mechkin_cli.interface.toleranced import Toleranced
from mechkin_cli.interface.viewed import Viewed
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.named import Named
from mechkin_cli.runs import SWEEP
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.solver.session import Session
from mechkin_cli.tables.layout import TableLayout

if TYPE_CHECKING:
    from typing import Any

    from mechkin_cli.analysis.mobility import Mobility
    from mechkin_cli.analysis.modes import Modes
    from mechkin_cli.analysis.ranges import Ranges
    from mechkin_cli.interface.positions import Position, Solver
    from mechkin_cli.interface.variants import Reduce, Variants
    from mechkin_cli.interface.varied import Base
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.precise import Precise


class Model(Kept, Certified, Fitted, Studied, Toleranced, Viewed):
    """A checked mechanism file, as `mk.load` and `mk.loads` return it.

    `analyze` runs its sweep, `respond` its responses; `modes`, `ranges` and `mobility` tell how it
    can be assembled and moved. Values are in the file's units throughout."""

    def __init__(self, built: Built, stem: str) -> None:
        self.built = built
        self.stem = stem
        self._solvers: dict[tuple[str, ...] | None, Solver] = {}
        self._sessions: dict[str, Session] = {}

    @property
    def name(self) -> str:
        """The mechanism's name."""
        return self.problem.mechanism.name

    @property
    def source(self) -> str:
        """Where the mechanism comes from, as its file says; "" where it does not."""
        return self.built.source

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        return self.built.problem

    @property
    def graph(self) -> SolverGraph:
        """Tree, closing joints and blocks.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return self._sound(self.built.graph)

    def response(self, name: str) -> Response:
        """What one of the file's responses asks for, in SI."""
        return self.built.problem.responses[name]

    def response_graph(self, name: str) -> SolverGraph:
        """Tree, closing joints and blocks at the start of a response; InvalidFile where that names
        too few coordinates or too many, or nothing is free."""
        graph = self._sound(self.built.response_graphs[name])
        response = self.built.problem.responses[name]
        if response.independent:
            return graph
        text = "nothing is free to move in this response: all its freedoms are driven"
        hint = "write the laws under motion: {time: ..., inputs: ...}, which is a sweep in time"
        return self._sound(Diagnostic("nothing-free", "error", text, response.place, hint=hint))

    def _sound(self, graph: SolverGraph | Diagnostic) -> SolverGraph:
        if isinstance(graph, Diagnostic):
            raise InvalidFile([*self.diagnostics, graph])
        return graph

    @cached_property
    def session(self) -> Session:
        """The mechanism in the kernel, as the file drives it; every question goes through it.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return Session(self.problem, self.graph).reading(lambda: self.precise)

    @cached_property
    def precise(self) -> Precise:
        """The numbers of this model's sessions as the file's text says them, in double-double.

        Raises:
            TraceLost: a number depends on the text in a way that no tape holds.
        """
        from mechkin_cli.building.recording import precise

        return precise(self.built, self.problem)

    @property
    def tables(self) -> Named[TableLayout]:
        """Layouts of the file's tables, in order and by name; a run without any has one of its own
        name."""
        return Named(self.built.tables)

    @property
    def runs(self) -> tuple[str, ...]:
        """The file's runs by name: `sweep`, unless it has responses alone, then its responses."""
        return self.built.runs

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
        threads: int = 0,
        errors: bool = False,
    ) -> Analysis:
        """Runs the sweep.

        Args:
            quantities: names to compute besides those that the tables read; None: no others.
            tables: names of the tables wanted; None: all, [] none.
            mode: assembly mode at the first row instead of the file's choice.
            closed_at: closing joints to use (the answers do not depend on them).
            lanes: rows computed side by side, 2, 4 or 8; 0: the most the machine can.
            threads: how many split the rows; 0: all cores. Answers depend on neither.
            errors: measure the true error of every cell now, not when `errors` is first read.

        Returns:
            The run: `r["O4.theta"]` is an array (rows,), a vector (rows, 3), or (rows, 2) in a
            plane; nan where a row has no value, and `r["row.status"]` says why.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: an unknown table, quantity or mode, or a width that the machine lacks.
        """
        from mechkin_cli.interface.sweeps import run_sweep

        return run_sweep(self, quantities, tables, mode, closed_at, lanes, threads, errors)

    def respond(
        self,
        name: str | None = None,
        quantities: Iterable[str] | None = None,
        *,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Analysis:
        """Runs one of the file's responses: the motion under its loads and efforts.

        Args:
            name: of the response; None: the only one.
            quantities: names to compute beside what its tables read.
            tables: names of its tables that are wanted; None: all, [] none.
            mode: assembly mode at the start instead of the file's choice.
            lanes: width of the kernel's packs, 0 for the widest (no answer depends on it).
            threads: how many split the rows, 0 for all cores where that pays (nor on this).

        Returns:
            As `analyze`; the rows end with that of the stop that was met, and `row.event` says
            which.

        Raises:
            InvalidFile: the start names too few coordinates or too many.
            UsageError: an unknown response, table, quantity or mode, or a width that the machine
                lacks.
        """
        from mechkin_cli.interface.responses import respond

        return respond(self, name, quantities, tables, mode, lanes, threads)

    @cached_property
    def _variants(self) -> Base:
        from mechkin_cli.interface.varied import Base

        return Base(self)

    def with_parameters(self, parameters: Mapping[str, Setting]) -> Model:
        """The model with other values of some parameters: nothing is read, checked or built anew.

        The file's own assembly is continued to that of the new parameters, along the straight line
        between them; where it ends before, rows are `branch-lost`.

        Args:
            parameters: values by name; a number is in the unit that the parameter has in the file's
                units, a text carries its own.

        Raises:
            UsageError: an unknown parameter, or an invalid value.
            InvalidFile: what the file says does not hold for these values.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/rcsr.yaml")
            >>> m.with_parameters({"P1": "0.52 in"}).analyze()["O4.theta"][:2].round(3).tolist()
            [36.504, 36.269]
        """
        from mechkin_cli.interface.varied import with_parameters

        return with_parameters(self._variants, parameters)

    def vary(
        self,
        parameters: Mapping[str, Any],
        quantities: Iterable[str] | None = None,
        reduce: Reduce | Sequence[Reduce] | Mapping[str, Any] | None = None,
        *,
        run: str = SWEEP,
        lanes: int = 0,
        threads: int = 0,
    ) -> Variants:
        """Many variants at once: what `with_parameters(...).analyze()` gives of each, in one array.

        Every variant starts from the file's own parameters, never from a neighbour, so that the
        bytes do not depend on the other variants, their order, lanes or threads.

        Args:
            parameters: by name, arrays of one dimension and one length, or one value for all
                variants; numbers and texts as in `with_parameters`.
            quantities: quantities or expressions; None: all joint coordinates.
            reduce: what is kept of the rows: "max", "min", "peak" (largest magnitude), "range",
                "mean", "rms", a function from (variants, rows) to (variants,), several of these, or
                any of it by quantity. Rows without a solution (nan) do not count; means are taken
                over the way between finite rows, as in `r.summary()`.
            run: a response instead of the sweep, as `with_parameters(...).respond(run)` gives it;
                where a stop ends it, its row takes the place of the next moment.
            lanes, threads: width of the kernel's packs, how many split the variants; 0: the most.

        Raises:
            UsageError: unknown names, invalid values, lengths that differ, a width not to be had.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/rcsr.yaml")
            >>> r = m.vary({"P1": [0.48, 0.5, 0.52]}, ["O1.effort"], reduce="peak")
            >>> r["O1.effort"].round(2).tolist()
            [147.41, 135.04, 125.93]

            The crank that needs the least effort, by scipy:
            >>> from scipy.optimize import minimize_scalar
            >>> def effort(crank):
            ...     varied = m.with_parameters({"P1": crank}).analyze(["O1.effort"], tables=[])
            ...     return abs(varied["O1.effort"]).max()
            >>> least = minimize_scalar(effort, bounds=(0.4, 0.55), method="bounded").fun
            >>> bool(least <= effort(0.5))
            True
        """
        from mechkin_cli.interface.variants import vary

        return vary(self._variants, {}, parameters, quantities, reduce, run, lanes, threads)

    def solve(
        self,
        inputs: Setting | Mapping[str, Setting],
        quantities: Iterable[str] | None = None,
    ) -> Position:
        """One position, continued from the nearest row of the file's sweep, straight in the inputs.

        The answer does not depend on what was asked before. Rates, accelerations and forces are
        those at the rates of the nearest row.

        Args:
            inputs: values by name as in `modes`; those left out keep their value of the first row,
                but one that follows others by its law has to be given with them.
            quantities: names; None: all joint coordinates.

        Returns:
            Values by name in the file's units; nan, and `status` not ok, where the branch ends
            before.

        Raises:
            UsageError: an unknown input or quantity, or an invalid value.

        Example:
            >>> from mechkin_cli import load
            >>> place = load("mechanisms/rcsr.yaml").solve({"O1.theta": 161.5}, ["O4.theta"])
            >>> round(place["O4.theta"], 6), place.status
            (28.438352, 'ok')
        """
        names = None if quantities is None else texts("quantities", quantities, '["O4.theta"]')
        solver = self._solvers.get(names)
        if solver is None:
            from mechkin_cli.interface.positions import solver_of

            solver = self._solvers[names] = solver_of(self, names)
        return solver.solve(inputs)

    def session_of(self, run: str) -> Session:
        """The mechanism in the kernel at the first row of a run: that of a response is driven by
        the coordinates that its start names.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        if run == SWEEP:
            return self.session
        if run not in self._sessions:
            from mechkin_cli.interface.responses import session_at_start

            self._sessions[run] = session_at_start(self, run)
        return self._sessions[run]

    def modes(
        self,
        at: Setting | Mapping[str, Setting] | None = None,
        *,
        run: str | None = None,
        certify: bool = False,
    ) -> Modes:
        """All assembly modes at the first row, or at another place.

        Args:
            run: `sweep`, or a response, whose start is the first row; None: the file's first run.
            at: the input there (of several, the first that the file sweeps), or inputs by name, in
                the file's units or such as "0.5 rad"; those left out are as in the first row.
            certify: prove that each exists and that all are different (`proofs`).

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: an unknown input or run, or an invalid value.

        Example:
            >>> from mechkin_cli import load
            >>> [mode.name for mode in load("mechanisms/rcsr.yaml").modes(at=170).modes]
            ['A', 'B']
        """
        from mechkin_cli.analysis.modes import find_modes

        session = self.session_of(run_name(self.runs, run))
        places = None if at is None else input_values(session.problem, at)
        return find_modes(session, places, certify=certify)

    def ranges(self, input: str | None = None, outputs: Iterable[str] = ()) -> Ranges:
        """The ranges of an input over which each mode assembles, and the circuits they form.

        Args:
            input: its name; None: the first that the file sweeps. Others stay as in the first row.
            outputs: coordinates whose dead centres (extremes) are wanted, too.

        Returns:
            A range for each mode, with what ends it, dead centres and circuits.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: no input, or an unknown input or coordinate.
        """
        from mechkin_cli.analysis.ranges import find_ranges

        if input is not None:
            a_text("input", input, '"O1.theta"')
        names = texts("outputs", outputs, '["O4.theta"]')
        return find_ranges(self.session, input, names)

    def mobility(self) -> Mobility:
        """What can move: Kutzbach's count, the true mobility, idle freedoms, redundant constraints.

        Inputs need not be declared.

        Example:
            >>> from mechkin_cli import load
            >>> load("mechanisms/bennett.yaml").mobility().mobility
            1
        """
        from mechkin_cli.analysis.mobility import find_mobility

        solvable = not isinstance(self.built.graph, Diagnostic)
        return find_mobility(self.problem, self.session if solvable else None)
