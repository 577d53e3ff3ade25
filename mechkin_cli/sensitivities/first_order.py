"""First-order sensitivities of quantities to parameters, over the rows of a run.

In reading order: slopes that soon bend, rows by their places, the result, the call.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis import run_name
from mechkin_cli.arguments import Setting, a_setting, a_text, texts
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.errors import NotRepeated, reason_of
from mechkin_cli.expressions import ExpressionError, constant_in_file_units, lookup
from mechkin_cli.mechanism import read_for
from mechkin_cli.sensitivities.slopes import Shifting, Slope, slope_of
from mechkin_cli.show import Bools, Floats, Listed, Listing
from mechkin_cli.tables import row_texts
from mechkin_cli.tolerances import LAST_ROW
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH
from mechkin_cli.variants import read_by, sample_of
from mechkin_cli.verdict import SWEEP, Status

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray

    from mechkin_cli.analysis import Analysis, Solvable
    from mechkin_cli.arguments import Setting
    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep import Result


def bending_notes(s: Sensitivities) -> list[str]:
    """Notes on steep slopes that soon bend, as beside a dead centre. One for
    each quantity, on the slope that bends soonest."""
    notes = []
    for quantity in s.quantities:
        part, row, name = min(_soonest(s, quantity, name) for name in s.parameters)
        if part < tolerances.SHORT_REACH:
            far = f"{s.reach(quantity, name)[row]:.2g} {s.unit_of(name)}".rstrip()
            place = f"{s.place[row]:.6g} {s.along_unit}".rstrip()
            notes.append(
                f"{quantity}: near {place}, as beside a dead centre, the first-order estimate is "
                f"off by a tenth for a change of {name} by {far}"
            )
    return notes


def _soonest(s: Sensitivities, quantity: str, name: str) -> tuple[float, int, str]:
    """The least reach of a slope that is not small, in parts of the parameter's scale, and its row;
    infinite where no slope is other than zero."""
    slope, reach = s[quantity, name], s.reach(quantity, name)
    sizes = np.linalg.norm(slope, axis=1) if slope.ndim > 1 else np.abs(slope)
    known = np.isfinite(sizes) & (sizes > 0.0)
    if not known.any():
        return np.inf, 0, name
    steep = known & (sizes >= np.median(sizes[known]))
    row = int(np.where(steep, reach, np.inf).argmin())
    return float(reach[row]) / s.scale_of(name), row, name


class Along:
    """What the rows of a run stand along: time, or the first input that moves; the number of the
    row where nothing does."""

    def __init__(self, analysis: Analysis) -> None:
        self._analysis = analysis
        given = analysis.result.inputs
        moving = [name for name, values in given.items() if np.ptp(values) > 0.0]
        self.name = moving[0] if moving else "row"
        count = np.arange(1, analysis.rows + 1, dtype=np.float64)
        self.values: Floats = given[self.name] if moving else count
        self.unit = analysis.unit(self.name) if moving else ""

    def rows(self, at: Setting | Iterable[Setting] | None) -> NDArray[np.intp]:
        """Numbers of the rows at some places, from 0; None: of all.

        Raises:
            UsageError: an invalid value, or one at which there is no row.
        """
        if at is None:
            return np.arange(self.values.size)
        many = isinstance(at, Iterable) and not isinstance(at, (str, Mapping))
        places: list[Any] = list(at) if many else [at]  # type: ignore[arg-type]
        return np.array([self._row(a_setting("at", one)) for one in places], dtype=np.intp)

    def _row(self, at: Setting) -> int:
        wanted = self._value(at)
        off = np.abs(self.values - wanted)
        row = int(off.argmin())
        room = LAST_ROW * float(np.ptp(self.values))
        if off[row] > room:
            near = sorted(set(self.values[np.argsort(off, kind="stable")[:2]].tolist()))
            unit = f" {self.unit}".rstrip()
            raise UsageError(
                f"no row has {self.name} = {wanted:.12g}{unit}; the nearest stand at "
                f"{' and '.join(f'{one:.12g}' for one in near)}{unit}"
            )
        return row

    def _value(self, at: Setting) -> float:
        """A place in the file's units."""
        if self.name == "row":
            return float(at) if not isinstance(at, str) else float("nan")
        problem = self._analysis.model.problem
        known = {**problem.quantities(), **self._analysis.result.problem.quantities()}
        text = at if isinstance(at, str) else repr(at)
        try:
            return constant_in_file_units(
                text, known[self.name].dimension, problem.units, lookup(problem.parameters)
            )
        except ExpressionError as error:
            hint = f"; {error.hint}" if error.hint else ""
            raise UsageError(f"at {text[:LONGEST_NAME]}: {error.message}{hint}") from None


