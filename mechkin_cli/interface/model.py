"""A checked mechanism file, and the questions that can be asked of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from mechkin_cli.building.build import Built
from mechkin_cli.building.columns import used_quantities
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.interface.analysis import Analysis
from mechkin_cli.interface.settings import Setting, input_values
from mechkin_cli.kernel.width import check_width
from mechkin_cli.mechanism.derived_quantities import hint_of
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.solver.session import Packing, Session
from mechkin_cli.tables.layout import TableLayout

if TYPE_CHECKING:
    from mechkin_cli.analysis.mobility import Mobility
    from mechkin_cli.analysis.modes import Modes
    from mechkin_cli.analysis.ranges import Ranges


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

    @cached_property
    def session(self) -> Session:
        """The mechanism in the kernel, as the file drives it; every question goes through it.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return Session(self.problem, self.graph)

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
        session, problem = self.session, self.problem
        if closed_at:
            session = Session(problem, closed_at=closed_at)
        if mode is not None:
            session = session.assembled(replace(problem.assembly, near={}, mode=mode))
        layouts = self._chosen_tables(tables)
        names = [*used_quantities(layouts, problem.quantities()), *(quantities or ())]
        for name in names:
            if name not in self.quantities:
                hint = hint_of(name)
                raise UsageError(f"there is no quantity {name}" + (f"; {hint}" if hint else ""))
        self._refuse_loaded_spin(problem, names)
        analysis = Analysis(self, layouts, session.packed(Packing(lanes)), names)
        for diagnostic in analysis.diagnostics if mode is not None else ():
            if diagnostic.code == "no-such-mode":
                raise UsageError(f"{diagnostic.message}: {diagnostic.measured}")
        return analysis

    def _refuse_loaded_spin(self, problem: Problem, names: Iterable[str]) -> None:
        """Forces need what spins freely to have no cause to spin."""
        known = problem.quantities()
        if not find_legs(problem.mechanism):
            return
        if demand_of(problem.mechanism, [known[name] for name in names]) & Demand.FORCES:
            from mechkin_cli.mechanism.idle import spin_errors

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
            >>> from mechkin_cli import load
            >>> [mode.name for mode in load("mechanisms/rcsr.yaml").modes(at=170).modes]
            ['A', 'B']
        """
        from mechkin_cli.analysis.modes import find_modes

        places = None if at is None else input_values(self.problem, at)
        return find_modes(self.session, places)

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

        return find_ranges(self.session, input, tuple(outputs))

    def mobility(self) -> Mobility:
        """What can move: Kutzbach's count, the true mobility, idle freedoms, redundant constraints.

        Inputs need not be declared.

        Example:
            >>> from mechkin_cli import load
            >>> load("mechanisms/bennett.yaml").mobility().mobility
            1
        """
        from mechkin_cli.analysis.mobility import find_mobility

        solvable = not isinstance(self._built.graph, Diagnostic)
        return find_mobility(self.problem, self.session if solvable else None)

    def _chosen_tables(self, names: Sequence[str] | None) -> tuple[TableLayout, ...]:
        if names is None:
            return self.tables
        known = {table.name: table for table in self.tables}
        for name in names:
            if name not in known:
                raise UsageError(f"there is no table {name}; tables are {', '.join(known)}")
        return tuple(known[name] for name in dict.fromkeys(names))
