"""`tables:` and `coefficients:` - layouts whose columns have known names and one number per row;
and `balances:` - sums over a cycle of the sweep: works, harmonics and flywheels.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import mechanism
from mechkin_cli.building.fields import AlreadyRefused, Fields, Path
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.expressions import ExpressionError, Quantity, UnknownName, Vector
from mechkin_cli.mechanism import (
    AnyBalance,
    Cycle,
    Flywheel,
    Harmonics,
    LoadWork,
    LongRun,
    Problem,
    Wanted,
    in_pieces,
    is_of_motion,
    with_ends,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import MechanismFile, tables as written
from mechkin_cli.session import round_of
from mechkin_cli.tables import (
    CoefficientsLayout,
    ColumnLayout,
    PrintedSource,
    Remark,
    TableLayout,
    default_table,
    resting_table,
    row_texts,
)
from mechkin_cli.tolerances import EQUAL_STEPS
from mechkin_cli.units import ANGULAR_RATE, DIMENSIONLESS, Dimension
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields, Path
    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import DrivenInput, MotionInputs, Problem, Wanted
    from mechkin_cli.schema import Coefficients
    from mechkin_cli.show import Floats


def runs_of(file: MechanismFile) -> tuple[str, ...]:
    """The runs of a file by name, the sweep first, then responses and equilibria; a file of these
    alone has no sweep."""
    swept = file.motion is not None or not file.free_runs
    return (*((SWEEP,) if swept else ()), *file.free_runs)


def unknown_run(fields: Fields, path: Path, name: str, known: Collection[str]) -> None:
    """Notes that the name at `path` is not a run."""
    if name == SWEEP:
        text, hint = (
            "there is no sweep: the file has no motion:",
            "name another run, or add motion:",
        )
    else:
        text = f"there is no run {name}"
        hint = nearest_hint(name, list(known)) or f"runs are {', '.join(known)}"
    fields.error("unknown-run", path, text, hint)


def build_tables(fields: Fields, file: MechanismFile, problem: Problem) -> tuple[TableLayout, ...]:
    """The tables' layouts, and one for each run that has none; errors are noted in `fields`."""
    runs = runs_of(file)
    known = {run: problem_of(problem, run) for run in runs}
    tables = []
    for i, section in enumerate(file.tables):
        run = _run_of(fields, ("tables", i), section, runs)
        if run is not None:
            sample = ColumnSample(fields, known[run], run)
            tables.append(_table(fields, ("tables", i), section, run, sample))
    read = {table.run for table in tables}
    named = {section.run for section in file.tables}
    for run in runs:
        if run not in read and run not in named:
            tables.append(_default(problem, run))
            _refuse_taken(fields, file, run)
    return tuple(tables)


def problem_of(problem: Problem, run: str) -> Problem:
    """The problem of a run, whose quantities its rows have."""
    if run == SWEEP:
        return problem
    return mechanism.response_problem(problem, problem.responses[run])


def _run_of(fields: Fields, path: Path, section: written.Table, runs: Sequence[str]) -> str | None:
    """The run that a table reads; None where an error was noted."""
    if section.run is None and runs[0] != SWEEP and len(runs) > 1:
        text = f"{section.name} does not say which run it reads"
        fields.error("unknown-run", path, text, f"add run: one of {', '.join(runs)}")
        return None
    run = section.run or runs[0]
    if run in runs:
        return run
    unknown_run(fields, (*path, "run"), run, runs)
    return None


def _table(
    fields: Fields, path: Path, section: written.Table, run: str, sample: ColumnSample
) -> TableLayout:
    columns: list[ColumnLayout] = []
    parts: dict[str, tuple[str, ...]] = {}
    for k, column in enumerate(section.columns):
        place: Path = (*path, "columns", k)
        if fields.document.node((*place, "value")) is not None:
            place = (*place, "value")
        layouts = _columns(fields, place, column, sample)
        parts[column.label] = tuple(layout.label for layout in layouts)
        columns += layouts
    _refuse_same_labels(fields, path, parts)
    title = section.title or section.name
    published = _published(section.published, parts)
    x, y = (None, ()) if section.plot is None else (section.plot.x, section.plot.y)
    y = tuple(part for label in y for part in parts[label])
    read_by = None if section.published is None else section.published.rows_by
    for label, place in ((x, ("plot", "x")), (read_by, ("published", "rows_by"))):
        if label is not None and len(parts.get(label, ())) > 1:
            text = f"the column {label} is a vector"
            hint = f"make one of its components a column: {', '.join(parts[label])}"
            fields.error("vector-label", (*path, *place), text, hint)
    return TableLayout(section.name, title, tuple(columns), published, run, section.summary, x, y)


