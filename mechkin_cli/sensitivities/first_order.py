"""First-order sensitivities of quantities to parameters, over the rows of a run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis import run_name
from mechkin_cli.arguments import a_setting, a_text, texts
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.errors import NotRepeated, reason_of
from mechkin_cli.expressions import ExpressionError, constant_in_file_units, lookup
from mechkin_cli.mechanism import read_for
from mechkin_cli.sensitivities.slopes import Shifting, Sizes, Slope, slope_of
from mechkin_cli.show import Listed, Listing
from mechkin_cli.tables import row_texts
from mechkin_cli.tolerances import LAST_ROW
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH
from mechkin_cli.variants import sample_of
from mechkin_cli.verdict import SWEEP, Status

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray

    from mechkin_cli.analysis import Analysis, Solvable
    from mechkin_cli.arguments import Setting
    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.units import Dimension


# Where slopes mislead: steep ones that soon bend, as beside a dead centre.


def misleading(s: Sensitivities) -> list[str]:
    """A sentence for each quantity with such a slope, of the one that bends soonest."""
    notes = []
    for quantity in s.quantities:
        part, row, name = min(_soonest(s, quantity, name) for name in s.parameters)
        if part < tolerances.SHORT_REACH:
            far = f"{s.reach(quantity, name)[row]:.2g} {s.unit_of(name)}".rstrip()
            place = f"{s.place[row]:.6g} {s.along_unit}".rstrip()
            notes.append(
                f"{quantity}: slopes mislead near {place}, as beside a dead centre: a tenth is "
                f"wrong for a change of {name} by {far}"
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


# Rows by the places at which they stand.


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
        rows: numbers of the run's rows that are told, from 0 (rows,).
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
        self._dimensions = {
            text: _dimension(analysis.result.problem, expression)
            for text, expression in self._expressions.items()
        }
        known = analysis.result.problem.quantities()
        asked = [n for e in self._expressions.values() for n in used_names(e, known)]
        self._shifting = Shifting(analysis, chosen, asked)
        self._values: dict[str, Floats] = {}
        self._slopes: dict[tuple[str, str], Slope | str] = {}
        for name in self.parameters:
            self._measure(name)

    def __getitem__(self, pair: tuple[str, str]) -> Floats:
        """Sensitivity of a quantity to a parameter, as the class says.

        Raises:
            UsageError: one that was not asked for.
        """
        return self._told(pair, "slope")

    def curvature(self, quantity: str, parameter: str) -> Floats:
        """The second derivative, shaped as the first: in units of the quantity by the parameter's
        squared. Half of it times a change squared is what the slope leaves out."""
        return self._told((quantity, parameter), "curvature")

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
        found = self._found((quantity, parameter))
        words = np.array([Status(code).label for code in self._analysis.result.status[self.rows]])
        words = words.astype(object)
        solved = self._analysis.result.solved[self.rows]
        if isinstance(found, str):
            words[solved] = NOT_REPEATED
            return words.astype(str)
        value = self.value(quantity)
        values = value[:, None] if value.ndim == 1 else value
        slopes = found.slope[:, self.rows]
        words[solved & ~np.isfinite(slopes).all(axis=0)] = NOT_REPEATED
        words[solved & ~np.isfinite(values).all(axis=1)] = EMPTY
        words[solved & self._any(found.bent)] = BENT
        words[solved & found.opened[self.rows]] = NOT_CLOSED
        words[solved & self._any(found.lost)] = NO_POSITION
        return words.astype(str)

    def why(self, quantity: str, parameter: str) -> str:
        """Why there are none at all, as `errors.csv` says it; "" where there are."""
        found = self._found((quantity, parameter))
        return found if isinstance(found, str) else ""

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
        tells (rows,), in the parameter's unit: 0.2 |slope / curvature|; 0 where the slope is zero,
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
        rows = []
        for quantity in self.quantities:
            for name in self.parameters:
                rows.append((quantity, name, *self._largest(quantity, name)))
        head = (
            f"Sensitivities of {self.model.name}: {len(self.quantities)} quantities, "
            f"{len(self.parameters)} parameters, {self.rows.size} rows"
        )
        labels = ("quantity", "parameter", "largest", "unit", f"at {self.along}", "not told")
        return Listing(head, labels, tuple(rows), tuple(misleading(self)))

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
        return self._shifting.scale_of(parameter)

    def _largest_cell(self, text: str) -> float:
        values = self._cells(text)
        return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))

    def _usual(self, text: str) -> float:
        """What is large for a position in this mechanism, in the file's units; 0 for others."""
        dimension, result = self._dimensions[text], self._analysis.result
        one = {LENGTH: result.session.layout.length, ANGLE: 1.0, DIMENSIONLESS: 1.0}.get(
            dimension, 0.0
        )
        return float(result.units.from_si(one, dimension))

    def _cells(self, text: str) -> Floats:
        """A quantity in the chosen rows; kept."""
        if text not in self._values:
            found: Floats = self._analysis[self._expressions[text].text]
            self._values[text] = found[self.rows]
        return self._values[text]

    def _any(self, where: Bools) -> Bools:
        return np.asarray(where[:, self.rows].any(axis=0), dtype=np.bool_)

    def _told(self, pair: tuple[str, str], what: str) -> Floats:
        found = self._found(pair)
        value = self.value(pair[0])
        if isinstance(found, str):
            return np.full(value.shape, np.nan)
        told: Floats = getattr(found, what)[:, self.rows].copy()
        for hidden in (self._any(found.bent), self._any(found.lost), found.opened[self.rows]):
            told[:, hidden] = np.nan
        told = told.T if value.ndim > 1 else told[0]
        return np.where(np.isfinite(value), told, np.nan)

    def _found(self, pair: tuple[str, str]) -> Slope | str:
        self._known(pair)
        return self._slopes[pair]

    def _known(self, pair: Sequence[str]) -> None:
        for name, known in zip(pair, (self.quantities, self.parameters), strict=False):
            a_text("a quantity and a parameter", name, '"O4.theta", "P1"')
            if name not in known:
                raise UsageError(
                    f"{name[:LONGEST_NAME]} was not asked for; there are {', '.join(known)}"
                )

    def _measure(self, name: str) -> None:
        """Slopes of all quantities with one parameter."""
        try:
            sides = self._shifting.sides(name)
        except NotRepeated as reason:
            for text in self.quantities:
                self._slopes[text, name] = str(reason)
            return
        known = self._analysis.result.problem.quantities()
        wanted = [known[n] for n in read_for(self._shifting.asked, known)]
        problem = self._analysis.result.problem
        for rows in sides.rows:
            with suppress(NotRepeated):  # what cannot be repeated says so for its own quantity
                rows.read(one for one in wanted if not reason_of(problem, one))
        for text, expression in self._expressions.items():
            turned = self._dimensions[text] == ANGLE
            try:
                sizes = Sizes(self._largest_cell(text), self._usual(text))
                found = slope_of(expression, name, sides, self._shifting, turned, sizes)
            except NotRepeated as reason:
                self._slopes[text, name] = str(reason)
            else:
                self._slopes[text, name] = found