EMPTY = "empty"
NO_POSITION = "no-position"
NOT_CLOSED = "not-closed"
BENT = "bent"
NOT_REPEATED = "not-repeated"
SENTENCES = {
    EMPTY: "the quantity has no value there.",
    NO_POSITION: "the row has no position with another value of the parameter.",
    NOT_CLOSED: "with another value of the parameter the loops, whose constraints are redundant, "
    "do not close.",
    BENT: "a kink, a jump or a dead centre lies next to the parameter's value.",
    NOT_REPEATED: "the quantity is not repeated in double-double; `why` says the reason. Of a "
    "response it is the row of a stop, whose moment no text says.",
}
"""Verdicts beside those of rows, and what they say."""


class Sensitivities(Listed):
    """Sensitivities of quantities to parameters: `s["O4.theta", "P1"]` is d(O4.theta)/d(P1) over
    the rows, in the file's units (`unit`), for a vector (rows, 3); nan where there is none, and
    `verdict` says why.

    Attributes:
        quantities, parameters: their names, in order.
        rows: numbers of the run's rows that were chosen, from 0 (rows,).
        place: where they stand: the input that moves, or time, in the file's units (rows,).
        along: the name of that.
    """

    def __init__(
        self,
        analysis: Analysis,
        quantities: Sequence[str],
        parameters: Sequence[str],
        at: Setting | Iterable[Setting] | None,
    ) -> None:
        self._analysis = analysis
        self.model: Solvable = analysis.model
        self.quantities, self.parameters = tuple(quantities), tuple(parameters)
        along = Along(analysis)
        self.along, self.along_unit = along.name, along.unit
        self.rows = along.rows(at)
        self.place: Floats = along.values[self.rows]
        chosen = np.zeros(analysis.rows, dtype=np.bool_)
        chosen[self.rows] = True
        self._expressions = {text: expression_of(analysis, text) for text in self.quantities}
        problem = analysis.result.problem
        self._dimensions = {
            text: expression.evaluate(sample_of(problem), problem.units).dimension
            for text, expression in self._expressions.items()
        }
        known = problem.quantities()
        asked = read_by(self._expressions.values(), known)
        # the shifted runs are not kept: they hold what no process can hand to another
        shifting = Shifting(analysis, chosen, asked)
        self._scales = {name: shifting.scale_of(name) for name in self.parameters}
        self._values: dict[str, Floats] = {}
        self._slopes: dict[tuple[str, str], Slope | str] = {}
        for name in self.parameters:
            self._measure(name, shifting)

    def __getitem__(self, pair: tuple[str, str]) -> Floats:
        """Sensitivity of a quantity to a parameter, as the class says.

        Raises:
            UsageError: one that was not asked for.
        """
        return self._derivative(pair, "slope")

    def curvature(self, quantity: str, parameter: str) -> Floats:
        """The second derivative, shaped as the first: in units of the quantity by the parameter's
        squared. Half of it times a change squared is what the slope leaves out."""
        return self._derivative((quantity, parameter), "curvature")

    @property
    def results(self) -> Result:
        """The rows of the run."""
        return self._analysis.result

    @property
    def texts(self) -> dict[str, str]:
        """The expression that each quantity stands for."""
        return {text: one.text for text, one in self._expressions.items()}

    def value(self, quantity: str) -> Floats:
        """The quantity itself in these rows, in the file's units."""
        self._known((quantity, *self.parameters[:1]))
        return self._cells(quantity).copy()

    def verdict(self, quantity: str, parameter: str) -> NDArray[Any]:
        """A word for each row (rows,): `ok`, the row's own verdict, or one of `SENTENCES`."""
        slope = self._slope((quantity, parameter))
        words = np.array([Status(code).label for code in self._analysis.result.status[self.rows]])
        words = words.astype(object)
        solved = self._analysis.result.solved[self.rows]
        if isinstance(slope, str):
            words[solved] = NOT_REPEATED
            return words.astype(str)
        value = self.value(quantity)
        values = value[:, None] if value.ndim == 1 else value
        slopes = slope.slope[:, self.rows]
        words[solved & ~np.isfinite(slopes).all(axis=0)] = NOT_REPEATED
        words[solved & ~np.isfinite(values).all(axis=1)] = EMPTY
        words[solved & self._any(slope.bent)] = BENT
        words[solved & slope.opened[self.rows]] = NOT_CLOSED
        words[solved & self._any(slope.lost)] = NO_POSITION
        return words.astype(str)

    def why(self, quantity: str, parameter: str) -> str:
        """Why there are none at all, as `errors.csv` says it; "" where there are."""
        slope = self._slope((quantity, parameter))
        return slope if isinstance(slope, str) else ""

    def unit(self, quantity: str, parameter: str) -> str:
        """The unit of a sensitivity: `deg/in`."""
        self._known((quantity, parameter))
        own, by = self.unit_of(quantity), self.unit_of(parameter)
        by = f"({by})" if set(by) & set("*/ ") else by
        return f"{own or 1}/{by}" if by else own

    def unit_of(self, name: str) -> str:
        """The unit of a quantity or a parameter."""
        units, known = self._analysis.result.units, self.model.problem.parameters
        own = self._dimensions.get(name)
        return units.label(known[name].dimension if own is None else own)

    def matrix(self, quantity: str) -> Floats:
        """All sensitivities of one quantity (rows, parameters), of a vector (3 rows, parameters),
        row after row: the Jacobian matrix of its values."""
        columns = [self[quantity, name].reshape(-1) for name in self.parameters]
        return np.stack(columns, axis=1)

    def reach(self, quantity: str, parameter: str) -> Floats:
        """How far the parameter may change until what the slope leaves out is a tenth of what it
        says (rows,), in the parameter's unit: 0.2 |slope / curvature|; 0 where the slope is zero,
        infinite where nothing bends."""
        slope, curvature = self[quantity, parameter], self.curvature(quantity, parameter)
        if slope.ndim > 1:
            slope, curvature = (np.linalg.norm(part, axis=1) for part in (slope, curvature))
        with np.errstate(divide="ignore", invalid="ignore"):
            far: Floats = 2.0 * tolerances.LINEAR * np.abs(slope / curvature)
        return np.where((curvature == 0.0) & np.isfinite(slope), np.inf, far)

    @property
    def listing(self) -> Listing:
        """The largest sensitivity of each pair, where, and what is missing."""
        pairs = [(quantity, name) for quantity in self.quantities for name in self.parameters]
        rows = tuple((*pair, *self._largest(*pair)) for pair in pairs)
        head = (
            f"Sensitivities of {self.model.name}: {len(self.quantities)} quantities, "
            f"{len(self.parameters)} parameters, {self.rows.size} rows"
        )
        labels = ("quantity", "parameter", "largest", "unit", f"at {self.along}", "missing")
        return Listing(head, labels, rows, tuple(bending_notes(self)))

    def to_pandas(self) -> pandas.DataFrame:
        """A line for each row: the place, then a column for each pair, `d O4.theta / d P1`, of a
        vector three; `attrs["units"]` has their units.

        Raises:
            UsageError: pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas needs pandas: pip install 'mechkin[pandas]'") from None
        columns: dict[str, Any] = {self.along: self.place}
        units = {self.along: self.along_unit}
        for quantity in self.quantities:
            for name in self.parameters:
                values = self[quantity, name]
                parts = [*values.T] if values.ndim > 1 else [values]
                for axis, part in zip("xyz", parts, strict=False):
                    own = f"{quantity}.{axis}" if values.ndim > 1 else quantity
                    columns[f"d {own} / d {name}"] = part
                    units[f"d {own} / d {name}"] = self.unit(quantity, name)
        frame = pandas.DataFrame(columns)
        frame.attrs["units"] = units
        return frame

    def _largest(self, quantity: str, name: str) -> tuple[str, str, str, str]:
        unit, why = self.unit(quantity, name), self.why(quantity, name)
        values = self[quantity, name]
        sizes = np.linalg.norm(values, axis=1) if values.ndim > 1 else np.abs(values)
        words, counts = np.unique(self.verdict(quantity, name), return_counts=True)
        missing = ", ".join(
            f"{n} {word}" for word, n in zip(words, counts, strict=True) if word != "ok"
        )
        if not np.isfinite(sizes).any():
            return "", unit, "", why or missing
        row = int(np.nanargmax(sizes))
        value = values[row] if values.ndim == 1 else sizes[row]
        return f"{value:.6g}", unit, f"{self.place[row]:.6g} {self.along_unit}".rstrip(), missing

    def scale_of(self, parameter: str) -> float:
        """What is large for a parameter, in the file's units: the size of the mechanism for a
        length, a radian, else its own value."""
        return self._scales[parameter]

    def _sizes(self, text: str) -> tuple[float, float]:
        """The largest cell of a quantity, and what is large for a position in this mechanism, in
        the file's units; 0 for others."""
        values, dimension, result = self._cells(text), self._dimensions[text], self._analysis.result
        positions = {LENGTH: result.session.layout.length, ANGLE: 1.0, DIMENSIONLESS: 1.0}
        large = result.units.from_si(positions.get(dimension, 0.0), dimension)
        return float(np.abs(values[np.isfinite(values)]).max(initial=0.0)), float(large)

    def _cells(self, text: str) -> Floats:
        """A quantity in the chosen rows."""
        if text not in self._values:
            self._values[text] = self._analysis[self._expressions[text].text][self.rows]
        return self._values[text]

    def _any(self, where: Bools) -> Bools:
        return np.asarray(where[:, self.rows].any(axis=0), dtype=np.bool_)

    def _derivative(self, pair: tuple[str, str], what: str) -> Floats:
        slope = self._slope(pair)
        value = self.value(pair[0])
        if isinstance(slope, str):
            return np.full(value.shape, np.nan)
        values: Floats = getattr(slope, what)[:, self.rows].copy()
        for hidden in (self._any(slope.bent), self._any(slope.lost), slope.opened[self.rows]):
            values[:, hidden] = np.nan
        values = values.T if value.ndim > 1 else values[0]
        return np.where(np.isfinite(value), values, np.nan)

    def _slope(self, pair: tuple[str, str]) -> Slope | str:
        self._known(pair)
        return self._slopes[pair]

    def _known(self, pair: Sequence[str]) -> None:
        for name, known in zip(pair, (self.quantities, self.parameters), strict=False):
            a_text("a quantity and a parameter", name, '"O4.theta", "P1"')
            if name not in known:
                raise UsageError(
                    f"{name[:LONGEST_NAME]} was not asked for; there are {', '.join(known)}"
                )

    def _measure(self, name: str, shifting: Shifting) -> None:
        try:
            sides = shifting.sides(name)
        except NotRepeated as reason:
            for text in self.quantities:
                self._slopes[text, name] = str(reason)
            return
        known = self._analysis.result.problem.quantities()
        wanted = [known[n] for n in read_for(shifting.asked, known)]
        problem = self._analysis.result.problem
        for rows in sides.rows:
            with suppress(NotRepeated):  # what cannot be repeated says so for its own quantity
                rows.read(one for one in wanted if not reason_of(problem, one))
        for text, expression in self._expressions.items():
            turned = self._dimensions[text] == ANGLE
            try:
                self._slopes[text, name] = slope_of(
                    expression, name, sides, shifting, turned, self._sizes(text)
                )
            except NotRepeated as reason:
                self._slopes[text, name] = str(reason)