def _default(problem: Problem, run: str) -> TableLayout:
    if run == SWEEP:
        timed = problem.motion.time is not None
        efforts = [".".join(pair) for pair in problem.acting]
    else:
        response = problem.responses[run]
        efforts = [f"{joint}.{name}" for joint, name in response.efforts_of]
        if response.search is not None:
            return resting_table(
                problem.mechanism.coordinates, efforts, list(response.resting), run
            )
        timed = True
    return default_table(problem.mechanism.coordinates, efforts, run=run, timed=timed)


def _refuse_taken(fields: Fields, file: MechanismFile, run: str) -> None:
    """A run without tables writes one of its own name."""
    for i, section in enumerate(file.tables):
        if section.name.casefold() == run.casefold():
            text = f"the run {run} has no table and writes one called {run} itself"
            hint = f"rename this one, or give the other: run: {run}"
            fields.error("table-clash", ("tables", i, "name"), text, hint)


def _refuse_same_labels(fields: Fields, path: Path, parts: Mapping[str, Sequence[str]]) -> None:
    """The components of a vector have labels of their own, which no other column may have."""
    taken: dict[str, int] = {}
    for k, labels in enumerate(parts.values()):
        for label in labels:
            if label in taken:
                text = f"the label {label!r} is used twice, once by a component of a vector"
                hint = "leave out the component, or give one of them another label"
                fields.error("label-clash", (*path, "columns", k), text, hint)
            taken[label] = k


def _published(
    section: written.PublishedValues | None, parts: Mapping[str, Sequence[str]]
) -> PrintedSource | None:
    """The printed values; `parts` are the labels of the columns that each label stands for."""
    if section is None:
        return None

    def labels(remark: written.PrintedRemark) -> tuple[str, ...]:
        return tuple(part for label in remark.columns or () for part in parts.get(label, (label,)))

    remarks = tuple(Remark(r.text, labels(r), r.data or ()) for r in section.remarks)
    return PrintedSource(section.file, remarks, section.rows_by)


def _columns(
    fields: Fields, path: Path, column: written.Column, sample: ColumnSample
) -> list[ColumnLayout]:
    """The column, of a vector those of its components; none where an error was noted."""
    try:
        expression = fields.definitions.parse(column.value)
        if column.value.strip() not in sample.texts:
            quantity = expression.evaluate(sample, fields.units)
            if isinstance(quantity.value, Vector):
                texts = quantity.value.component_texts(column.value)
                labels = quantity.value.component_texts(column.label)
                if column.label.strip() != column.value.strip():
                    # a label is words, no expression
                    labels = tuple(f"{column.label}.{text[-1]}" for text in texts)
                return [
                    ColumnLayout(label, fields.definitions.parse(text), column.decimals)
                    for label, text in zip(labels, texts, strict=True)
                ]
    except ExpressionError as error:
        fields.expression_error(path, error)
        return []
    return [ColumnLayout(column.label, expression, column.decimals)]


class ColumnSample:
    """Resolves names to one-row stand-ins of the right dimension."""

    def __init__(self, fields: Fields, problem: Problem, run: str) -> None:
        self.run, self.problem = run, problem
        self.texts = row_texts(run)
        self.fields, self.parameters = fields, fields.parameters
        self.quantities = problem.quantities()

    def __call__(self, name: str) -> Quantity:
        """The stand-in of a name.

        Raises:
            ExpressionError: nothing has this name, or it is the name of a text.
        """
        if name in self.parameters:
            return self.parameters[name]
        if name in self.texts:
            message = f"{name} is a text, not a number"
            raise ExpressionError(message, 0, "make it a column of its own")
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        wanted = self.quantities.get(name)
        if wanted is None and self.run in self.fields.failed and is_of_motion(name):
            raise AlreadyRefused(name)
        if wanted is None:
            named = self.fields.definitions.named
            known = chain(self.parameters, named, self.quantities, self.texts)
            raise UnknownName(name, known, partial(self.problem.why_not, name))
        return Quantity(wanted.value([np.ones(1)] * 3), wanted.dimension)


