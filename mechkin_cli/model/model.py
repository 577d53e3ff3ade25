"""A checked mechanism file, and the questions that can be asked of it: `load`, `loads`, `Model`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, overload

from mechkin_cli import cams, fit, live, mobility, modes, sensitivities, studies, variants, view
from mechkin_cli.analysis import (
    Analysis,
    Design,
    asking,
    equilibrium,
    input_values,
    respond,
    run_free,
    run_name,
    run_sweep,
    stream_run,
)
from mechkin_cli.arguments import Setting, a_path, a_text, a_whole_number, settings, texts
from mechkin_cli.building import Built, open_data, open_file, open_text, read_and_build
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError
from mechkin_cli.mechanism import Problem
from mechkin_cli.model.parameters import Parameters
from mechkin_cli.model.position import Position, solver_of
from mechkin_cli.session import Session
from mechkin_cli.show import Listed, Listing, Named
from mechkin_cli.structure import SolverGraph
from mechkin_cli.tables import TableLayout
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Executor
    from os import PathLike

    from mechkin_cli.analysis import Certificate, Stream
    from mechkin_cli.building import ViewSettings
    from mechkin_cli.cams import Cam
    from mechkin_cli.fit import Fit
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.mobility import Mobility
    from mechkin_cli.modes import Modes, Ranges
    from mechkin_cli.sensitivities import Sensitivities, Tolerances
    from mechkin_cli.session import Precise
    from mechkin_cli.studies import StudyFiles, StudyResults
    from mechkin_cli.variants import Reduce, Variants
    from mechkin_cli.vibration import Vibration


class Model(Listed):
    """A checked mechanism file, as `mk.load` and `mk.loads` return it.

    `analyze` runs its sweep, `respond` its responses, and `equilibrium` finds where its loads
    balance; `modes`, `ranges` and `mobility` tell how it can be assembled and moved, `vibration`
    how it vibrates. Values are in the file's units throughout.

    Attributes:
        design: the file with the values of its parameters, in SI and in the kernel.
    """

    def __init__(self, design: Design) -> None:
        self.design = design

    def of(self, design: Design) -> Model:
        """A model of another design."""
        return Model(design)

    # What the file says.

    @property
    def name(self) -> str:
        """The mechanism's name."""
        return self.problem.mechanism.name

    @property
    def stem(self) -> str:
        """The name of the file without its ending."""
        return self.design.stem

    @property
    def source(self) -> str:
        """Where the mechanism comes from, as its file says; "" where it does not."""
        return self.built.source

    @property
    def built(self) -> Built:
        """The file, checked."""
        return self.design.built

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        return self.design.problem

    @property
    def parameters(self) -> Parameters:
        """The parameters by name: values in the file's units, and `unit(name)`."""
        return Parameters(self.problem)

    @property
    def tables(self) -> Named[TableLayout]:
        """Layouts of the file's tables, in order and by name; a run without any has one of its own
        name."""
        return Named(self.built.tables)

    @property
    def runs(self) -> tuple[str, ...]:
        """The file's runs by name: `sweep`, unless it has others alone, then its responses and its
        equilibria."""
        return self.built.runs

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Warnings of the file."""
        return self.problem.diagnostics

    @cached_property
    def quantities(self) -> frozenset[str]:
        """Names of all quantities that columns and `Analysis` can use."""
        return frozenset(self.problem.told_quantities)

    @property
    def listing(self) -> Listing:
        """Links, joints, inputs and tables; nothing is solved for it."""
        mechanism = self.built.problem.mechanism
        joints = tuple(
            (
                joint.name,
                joint.letter,
                ", ".join(f"{joint.name}.{c}" for c in joint.type.coordinates),
            )
            for joint in mechanism.joints.values()
        )
        inputs = ", ".join(driven.name for driven in self.built.problem.motion.inputs)
        found = {
            "loops": str(mechanism.loops),
            "inputs": inputs or "none",
            "runs": ", ".join(self.built.runs),
            "tables": ", ".join(table.name for table in self.tables),
        }
        notes = tuple(f"{name}: {text}" for name, text in found.items() if text)
        return Listing(
            f"Model of {mechanism.name}", ("joint", "type", "coordinates"), joints, notes
        )

    @property
    def view_settings(self) -> ViewSettings:
        """How the file wants to be shown (`view:`), in SI."""
        return self.design.view_settings

    @property
    def graph(self) -> SolverGraph:
        """Tree, cut joints and blocks.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return self.design.graph

    def response(self, name: str) -> ResponseProblem:
        """What one of the file's responses asks for, in SI."""
        return self.design.response(name)

    def response_graph(self, name: str) -> SolverGraph:
        """Tree, cut joints and blocks at the start of a response.

        Raises:
            InvalidFile: its start names too few coordinates or too many, or nothing is free.
        """
        return self.design.response_graph(name)

    @property
    def session(self) -> Session:
        """The mechanism in the kernel, as the file drives it; every question goes through it.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return self.design.session

    def session_of(self, run: str) -> Session:
        """The mechanism in the kernel at the first row of a run: that of a response is driven by
        the coordinates that its start names.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return self.design.session_of(run)

    @property
    def precise(self) -> Precise:
        """The numbers of this model's sessions as the file's text says them, in double-double.

        Raises:
            TraceLost: a number depends on the text in a way that no tape holds.
        """
        return self.design.precise

    # Runs.

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
            quantities: names and expressions to compute besides what the tables read; None: no
                others.
            tables: names of the tables wanted; None: all, [] none.
            mode: assembly mode at the first row instead of the file's choice: its letter, or
                home for the one drawn.
            closed_at: cut joints to use (the answers do not depend on them).
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
        return run_sweep(
            self,
            quantities,
            tables=tables,
            mode=mode,
            closed_at=closed_at,
            lanes=lanes,
            threads=threads,
            errors=errors,
        )

    def stream(
        self,
        quantities: Iterable[str] | None = None,
        *,
        run: str | None = None,
        rows: int = 4096,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Stream:
        """The sweep block by block, or the response named by `run`, in constant memory: the same
        numbers as those of `analyze` and `respond`.

        Args and errors are those of these; `rows` of a block, but for the last one.

        Returns:
            Gives the blocks one after the other, and says afterwards what the run has to say.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/dissertation/rcsr.yaml")
            >>> blocks = m.stream(["O4.theta"], rows=10)
            >>> [round(float(block["O4.theta"].max()), 3) for block in blocks][:2]
            [37.231, 11.327]
        """
        return stream_run(self, run, quantities, rows, tables, mode, lanes, threads)

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
            mode: assembly mode at the start instead of the file's choice: its letter, or home
                for the one drawn.
            lanes: width of the kernel's packs, 0 for the widest (no answer depends on it).
            threads: how many split the rows, 0 for all cores where that pays (nor on this).

        Returns:
            As `analyze`; the rows end with that of the stop that was met, and `row.event` says
            which.

        Raises:
            InvalidFile: the start names too few coordinates or too many.
            UsageError: an unknown response, table, quantity or mode, or a width as of `analyze`.
        """
        return respond(
            self, name, quantities, tables=tables, mode=mode, lanes=lanes, threads=threads
        )

    def equilibrium(
        self,
        name: str | None = None,
        quantities: Iterable[str] | None = None,
        *,
        near: Mapping[str, Setting] | None = None,
        window: Mapping[str, tuple[Setting, Setting]] | None = None,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Analysis:
        """Places at which all loads balance: those of the file's `equilibria:`, or others.

        Args:
            name: of the file's equilibria; None: the only ones.
            quantities: names to compute beside what its tables read.
            near: instead of the file's, one equilibrium from a start: as many independent
                coordinates as are free, in the file's units or such as "0.5 rad".
            window: instead of the file's, all equilibria within the least and the largest values
                of such coordinates, in every assembly mode.
            tables: names of its tables that are wanted; None: all, [] none.
            mode: assembly mode at the start instead of the file's choice.
            lanes: width of the kernel's packs, 0 for the widest (no answer depends on it).
            threads: how many split the rows, 0 for all cores where that pays (nor on this).

        Returns:
            As `analyze`, with a row for each equilibrium, at which nothing moves; `row.event` says
            whether it is stable. Where none was found there is one row without a place.

        Raises:
            InvalidFile: too few coordinates are named, or too many.
            UsageError: unknown equilibria, tables, quantities or modes, or invalid values.

        Example:
            >>> from mechkin_cli import load
            >>> pin = {"type": "R", "links": ["ground", "bob"], "point": [0, 0, 0]}
            >>> m = load({
            ...     "format": 1,
            ...     "links": {"bob": {"mass": 2, "center_of_mass": [0, -0.25, 0]}},
            ...     "joints": {"A": {**pin, "axis": [0, 0, 1]}},
            ...     "loads": [{"type": "gravity", "g": [0, -9.81, 0]}],
            ... })
            >>> r = m.equilibrium(window={"A.theta": (-90, 200)})
            >>> abs(r["A.theta"]).round(6).tolist(), r["row.event"].tolist()
            ([0.0, 180.0], ['stable', 'unstable'])
        """
        model = self
        if near is not None or window is not None:
            name, design = asking(self.design, near, window)
            model = self.of(design)
        return equilibrium(
            model, name, quantities, tables=tables, mode=mode, lanes=lanes, threads=threads
        )

    def run_free(
        self,
        name: str,
        quantities: Iterable[str] | None = None,
        *,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
    ) -> Analysis:
        """A response or equilibria by name: what `respond` and `equilibrium` give.

        Raises:
            InvalidFile: too few coordinates are named, or too many.
            UsageError: an unknown run, table or mode.
        """
        return run_free(self, name, quantities, tables, mode)

    def vibration(
        self,
        run: str | None = None,
        row: int = 0,
        coordinates: Sequence[str] | None = None,
        *,
        held: Sequence[str] = (),
    ) -> Vibration:
        """Small motions about a row of a run: matrices, natural frequencies, mode shapes, state
        space, in SI units.

        Args:
            run: its name; None: the file's first equilibria, else its first run.
            row: its number, from 0.
            coordinates: that name the motion, as many as there are freedoms; None: the inputs of a
                sweep, or the independent coordinates of the run's start.
            held: inputs of a sweep that their drives hold or move; the others are free.

        Raises:
            InvalidFile: the run cannot be solved.
            UsageError: an unknown run, row or coordinate, or a row without a position.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/vibration/engine_mounts.yaml")
            >>> [round(float(f), 2) for f in m.vibration(row=2).frequencies]
            [6.76, 9.23, 10.01, 10.06, 12.09, 13.71]
        """
        from mechkin_cli.model.vibrations import vibration

        return vibration(self, run, row, coordinates, held)

    def analyses(self, run: str | None = None, mode: str | None = None) -> list[Analysis]:
        """All runs of the file, or one.

        Args:
            run: `sweep`, or the name of another; None: all.
            mode: assembly mode at the first row instead of the file's choice: its letter, or
                home for the one drawn.

        Raises:
            InvalidFile: a run cannot be solved as it is driven.
            UsageError: an unknown run or mode.
        """
        runs = self.runs if run is None else (run_name(self.runs, run),)
        return [
            self.analyze(mode=mode) if name == SWEEP else self.run_free(name, mode=mode)
            for name in runs
        ]

    def certify(
        self,
        *,
        mode: str | None = None,
        closed_at: Sequence[str] | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Certificate:
        """Runs the sweep and proves its rows: that each has exactly one position in a small box
        about the one given, and that all lie on one branch.

        Args and errors are those of `analyze`.

        Example:
            >>> from mechkin_cli import load
            >>> proofs = load("mechanisms/dissertation/rcsr.yaml").certify()
            >>> proofs.is_one_branch, sorted(set(proofs.status.tolist()))
            (True, ['proven'])
            >>> low, high = proofs.enclosure("O2.theta")
            >>> bool((high - low < 1e-11).all())
            True
        """
        run = self.analyze(mode=mode, closed_at=closed_at, lanes=lanes, threads=threads)
        return run.certificate

    @overload
    def view(
        self,
        path: None = None,
        *,
        run: str | None = None,
        mode: str | None = None,
        modes: bool = True,
    ) -> view.Page: ...

    @overload
    def view(
        self,
        path: str | PathLike[str],
        *,
        run: str | None = None,
        mode: str | None = None,
        modes: bool = True,
    ) -> Path: ...

    def view(
        self,
        path: str | PathLike[str] | None = None,
        *,
        run: str | None = None,
        mode: str | None = None,
        modes: bool = True,
    ) -> view.Page | Path:
        """Makes a page that shows the mechanism in motion, with curves, tables and notes: one file
        of HTML that needs nothing else. A notebook shows it in its cell.

        Args:
            path: of the page; None: it is not written.
            run: `sweep` or a response alone; None: all runs of the file.
            mode: assembly mode at the first row instead of the file's choice: its letter, or
                home for the one drawn.
            modes: show the other assembly modes, too.

        Returns:
            The path of the page, which is written whole or not at all; without one the page.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: an unknown run or mode, or the page cannot be written there.

        Example:
            >>> from tempfile import TemporaryDirectory
            >>> from mechkin_cli import load
            >>> with TemporaryDirectory() as folder:
            ...     load("mechanisms/dissertation/rcsr.yaml").view(f"{folder}/rcsr.html").name
            'rcsr.html'
        """
        page, _ = view.view_page(self.analyses(run, mode), modes)
        return view.Page(page) if path is None else view.write_view(path, page)

    def widget(self, *, run: str | None = None, mode: str | None = None, modes: bool = True) -> Any:
        """The page of `view` as a widget of a notebook (anywidget: Jupyter, marimo): `w.parameters`
        (a dict of values in the file's units) and `w.row` follow the page, and the page follows
        them; `w.model` is the model with these parameters.

        Raises:
            UsageError: anywidget is not installed (extra `notebook`), an unknown run or mode.
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return view.widget_of(self, run, mode, modes)

    def live_record(self, analysis: Any, data: Mapping[str, Any]) -> dict[str, Any]:
        """What a page of a run computes it from with other parameters, beside the `data` that it
        shows, or `why` it cannot: see `mechkin_cli.live`."""
        return live.live_record(analysis, data)

    # Positions, modes, what can move.

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
            >>> place = load("mechanisms/dissertation/rcsr.yaml").solve({"O1.theta": 161.5})
            >>> round(place["O4.theta"], 6), place.status
            (28.438352, 'ok')
        """
        names = None if quantities is None else texts("quantities", quantities, '["O4.theta"]')
        return solver_of(self.design, names).solve(inputs)

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
            >>> [a.name for a in load("mechanisms/dissertation/rcsr.yaml").modes(at=170).modes]
            ['A', 'B']
        """
        session = self.session_of(run_name(self.runs, run))
        places = None if at is None else input_values(session.problem, at)
        return modes.find_modes(session, places, certify=certify)

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
        if input is not None:
            a_text("input", input, '"O1.theta"')
        names = texts("outputs", outputs, '["O4.theta"]')
        return modes.find_ranges(self.session, input, names)

    def cam(self, coupling: str | None = None, points: int = cams.POINTS) -> Cam:
        """The profile of a disc cam, of a function or a table with a `follower`.

        Args:
            coupling: its name; None: the only one with a follower.
            points: steps of the table over a turn, or over the range of a table.

        Returns:
            Pitch curve, profile, pressure angles and radii of curvature in the file's units, what
            is extreme, and where it is undercut; where the file has a sweep with forces, also where
            the follower would leave the cam. `files()` are its table and drawings.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: an unknown coupling, one without a follower, or no points.

        Example:
            >>> from mechkin_cli import loads
            >>> m = loads('''
            ... format: 1
            ... plane: xy
            ... units: {length: mm, angle: deg}
            ... links: {cam: {}, follower: {}}
            ... joints:
            ...   A: {type: R, links: [ground, cam], point: [0, 0]}
            ...   B: {type: P, links: [ground, follower], point: [0, 50], axis: [0, 1]}
            ... couplings:
            ...   K:
            ...     type: function
            ...     of: A.theta
            ...     gives: B.s
            ...     value: 10 mm*(1 - cos(theta))
            ...     follower: {type: translating, contact: flat, base_radius: 30 mm}
            ... ''')
            >>> cam = m.cam("K")
            >>> round(float(cam.radius.min()), 9), round(float(cam.radius.max()), 9)
            (40.0, 40.0)
        """
        if coupling is not None:
            a_text("coupling", coupling, '"K"')
        points = a_whole_number("points", points, "steps over a turn", least=4)
        swept = None if self.problem.motion.rows < 2 else self._swept
        return cams.cam_of(self.problem, coupling, points, swept)

    def _swept(self, names: Sequence[str]) -> list[Any]:
        """Some quantities in the rows of the sweep, in the file's units."""
        analysis = self.analyze(names, tables=[])
        return [analysis[name] for name in names]

    def mobility(self) -> Mobility:
        """What can move: Kutzbach's count, the true mobility, idle freedoms, redundant constraints.

        Inputs need not be declared.

        Example:
            >>> from mechkin_cli import load
            >>> load("mechanisms/classics/bennett.yaml").mobility().mobility
            1
        """
        solvable = not isinstance(self.built.graph, Diagnostic)
        return mobility.find_mobility(self.problem, self.session if solvable else None)

    # Other parameters.

    def with_parameters(self, parameters: Mapping[str, Setting]) -> Model:
        """The model with other values of some parameters: nothing is read, checked or built anew.

        The file's own assembly is continued to that of the new parameters, along the straight line
        between them; where it ends before, rows are `branch-lost`, and a response chooses anew.

        Args:
            parameters: values by name; a number is in the unit that the parameter has in the file's
                units, a text carries its own.

        Raises:
            UsageError: an unknown parameter, or an invalid value.
            InvalidFile: what the file says does not hold for these values.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/dissertation/rcsr.yaml")
            >>> m.with_parameters({"P1": "0.52 in"}).analyze()["O4.theta"][:2].round(3).tolist()
            [36.504, 36.269]
        """
        design = variants.varied_design(self.design, parameters)
        return self if design is self.design else Model(design)

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
            lanes: width of the kernel's packs; 0: the most.
            threads: how many split the variants; 0: the most.

        Raises:
            UsageError: unknown names, invalid values, lengths that differ, a width not to be had.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/dissertation/rcsr.yaml")
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
        return variants.vary(self, parameters, quantities, reduce, run, lanes, threads)

    def study(
        self,
        study: str | Path | Mapping[str, Any],
        out: str | Path | None = None,
        *,
        format: str = "csv",
        again: bool = False,
        threads: int = 0,
        processes: int = 0,
        executor: Executor | None = None,
        scheduler: str | None = None,
        progress: Callable[[int, int], None] | None = None,
        part: str | None = None,
        merge: bool = False,
    ) -> StudyResults | StudyFiles:
        """Many variants: drawn, crossed or listed, and numbers of each that are kept.

        Args:
            study: a study file, whose `mechanism:` does not count here; or its sections as a dict.
            out: a folder for results of any size, which a run that was stopped goes on with; None:
                they come back as arrays.
            format: of the files, "csv" or "parquet" (extra `parquet`).
            again: begin anew where the folder has results already.
            threads: of the kernel in each process; 0: as many as pay, of workers one.
            processes: so many new processes compute; 0: this one.
            executor: computes instead; any of `concurrent.futures`.
            scheduler: address of a Dask cluster that computes instead (extra `cluster`).
            progress: told how many variants are done, and of how many.
            part: compute only this share, as "3/8", into a folder in `out`.
            merge: compute nothing, put all shares in `out` together.

        Returns:
            Columns over the variants; of a folder its files and an overview.

        Raises:
            InvalidFile: with every independent error of the study and its place.
            UsageError: too many results for the memory, a folder of another study or one that
                another process writes to, what cannot be written, workers that do not answer,
                shares that are missing or do not belong together.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/dissertation/rcsr.yaml")
            >>> r = m.study(
            ...     {"vary": {"P1": [0.48, 0.5, 0.52]}, "keep": [{"of": "O1.effort", "as": "peak"}]}
            ... )
            >>> r["peak(O1.effort)"].round(2).tolist()
            [147.41, 135.04, 125.93]
        """
        workers = studies.Workers(threads, processes, executor, scheduler)
        return studies.study_of(self, study, out, format, again, workers, progress, part, merge)

    def sensitivities(
        self,
        quantities: Iterable[str],
        parameters: Iterable[str] | None = None,
        at: Setting | Iterable[Setting] | None = None,
        *,
        run: str | None = None,
        threads: int = 0,
    ) -> Sensitivities:
        """How quantities change with parameters, to first order, at every row: exact to rounding.

        The rows are closed again in double-double with the parameter a little less and a little
        more, so whatever `--errors` repeats has sensitivities: positions, rates, accelerations,
        reactions, efforts, expressions, columns. A row keeps its number: where inputs are written
        with parameters they move with them, as the file says. Other parameters that are written
        with the one that changes follow it.

        It costs a recording of the file, which the model keeps (0.1 s for the RCSR), and for each
        parameter two runs of the chosen rows in double-double; a response is run and repeated
        anew for both values, which takes seconds.

        Args:
            quantities: quantities, expressions or labels of columns.
            parameters: names; None: all.
            at: values of the input that moves (or of time) at which rows stand, numbers in the
                file's units or texts; None: all rows.
            run: a response instead of the sweep; None: the file's first run.
            threads: how many split the rows, 0 for as many as pay.

        Raises:
            UsageError: unknown names, words instead of numbers, a place without a row.
            ExpressionError: no such quantity, or dimensions that do not fit.
            InvalidFile: the mechanism cannot be solved as it is driven.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/dissertation/rcsr.yaml")
            >>> s = m.sensitivities(["O4.theta"], ["P1", "alpha1"], at=170)
            >>> s["O4.theta", "P1"].round(4).tolist(), s.unit("O4.theta", "P1")
            ([39.755], 'deg/in')
        """
        return sensitivities.sensitivities(self, quantities, parameters, at, run, threads)

    def tolerances(
        self,
        tolerances: Mapping[str, Setting | Sequence[Setting]],
        quantities: Iterable[str],
        at: Setting | Iterable[Setting] | None = None,
        *,
        samples: int = 1024,
        method: str = "latin",
        seed: int = 0,
        distribution: str = "uniform",
    ) -> Tolerances:
        """What tolerances of parameters do to quantities: worst cases, root sum square and shares
        to first order, and samples beside them.

        Args:
            tolerances: by name half the width of a band about the parameter's own value, or its two
                ends; numbers in the file's units or texts. Each scatters by itself: none follows
                another that it is written with.
            quantities: as those of `sensitivities`, but no vectors.
            at: as there.
            samples: how many variants are run beside.
            method: how they are drawn: "latin", "sobol" or "random", with a `seed`.
            distribution: within the bands: "uniform", or "normal" with a third of half the width
                as standard deviation, which nothing cuts off.

        Raises:
            UsageError: unknown names, invalid values, empty bands, a vector.
            ExpressionError: no such quantity, or dimensions that do not fit.
            InvalidFile: the mechanism cannot be solved as it is driven.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/dissertation/rcsr.yaml")
            >>> t = m.tolerances({"P1": "0.002 in", "P2": "0.002 in"}, ["O4.theta"], samples=64)
            >>> {name: round(float(share[-1]), 2) for name, share in t.shares("O4.theta").items()}
            {'P2': 0.8, 'P1': 0.2}
        """
        given = (at, samples, method, seed, distribution)
        return sensitivities.stack(self, tolerances, quantities, *given)

    def fit(
        self,
        targets: Mapping[str, Any] | Sequence[Mapping[str, Any]],
        parameters: Mapping[str, tuple[Any, Any]],
        *,
        constraints: Mapping[str, Any] | Sequence[Mapping[str, Any]] = (),
        starts: int = 4,
        generations: int = 40,
        seed: int = 0,
        progress: Callable[[int, int], None] | None = None,
    ) -> Fit:
        """The parameters whose mechanism comes nearest to what is wanted.

        The file's sweep is the range over which the mechanism has to assemble, in its mode.

        Args:
            targets: a quantity or expression (`of`; `run`: of a response) and what it should be
                (`is`, values or points)
                at inputs (`at`; a curve without it passes its points wherever it comes nearest), or
                what of it should be `least`, "peak" or "rms" over the sweep's rows; `within` is the
                deviation that counts as one, 1 of the file's unit where nothing is said.
            parameters: the least and the largest value by name, as in `with_parameters`.
            constraints: an expression (`of`) and its `min` or `max` in every row of the sweep, or
                of the response that `run` names.
            starts: local searches, the first from the model's own values, the others from the best
                of a population; 1: no population.
            generations: of differential evolution before that.
            seed: of the population; the same one gives the same answer.
            progress: told how many steps are done, and of how many.

        Returns:
            Parameters, deviations, constraints, and a model; `status` says whether all holds.

        Raises:
            UsageError: scipy is not installed (extra `fit`), an unknown name, an invalid value.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/plane/planar_four_bar.yaml")
            >>> wanted = m.with_parameters({"a": 35, "c": 95}).analyze()["C.theta"][[4, 8, 16]]
            >>> target = {"of": "C.theta", "at": [60, 120, 240], "is": wanted.tolist()}
            >>> f = m.fit(target, {"a": (30, 50), "c": (80, 100)}, starts=1)
            >>> f.status, {name: round(value, 6) for name, value in f.parameters.items()}
            ('fitted', {'a': 35.0, 'c': 95.0})
        """
        return fit.fit_of(
            self, targets, parameters, constraints, starts, generations, seed, progress
        )


DATA = "data"
"""What messages call the dict that a caller gives."""


_NO_PARAMETERS: Mapping[str, Setting] = MappingProxyType({})


def load(
    path: str | Path | Mapping[str, Any],
    parameters: Mapping[str, Setting] = _NO_PARAMETERS,
    *,
    folder: str | Path | None = None,
) -> Model:
    """Reads and checks a mechanism: a file, or the same sections as a dict. Text is for `loads`.

    Args:
        path: of the YAML file; or a dict of texts, numbers (of numpy, too), lists and dicts, whose
            messages name the way of keys to a value, `data at joints.A.point[2]`.
        parameters: what replaces values of its `parameters:`, such as {"P1": "0.6 in"}; a number
            is in the file's unit.
        folder: where the files are that a dict names; None: it may name none.

    Raises:
        UsageError: the file cannot be read, or an unknown parameter.
        InvalidFile: with every independent error and its place.

    Example:
        >>> load("mechanisms/dissertation/rcsr.yaml").name
        'RCSR'
        >>> pin = {"type": "R", "links": ["ground", "arm"], "point": [0, 0, 0], "axis": [0, 0, 1]}
        >>> sweep = {"O.theta": {"from": 0, "to": 90, "step": 45}}
        >>> arm = {"format": 1, "links": {"arm": {}}, "joints": {"O": pin}}
        >>> load(arm | {"motion": {"inputs": sweep}}).analyze()["O.theta"].tolist()
        [0.0, 45.0, 90.0]
    """
    place = None if folder is None else a_path("folder", folder)
    if isinstance(path, Mapping):
        return Model(Design(read_and_build(open_data, path, DATA, _texts(parameters), place), DATA))
    if isinstance(path, str) and "\n" in path:
        raise UsageError("path: this is a text of several lines, no path; use loads(text)")
    path = a_path("path", path)
    return Model(Design(read_and_build(open_file, path, _texts(parameters)), path.stem))


def loads(
    text: str,
    name: str = "text",
    parameters: Mapping[str, Setting] = _NO_PARAMETERS,
    *,
    folder: str | Path | None = None,
) -> Model:
    """As `load`, for the text of a mechanism file.

    Args:
        text: YAML.
        name: stands for the file in messages.
        parameters: as in `load`.
        folder: where the files are that the text names; None: it may name none.

    Raises:
        UsageError: an unknown parameter, or the text is the name of a file.
        InvalidFile: with every independent error, its line and its column.
    """
    a_text("text", text, '"format: 1 ..."'), a_text("name", name, '"rcsr.yaml"')
    if text.strip().casefold().endswith((".yaml", ".yml")) and "\n" not in text.strip():
        shown = text.strip()[:LONGEST_NAME]
        raise UsageError(f"text: this looks like the name of a file; use load({shown!r})")
    place = None if folder is None else a_path("folder", folder)
    built = read_and_build(open_text, text, name, _texts(parameters), place)
    return Model(Design(built, Path(name).stem))


def _texts(parameters: Mapping[str, Setting]) -> dict[str, str]:
    """Parameters as texts; a number is in the unit that the file has for the parameter."""
    given = settings("parameters", parameters, '{"P1": "0.6 in"}')
    return {k: v if isinstance(v, str) else repr(v) for k, v in given.items()}