def used_names(expression: Expression, known: Any) -> list[str]:
    """The quantities that an expression reads, without components."""
    names = [n if n in known else n.rpartition(".")[0] for n in expression.names]
    return [name for name in dict.fromkeys(names) if name in known]


def expression_of(analysis: Analysis, text: str) -> Expression:
    """What a column's label or an expression stands for.

    Raises:
        UsageError: it is words.
        ExpressionError: neither a label nor an expression of quantities.
    """
    if text.strip() in row_texts(analysis.run):
        raise UsageError(f"{text} is words, which have no sensitivity")
    columns = [
        column
        for layout in analysis.model.built.tables_of(analysis.run)
        for column in layout.columns
        if column.label == text
    ]
    for column in columns[:1]:
        return column.expression
    return analysis.result.problem.definitions.parse(text)


def _dimension(problem: Problem, expression: Expression) -> Dimension:
    return expression.evaluate(sample_of(problem), problem.units).dimension


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
            layouts = [c for t in model.built.tables_of(which) for c in t.columns]
            labelled = [c.expression for c in layouts if c.label == text]
            expression = labelled[0] if labelled else problem.definitions.parse(text)
            read += used_names(expression, known)
    if which == SWEEP:
        analysis = model.analyze(read, tables=[], threads=threads)
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
    found = texts("parameters", names, '["P1"]')
    for name in found:
        if name not in known:
            hint = nearest_hint(name, list(known)) or f"parameters are {', '.join(known)}"
            raise UsageError(f"there is no parameter {name[:LONGEST_NAME]}; {hint}")
    return tuple(dict.fromkeys(found))