def used_quantities(tables: Sequence[TableLayout], quantities: Mapping[str, Wanted]) -> list[str]:
    """Names of the quantities that some tables read."""
    used: dict[str, None] = {}
    for table in tables:
        for column in table.columns:
            for name in sorted(column.expression.names):
                # of components the vector; what comes first is not asked for the other
                candidates = (name, name.rpartition(".")[0])
                known = next((each for each in candidates if each in quantities), None)
                if known is not None:
                    used[known] = None
    return list(used)


def build_coefficients(
    fields: Fields, file: MechanismFile, problem: Problem, tables: Sequence[TableLayout]
) -> tuple[CoefficientsLayout, ...]:
    """The layouts of `coefficients:`; errors are noted in `fields`."""
    layouts: list[CoefficientsLayout] = []
    for number, section in enumerate(file.coefficients):
        path: Path = ("coefficients", number)
        if section.row > problem.motion.rows and SWEEP not in fields.failed:
            text = f"the sweep has {problem.motion.rows} rows"
            fields.error("unknown-row", (*path, "row"), text, f"write 1 to {problem.motion.rows}")
        along = _along(fields, (*path, "along"), section, problem)
        title = section.title or section.name
        links = [name for name in problem.mechanism.links if name != mechanism.GROUND_NAME]
        known = [*links, *problem.mechanism.joints]
        equations = _ordered(fields, (*path, "equations"), section.equations, known)
        unknowns = _ordered(fields, (*path, "unknowns"), section.unknowns, unknown_names(problem))
        order = (equations, unknowns)
        layout = CoefficientsLayout(
            section.name, title, section.row, along, section.counted, *order
        )
        taken = {table.name.casefold() for table in tables}
        taken |= {name.casefold() for other in layouts for name in other.names}
        for name in layout.names:
            if name.casefold() in taken:
                text = f"another table is written to {name}"
                fields.error("table-clash", (*path, "name"), text, "rename one of them")
        layouts.append(layout)
    if layouts and SWEEP not in runs_of(file):
        text = "coefficients: belong to a row of the sweep, and the file has responses alone"
        fields.error("no-sweep", ("coefficients",), text, "add motion:, or leave them out")
    if layouts and problem.mechanism.frictions:
        text = "there are no coefficients: where joints rub, since friction is not linear"
        fields.error("rubbing", ("coefficients",), text, "leave out coefficients: or the friction")
    if layouts and problem.hold_idle:
        text = "there are no coefficients: where idle freedoms are held against loads"
        fields.error("held-idle", ("coefficients",), text, "leave out coefficients: or idle: hold")
    return tuple(layouts)


def _ordered(
    fields: Fields, path: Path, written: Sequence[str], known: Sequence[str]
) -> tuple[str, ...]:
    """The names, of which each must be known and stand once."""
    names = [text.removeprefix("-") for text in written]
    for place, name in enumerate(names):
        if name not in known:
            hint = nearest_hint(name, known) or f"names are {', '.join(known)}"
            fields.error("unknown-name", (*path, place), f"there is no {name} here", hint)
        elif name in names[:place]:
            fields.error("named-twice", (*path, place), f"{name} is named twice", "name it once")
    return tuple(written)


def unknown_names(problem: Problem) -> list[str]:
    """Names of the unknowns of the dense system, those of three components once."""
    names = []
    for joint in problem.mechanism.joints.values():
        if joint.type.is_free:
            continue
        words = ["F"] if joint.type.is_oriented else ["F", "M"]
        if joint.type.is_guide:
            free = joint.type.free
            words += ["FA"] if joint.type.is_threaded or not free["slide"] else []
            words += ["MA"] if not (joint.type.is_threaded or free["turn"]) else []
        names += [f"{joint.name}.{word}" for word in words]
    drives = problem.mechanism.drives
    word = "drive" if drives is not None and drives.constraints else "effort"
    names += [f"{j}.{c}.{word}" for j, c in problem.acting]
    related = problem.mechanism.couplings.items()
    return [*names, *(f"{name}.{'force' if r.length else 'torque'}" for name, r in related)]