def expression_of(analysis: Analysis, text: str) -> Expression:
    """What a column's label or an expression stands for.

    Raises:
        UsageError: it is words.
        ExpressionError: neither a label nor an expression of quantities.
    """
    if text.strip() in row_texts(analysis.run):
        raise UsageError(f"{text} is words, which have no sensitivity")
    return _parsed(analysis.model, analysis.result.problem, analysis.run, text)


def _parsed(model: Solvable, problem: Problem, run: str, text: str) -> Expression:
    columns = (column for layout in model.built.tables_of(run) for column in layout.columns)
    column = next((column for column in columns if column.label == text), None)
    return problem.definitions.parse(text) if column is None else column.expression


def sensitivities(
    model: Solvable,
    quantities: Iterable[str],
    parameters: Iterable[str] | None = None,
    at: Setting | Iterable[Setting] | None = None,
    run: str | None = None,
    threads: int = 0,
) -> Sensitivities:
    """`Model.sensitivities`; arguments and errors are its."""
    names = texts("quantities", quantities, '["O4.theta"]')
    chosen = chosen_parameters(model, parameters)
    which = run_name(model.runs, run)
    problem = model.problem
    known = problem.quantities()
    read: list[str] = []
    for text in names:
        if which == SWEEP and text.strip() not in row_texts(which):
            read += read_by([_parsed(model, problem, which, text)], known)
    if which == SWEEP:
        analysis = model.analyze(read, tables=[], threads=threads)
    elif problem.responses[which].search is not None:
        analysis = model.run_free(which, tables=[])
    else:
        analysis = model.respond(which, tables=[], threads=threads)
    return Sensitivities(analysis, names, chosen, at)


def chosen_parameters(model: Solvable, names: Iterable[str] | None) -> tuple[str, ...]:
    """Names of parameters; None: all.

    Raises:
        UsageError: an unknown one, or there are none.
    """
    known = model.problem.parameters
    if not known:
        raise UsageError(f"{model.name} has no parameters; write parameters: into the file")
    if names is None:
        return tuple(known)
    chosen = texts("parameters", names, '["P1"]')
    for name in chosen:
        if name not in known:
            hint = nearest_hint(name, list(known)) or f"parameters are {', '.join(known)}"
            raise UsageError(f"there is no parameter {name[:LONGEST_NAME]}; {hint}")
    return tuple(dict.fromkeys(chosen))