def _along(
    fields: Fields, path: Path, section: Coefficients, problem: Problem
) -> dict[str, tuple[str, str]]:
    joints, known = problem.mechanism.joints, problem.mechanism.directions
    along: dict[str, tuple[str, str]] = {}
    for name, directions in section.along.items():
        if name not in joints or not joints[name].type.is_ball:
            balls = [joint.name for joint in joints.values() if joint.type.is_ball]
            hint = f"balls are {', '.join(balls)}" if balls else "the mechanism has none"
            fields.error("no-ball", (*path, name), f"{name} is not a ball of the mechanism", hint)
            continue
        unknown = [direction for direction in directions if direction not in known]
        for direction in unknown:
            hint = nearest_hint(direction, known) or "name it in directions:"
            place = (*path, name, directions.index(direction))
            fields.error("unknown-name", place, f"there is no direction {direction}", hint)
        if not unknown:
            along[name] = (directions[0], directions[1])
    return along


LEAST_ROWS = 4
"""Rows of a cycle."""
TIME = "time"


def build_balances(
    fields: Fields, sections: Sequence[written.AnyBalance], problem: Problem
) -> tuple[AnyBalance, ...]:
    """The balances of a file; errors are noted in `fields`."""
    builder = _BalanceBuilder(fields, problem)
    balances = [builder.balance(("balances", i), section) for i, section in enumerate(sections)]
    return tuple(balance for balance in balances if balance is not None)


class _Extent(NamedTuple):
    """The first and the last of some values in their order, the least and the largest."""

    first: float
    last: float
    least: float
    most: float

    def joined(self, later: _Extent) -> _Extent:
        """With values behind these."""
        least, most = min(self.least, later.least), max(self.most, later.most)
        return _Extent(self.first, later.last, least, most)

    @property
    def size(self) -> float:
        """The largest magnitude."""
        return max(-self.least, self.most)


def _moments_of(motion: MotionInputs) -> Floats:
    """The moments of the rows of a motion in time, in the file's unit."""
    assert motion.time is not None
    return motion.time.written


def _written(number: int, name: str, motion: MotionInputs) -> Floats:
    """An input's value or one of its rates, by name, in the file's units."""
    return motion.inputs[number].orders[name][1]


class _BalanceBuilder:
    def __init__(self, fields: Fields, problem: Problem) -> None:
        self.fields = fields
        self.problem = problem
        self.known: Mapping[str, Wanted] = problem.quantities()

    def balance(self, path: Path, section: written.AnyBalance) -> AnyBalance | None:
        if isinstance(section, written.FlywheelBalance) and not self._is_held(path):
            return None
        cycle = self._cycle(path, section)
        place, title = self.fields.document.place(path), section.title or section.name
        if isinstance(section, written.HarmonicsBalance):
            of = self._expressions((*path, "of"), section.of)
            orders = self._orders((*path, "orders"), section.orders, cycle)
            if cycle is None:
                return None
            return Harmonics(section.name, title, place, cycle, of, orders)
        if isinstance(section, written.FlywheelBalance):
            unevenness = self._unevenness((*path, "unevenness"), section.unevenness)
            rate = self._rate(path, section, cycle)
            if cycle is None or rate is None:
                return None
            return Flywheel(section.name, title, place, cycle, unevenness, rate)
        return None if cycle is None else LoadWork(section.name, title, place, cycle)

    def _is_held(self, path: Path) -> bool:
        """Whether numbers of all rows fit in memory, as a flywheel holds them; else that is
        noted."""
        motion = self.problem.motion
        if not isinstance(motion, LongRun) or motion.rows <= motion.most_rows:
            return True
        text = f"a flywheel holds numbers of all rows, and has too many of them: {motion.rows}"
        limit = f"{motion.most_rows} rows"
        self.fields.error("too-many-rows", path, text, "take a larger step", limit=limit)
        return False

    def _cycle(self, path: Path, section: written.AnyBalance) -> Cycle | None:
        motion = self.problem.motion
        at: Path = path if section.cycle is None else (*path, "cycle")
        name = section.cycle or self._default_cycle(section)
        if name == TIME:
            return self._cycle_in_time(at)
        inputs = {item.name: number for number, item in enumerate(motion.inputs)}
        if name is None or name not in inputs:
            text = "nothing moves in the sweep" if name is None else f"{name} is not an input"
            hint = f"inputs are {', '.join(inputs)}" if inputs else "add motion: inputs:"
            self.fields.error("not-driven", at, text, hint)
            return None
        number = inputs[name]
        item = with_ends(motion).inputs[number]
        turn = round_of(self.problem, item)
        if turn is None:
            hint = "name an input that turns, or with time: and laws that come back, cycle: time"
            self.fields.error("no-cycle", at, f"{name} is not an angle that goes round", hint)
            return None
        if not self._are_equal(at, name, lambda piece: piece.inputs[number].written):
            return None
        turns = float(item.written[-1] - item.written[0]) / float(turn)
        count = round(abs(turns))
        if count == 0 or abs(abs(turns) - count) > EQUAL_STEPS * count:
            self._not_closed(at, item, float(turn))
            return None
        step = float(item.values[-1] - item.values[0]) / (motion.rows - 1)
        return Cycle(name, number, count, step, float(item.values[0]))

    def _default_cycle(self, section: written.AnyBalance) -> str | None:
        motion = with_ends(self.problem.motion)
        if motion.time is not None and not isinstance(section, written.FlywheelBalance):
            return TIME
        moving = motion.leading
        return None if moving is None or not np.ptp(moving.values) else moving.name

    def _cycle_in_time(self, at: Path) -> Cycle | None:
        motion = self.problem.motion
        if motion.time is None:
            hint = "name the input that turns, or give the sweep a time:"
            self.fields.error("no-cycle", at, "the sweep has no time", hint)
            return None
        if not self._are_equal(at, TIME, _moments_of):
            return None
        for number, item in enumerate(with_ends(motion).inputs):
            turn = round_of(self.problem, item)
            for k, name in enumerate(list(item.orders)[:3]):
                extent = self._extent(partial(_written, number, name))
                gap = extent.last - extent.first
                if k == 0 and turn is not None:
                    gap -= round(gap / float(turn)) * float(turn)
                if abs(gap) > EQUAL_STEPS * max(extent.size, 1.0):
                    unit = self.problem.units.label(self.known[name].dimension)
                    text = f"{name} is not back at the last row: {gap:.6g} {unit} is missing"
                    hint = "let time: go over a whole period of the laws"
                    self.fields.error("cycle-not-closed", at, text, hint)
                    return None
        time = with_ends(motion).time
        assert time is not None
        step = float(time.values[-1] - time.values[0]) / (motion.rows - 1)
        return Cycle(TIME, None, 1, step, float(time.values[0]))

    def _extent(self, read: Callable[[MotionInputs], Floats]) -> _Extent:
        """Of something over the rows."""
        found: _Extent | None = None
        for piece in in_pieces(self.problem.motion):
            values = read(piece)
            here = _Extent(*(float(x) for x in (values[0], values[-1], values.min(), values.max())))
            found = here if found is None else found.joined(here)
        assert found is not None
        return found

    def _are_equal(self, at: Path, name: str, read: Callable[[MotionInputs], Floats]) -> bool:
        gaps = self.problem.motion.rows - 1
        if gaps < LEAST_ROWS:
            text = f"{gaps + 1} row{'s' * (gaps > 0)} are too few for a cycle"
            hint = f"give at least {LEAST_ROWS + 1}, the last as the first"
            self.fields.error("too-few-rows", at, text, hint)
            return False
        extent = self._extent(read)
        mean = (extent.last - extent.first) / gaps
        # differences of large values round by those
        slack = EQUAL_STEPS * abs(mean) + 4.0 * np.finfo(float).eps * extent.size
        row, step = 0, None
        for piece in in_pieces(self.problem.motion):
            steps = np.diff(read(piece))
            wrong = np.flatnonzero(~(np.abs(steps - mean) <= slack))
            if wrong.size or mean == 0.0:
                place = int(wrong[0]) if wrong.size else 0
                row, step = row + place, float(steps[place])
                break
            row += steps.size
        if step is None:
            return True
        text = f"the rows are not at equal distances of {name}"
        measured = f"{step:.6g} from row {row + 1} to row {row + 2}, {mean:.6g} on average"
        hint = "sweep it with from, to and step, or count"
        self.fields.error("unequal-rows", at, text, hint, measured=measured)
        return False

    def _not_closed(self, at: Path, item: DrivenInput, turn: float) -> None:
        first, last = float(item.written[0]), float(item.written[-1])
        unit = self.problem.units.label(self.known[item.name].dimension)
        whole = np.ceil(abs(last - first) / turn) * turn
        end = first + float(np.copysign(whole, last - first))
        missing = abs(end - last)
        text = f"{item.name} goes from {first:.12g} to {last:.12g} {unit}: {missing:.6g} {unit} "
        text += "are missing to a full turn"
        step = abs(last - first) / (self.problem.motion.rows - 1)
        is_next = abs(missing - step) < EQUAL_STEPS * step
        repeat = "the last row repeats the first: " if is_next else ""
        self.fields.error("cycle-not-closed", at, text, f"{repeat}write to: {end:.12g}")

    def _expressions(self, path: Path, texts: Sequence[str]) -> tuple[tuple[str, Expression], ...]:
        named: list[tuple[str, Expression]] = []
        dimension: Dimension | None = None
        parse = self.fields.definitions.parse
        for i, text in enumerate(texts):
            try:
                expression = parse(text)
                quantity = expression.evaluate(ColumnSample(self.fields, self.problem, SWEEP))
                if dimension is not None and not quantity.dimension.compatible(dimension):
                    phrases = f"this is {quantity.dimension.phrase}, the first {dimension.phrase}"
                    message = f"one table holds one dimension; {phrases}"
                    raise ExpressionError(message, 0, "make it a balance of its own")
                dimension = dimension or quantity.dimension
                if isinstance(quantity.value, Vector):
                    named += [(one, parse(one)) for one in quantity.value.component_texts(text)]
                else:
                    named.append((text.strip(), expression))
            except ExpressionError as error:
                self.fields.expression_error((*path, i), error)
        return tuple(named)

    def _orders(self, path: Path, texts: Sequence[str], cycle: Cycle | None) -> tuple[float, ...]:
        orders = []
        for i, text in enumerate(texts):
            order = self.fields.number((*path, i), text, DIMENSIONLESS)
            if cycle is None:
                continue
            whole = order * cycle.turns
            rows = self.problem.motion.rows - 1
            at: Path = (*path, i) if self.fields.document.node((*path, i)) else path[:-1]
            if order < 0.0 or abs(whole - round(whole)) > EQUAL_STEPS * max(whole, 1.0):
                steps = "1" if cycle.turns == 1 else f"1/{cycle.turns}"
                text = f"{order:g} is not an order of a cycle of {cycle.turns} turns"
                self.fields.error("no-order", at, text, f"orders are multiples of {steps}")
            elif 2 * round(whole) >= rows:
                most = (rows - 1) // 2 / cycle.turns
                text = f"order {order:g} cannot be computed from {rows} rows a cycle"
                hint = f"give more rows; these suffice for orders up to {most:g}"
                self.fields.error("no-order", at, text, hint)
            else:
                orders.append(order)
        return tuple(orders)

    def _unevenness(self, path: Path, text: str) -> float:
        value = self.fields.number(path, text, DIMENSIONLESS)
        if not 0.0 < value < 2.0:
            text = f"an unevenness of {value:g} is not possible"
            hint = "(largest - least rate) / their mean lies between 0 and 2, such as 0.01"
            self.fields.error("bad-unevenness", path, text, hint)
            return 1.0
        return value

    def _rate(
        self, path: Path, section: written.FlywheelBalance, cycle: Cycle | None
    ) -> float | None:
        if cycle is not None and cycle.number is None:
            text = "a flywheel sits on an input that turns"
            self.fields.error("no-cycle", (*path, "cycle"), text, "name that input")
            return None
        if section.rate is not None:
            rate = abs(self.fields.number((*path, "rate"), section.rate, ANGULAR_RATE))
            if rate == 0.0:
                text = "the mean rate is zero"
                self.fields.error("no-rate", (*path, "rate"), text, "give the rate at work")
                return None
            return rate
        if cycle is None or cycle.number is None:
            return None
        number = cycle.number
        rates = self._extent(lambda piece: piece.inputs[number].rates)
        if rates.first == 0.0 or rates.most - rates.least > EQUAL_STEPS * abs(rates.first):
            text = f"{cycle.name} has no constant rate in the sweep"
            hint = "give rate: to the balance, or to the input"
            self.fields.error("no-rate", path, text, hint)
            return None
        return abs(rates.first)
