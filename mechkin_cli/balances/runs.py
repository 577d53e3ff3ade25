"""Balances over a closed cycle of rows, as small tables in the file's units.

Flywheel: the one that keeps a machine's rate within bounds, under a drive of constant effort. With
the work W(x) of drive and loads from the first row on and the reduced inertia J(x), the energy
T0 + W = (J + J_F) omega^2 / 2 has to keep omega between the bounds everywhere:

    T0 - w_min^2/2 J_F  >=  A = max(w_min^2/2 J - W)
    T0 - w_max^2/2 J_F  <=  B = min(w_max^2/2 J - W)

The least flywheel meets both: J_F = (A - B) / (unevenness mean^2). These are the tangents to
Wittenbauer's diagram of energy over inertia (Wittenbauer, Graphische Dynamik, 1923), without the
usual approximation, which takes one rate for both bounds. Loads are those of the rows: a load that
reads rates does not follow the fluctuation.

Harmonics: Fourier coefficients over a cycle of rows at equal distances,

    f = mean + sum over n of (c_n cos(n x) + s_n sin(n x)),     x the input's angle, or 2 pi t / T

Of N rows these are the coefficients of the trigonometric polynomial through them; what orders above
N/2 of the function leave in them (aliasing) falls as its harmonics do.

Work: that of every effort and load over the cycle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.derived import (
    GRAVITY,
    BasisQuantities,
    CycleIntegral,
    RunningTotal,
    effort_powers,
    friction_power,
    largest_between,
    load_powers_along,
    mean,
    power_against,
    running_integral_of_cycle,
    unloaded,
)
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel.functions import atan2, cos, sin
from mechkin_cli.mechanism import AnyBalance, Cycle, Flywheel, Harmonics, Load, LoadWork
from mechkin_cli.session import KernelInputs, input_path
from mechkin_cli.sweep import Result, stands_elsewhere
from mechkin_cli.tables import ColumnLayout, Columns, TableColumn, column_of, words_of
from mechkin_cli.tolerances import REACTION_ROUNDING
from mechkin_cli.units import ANGLE, ANGULAR_RATE, ENERGY, INERTIA, MOMENT, Dimension

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.units import UnitSystem


def rates_along(result: Result, cycle: Cycle) -> KernelInputs:
    """The inputs with their rates per unit of the cycle's name (rad or s): with those of time, or
    with unit rate of the input and those of the inputs that follow it."""
    session = result.session
    if cycle.number is None:
        return session.inputs.without_accelerations()
    along = session.inputs.at_unit_rate(cycle.number)
    motion = session.problem.motion
    if motion.time is not None:
        # equal steps of time and of the input: it turns at one rate
        rates = session.inputs.rates / session.inputs.rates[cycle.number]
        return along._replace(rates=rates)
    path = input_path(session, cycle.number)
    if path is not None:
        rates = path.derivatives(session.inputs.values[cycle.number])[1]
        rates[cycle.number] = 1.0
        along = along._replace(rates=np.ascontiguousarray(rates))
    return along


class _CycleRows:
    """What shows of the rows of a run whether they are a closed cycle."""

    def __init__(self, balance: AnyBalance) -> None:
        self._balance = balance
        self.lost: int | None = None
        self._ends: list[Floats] = []
        self._session: Session | None = None
        self._moves: dict[int, tuple[float, float, bool]] = {}

    def add(self, result: Result, own: slice) -> None:
        """Takes the rows `own`, which are behind those before; none where one had no solution."""
        lost, rows = np.flatnonzero(~result.solved[own]), result.row_states
        begin, end, _ = own.indices(result.rows)
        if lost.size and self.lost is None:
            self.lost = int(lost[0]) + begin + rows.span.first
        if self.lost is not None:
            return
        self._session = result.session
        self._ends = [(self._ends or [rows.states[:, begin]])[0].copy()]
        self._ends.append(rows.states[:, end - 1].copy())
        along = rates_along(result, self._balance.cycle).rates
        for number, item in enumerate(result.problem.motion.inputs):
            values, before = item.values[own], self._moves.get(number)
            low, high, follows = before or (np.inf, -np.inf, False)
            low, high = min(low, float(values.min())), max(high, float(values.max()))
            self._moves[number] = low, high, follows or bool(along[number].any())

    def fault(self) -> Diagnostic | None:
        """Why the rows are no closed cycle; None where they are."""
        balance, cycle = self._balance, self._balance.cycle
        if self.lost is not None:
            text = f"{balance.name}: row {self.lost + 1} of the cycle has no solution"
            hint = "balances need every row; move or turn the sweep so that all have one"
            return _fault("balance-undefined", balance, text, hint)
        session, ends = self._session, np.stack(self._ends, axis=1)
        assert session is not None
        if stands_elsewhere(session, ends) or _turned_in_part(session, ends):
            text = (
                f"{balance.name}: the mechanism is not back at the last row where it was at first"
            )
            again = (cycle.turns + 1) if cycle.number is not None else 2
            more = f"let the rows go over more turns, such as {again}"
            hint = f"{more}; mechkin ranges shows the circuit"
            return _fault("cycle-not-closed", balance, text, hint)
        for number, item in enumerate(session.problem.motion.inputs):
            low, high, follows = self._moves[number]
            if low != high and not follows:
                text = f"{balance.name}: {item.name} moves, too, but does not follow {cycle.name}"
                tie = f"tie it with {{with: an expression of {cycle.name}}}"
                return _fault("no-cycle", balance, text, f"{tie}, or give the sweep a time:")
        return None


def _turned_in_part(session: Session, ends: Floats) -> bool:
    """Whether a turn that couplings count is no whole one from the first to the second of two
    places (states, 2)."""
    gone = [
        float(ends[carrier.state + number, 1] - ends[carrier.state + number, 0]) / (2.0 * np.pi)
        for carrier in session.layout.carriers
        for number, freedom in enumerate(carrier.part.type.freedoms)
        if freedom.counted
    ]
    return any(abs(turns - round(turns)) > tolerances.SAME_MODE for turns in gone)


class _Samples:
    """Whether samples over the rows, which come block by block, are a cycle."""

    def __init__(self) -> None:
        self.lost: int | None = None
        self.size = 0.0
        self._count = 0
        self._first = self._last = np.nan

    def add(self, values: Floats) -> None:
        """Takes the next samples."""
        if not values.size:
            return
        lost = np.flatnonzero(~np.isfinite(values))
        if lost.size and self.lost is None:
            self.lost = int(lost[0]) + self._count
        self.size = float(np.maximum(self.size, np.max(np.abs(values))))
        if not self._count:
            self._first = float(values[0])
        self._last = float(values[-1])
        self._count += values.size

    @property
    def repeat(self) -> bool:
        """Whether the last is the first again, and all are numbers."""
        if self.lost is not None:
            return False
        return abs(self._last - self._first) <= tolerances.REPEATS * self.size

    def fault(self, balance: AnyBalance, what: str) -> Diagnostic:
        """Why they are no cycle."""
        if self.lost is not None:
            text = f"{balance.name}: {what} has no value in row {self.lost + 1}"
            return _fault(
                "balance-undefined", balance, text, "see the notes on that row, and on it"
            )
        text = f"{balance.name}: {what} is not at the last row what it was at the first"
        hint = (
            "what depends on time, or on an angle with its turns, does not repeat; use wrap(angle)"
        )
        measured = f"{self._last:.6g} for {self._first:.6g}"
        return _fault("cycle-not-closed", balance, text, hint, measured)


def _fault(
    code: str, balance: AnyBalance, text: str, hint: str, measured: str | None = None
) -> Diagnostic:
    return Diagnostic(code, "error", text, balance.place, measured=measured, hint=hint)


def sized(
    loads: Floats, inertia: Floats, step: float, unevenness: float, rate: float
) -> tuple[float, ...]:
    """The flywheel of a machine, SI: its inertia, 0 where none is needed; the same with the mean
    rate at both bounds; the constant effort that balances the loads' work; largest less least work
    of drive and loads; least and largest reduced inertia of the mechanism; and the unevenness
    without a flywheel, nan where it would not go round.

    Args:
        loads: of all loads along the angle, over a cycle (rows - 1,), N m.
        inertia: reduced, kg m^2.
        step: from row to row, rad.
        unevenness: wanted.
        rate: mean of largest and least, rad/s.
    """
    drive = -mean(loads)
    work = running_integral_of_cycle(loads + drive, step)[:-1]

    def needed(share: float, about: float) -> float:
        """A - B for an unevenness `share`; with `about` 0 both bounds have the mean rate."""
        low, high = (rate * (1.0 + sign * about / 2.0) for sign in (-1.0, 1.0))
        upper = largest_between(low * low / 2.0 * inertia - work)
        lower = -largest_between(work - high * high / 2.0 * inertia)
        return (upper - lower) / (share * rate * rate)

    return (
        max(needed(unevenness, unevenness), 0.0),
        max(needed(unevenness, 0.0), 0.0),
        drive,
        largest_between(work) + largest_between(-work),
        -largest_between(-inertia),
        largest_between(inertia),
        _root(lambda share: needed(share, share)),
    )


def _root(needed: Callable[[float], float]) -> float:
    """The unevenness at which no flywheel is needed: what is needed falls as it grows."""
    low, high = 0.0, 2.0
    if needed(high) > 0.0:
        return float("nan")
    for _ in range(200):
        middle = (low + high) / 2.0
        if middle in (low, high):
            break
        if needed(middle) > 0.0:
            low = middle
        else:
            high = middle
    return high


class _Coefficients:
    """Cosine and sine coefficient of an order, of samples of a cycle that come block by block.

    Args:
        cycle: that they are of.
        order: multiple of the turn of its input, or of the whole of time.
        count: of all samples, without the last row, which repeats the first.
        each: reads every second one, or every one.
    """

    def __init__(self, cycle: Cycle, order: float, count: int, each: int = 1) -> None:
        self._cycle, self._order, self._each = cycle, order, each
        self._count, self._whole, self._done = count // each, round(order * cycle.turns), 0
        self._cosine, self._sine = RunningTotal(), RunningTotal()

    def add(self, values: Floats) -> None:
        """Takes the next samples."""
        cycle, begin = self._cycle, -(-self._done // self._each)
        own = values[-self._done % self._each :: self._each]
        self._done += values.size
        # n x from row to row is a whole number of N-th parts of a turn
        part = (self._whole * np.arange(begin, begin + own.size)) % self._count
        angle = np.asarray(part * (2.0 * np.pi / self._count), dtype=np.float64)
        if cycle.number is not None:
            angle = (angle if cycle.step > 0.0 else -angle) + self._order * cycle.first
        self._cosine.add(own * cos(angle))
        if self._whole:
            self._sine.add(own * sin(angle))

    def found(self) -> tuple[float, float]:
        """Both, when all samples have been taken."""
        factor = (1.0 if self._whole == 0 else 2.0) / self._count
        sine = 0.0 if self._whole == 0 else factor * self._sine.found()
        return factor * self._cosine.found(), sine


class _Harmonic:
    """An order of samples over the cycle; arguments are those of `_Coefficients`."""

    def __init__(self, cycle: Cycle, order: float, count: int) -> None:
        self._fine = _Coefficients(cycle, order, count)
        self._coarse: _Coefficients | None = None
        if count % 2 == 0 and 4 * round(order * cycle.turns) < count:
            self._coarse = _Coefficients(cycle, order, count, 2)

    def add(self, values: Floats) -> None:
        """Takes the next samples."""
        self._fine.add(values)
        if self._coarse is not None:
            self._coarse.add(values)

    def found(self) -> tuple[float, float, float, float, float]:
        """Both coefficients, amplitude and phase (rad) of amplitude cos(n x - phase), and how far
        the coefficients may be off."""
        cosine, sine = self._fine.found()
        error = float("nan")
        if self._coarse is not None:
            coarse = self._coarse.found()
            error = max(abs(cosine - coarse[0]), abs(sine - coarse[1]))
        amplitude = float(np.sqrt(cosine * cosine + sine * sine))
        phase = float(atan2(np.array([sine]), np.array([cosine]))[0])
        return cosine, sine, amplitude, phase, error


def powers_along(result: Result, cycle: Cycle) -> dict[str, Floats]:
    """The forces' products with the motion along the cycle (J per rad or s, rows), by name: of
    efforts, gravity and loads, and of inertia, by which they are in balance."""
    run = BasisQuantities(result, {}, result.session.inputs)
    along = rates_along(result, cycle)
    powers = effort_powers(run, along)
    for number, (load, power) in enumerate(load_powers_along(run, along)):
        powers[load_name(result, number, load)] = power
    rubbed = friction_power(run, along)
    if rubbed is not None:
        powers["friction"] = rubbed
    masses = unloaded(result.session, at_inputs=True)
    return powers | {"inertia": power_against(run, along, masses)}


def load_name(result: Result, number: int, load: Load | str) -> str:
    """`load 2: damper`, counted as they act; gravity is not among them."""
    if isinstance(load, str):
        return GRAVITY
    first = 1 if any(result.problem.mechanism.gravity) else 0
    words = {"LinkLoad": "on link", "JointLoad": "at joint"}
    kind = type(load).__name__
    what = words.get(kind, kind.lower())
    owner = getattr(load, "link", None) or getattr(load, "joint", None) or load.owner
    return f"load {number - first + 1}: {what}{f' {owner}' if owner else ''}"


Table = tuple[Columns, list["Diagnostic"]]


def balance_table(balance: AnyBalance, result: Result) -> Table:
    """A balance over the rows, and what is wrong with it; its cells are empty then."""
    found = running_balance(balance, result.rows)
    found.add(result, slice(0, result.rows))
    return found.table()


def running_balance(balance: AnyBalance, rows: int) -> RunningBalance:
    """A balance over so many rows, which come part by part."""
    if isinstance(balance, LoadWork):
        return _RunningWork(balance, rows)
    if isinstance(balance, Harmonics):
        return _RunningHarmonics(balance, rows)
    return _RunningFlywheel(balance, rows)


class RunningBalance:
    """A balance over the rows of a run, which come part by part; the digits are those of all rows
    at once.

    Args:
        balance: of the file.
        rows: of the run.
    """

    def __init__(self, balance: AnyBalance, rows: int) -> None:
        self._run_rows = rows
        self._units: UnitSystem | None = None
        self._cycle = _CycleRows(balance)
        self._done = 0

    def add(self, result: Result, own: slice) -> None:
        """Takes the rows `own` of a part, which are behind those before."""
        self._units = result.units
        self._cycle.add(result, own)
        self._add(result, own)
        begin, end, _ = own.indices(result.rows)
        self._done += end - begin

    def _add(self, result: Result, own: slice) -> None:
        raise NotImplementedError

    def table(self) -> Table:
        """The balance when all rows have been taken, and what is wrong with it; its cells are empty
        then."""
        raise NotImplementedError

    def _of_cycle(self, values: Floats) -> Floats:
        """The values of the rows that come next without the last of the run, which repeats the
        first."""
        return values[: max(self._run_rows - 1 - self._done, 0)]

    def _numbers(
        self, label: str, dimension: Dimension, values: Sequence[float] | np.ndarray
    ) -> TableColumn:
        assert self._units is not None
        in_file = self._units.from_si(np.array(values, dtype=np.float64), dimension)
        return TableColumn(label, self._units.label(dimension), np.asarray(in_file))


class _RunningWork(RunningBalance):
    """Works of efforts, gravity, loads and inertia, and their sum, which is what is missing."""

    def __init__(self, balance: LoadWork, rows: int) -> None:
        super().__init__(balance, rows)
        self._balance = balance
        self._works: dict[str, tuple[_Samples, CycleIntegral]] = {}

    def _add(self, result: Result, own: slice) -> None:
        if self._cycle.lost is not None:
            return
        parts = {name: p[own] for name, p in powers_along(result, self._balance.cycle).items()}
        total = np.zeros(result.rows)[own]
        for values in parts.values():
            total = total + values
        for name, values in (*parts.items(), ("sum", total)):
            if name not in self._works:
                integral = CycleIntegral(self._run_rows - 1, self._balance.cycle.step)
                self._works[name] = _Samples(), integral
            samples, integral = self._works[name]
            samples.add(values)
            integral.add(self._of_cycle(values))

    def table(self) -> Table:
        fault, balance = self._cycle.fault(), self._balance
        works, faults = [("sum", np.nan, np.nan)], [] if fault is None else [fault]
        if fault is None:
            works = []
            for name, (samples, integral) in self._works.items():
                if name == "sum" or samples.repeat:
                    works.append((name, *integral.found()))
                else:
                    faults.append(samples.fault(balance, name))
                    works.append((name, np.nan, np.nan))
        names, work, error = zip(*works, strict=True)
        columns = [
            TableColumn("of", "", words_of(names)),
            self._numbers("work", ENERGY, work),
            self._numbers("error", ENERGY, error),
        ]
        return _table(balance, columns, faults)


class _RunningHarmonics(RunningBalance):
    """Fourier coefficients."""

    def __init__(self, balance: Harmonics, rows: int) -> None:
        super().__init__(balance, rows)
        self._balance = balance
        self._samples = [_Samples() for _ in balance.of]
        self._orders = [
            [_Harmonic(balance.cycle, order, rows - 1) for order in balance.orders]
            for _ in balance.of
        ]
        self._unit = ""

    def _add(self, result: Result, own: slice) -> None:
        if self._cycle.lost is not None and self._unit:
            return
        every = zip(self._balance.of, self._samples, self._orders, strict=True)
        for (label, expression), samples, orders in every:
            column = column_of(ColumnLayout(label, expression), result)
            self._unit, values = column.unit, np.asarray(column.values, dtype=np.float64)[own]
            samples.add(values)
            for order in orders if samples.lost is None else ():
                order.add(self._of_cycle(values))

    def table(self) -> Table:
        fault, balance = self._cycle.fault(), self._balance
        names, numbers, cells = [], [], []
        faults = [] if fault is None else [fault]
        for (label, _), samples, orders in zip(
            balance.of, self._samples, self._orders, strict=True
        ):
            if fault is None and not samples.repeat:
                faults.append(samples.fault(balance, label))
            good = fault is None and samples.repeat
            for number, order in zip(balance.orders, orders, strict=True):
                names.append(label)
                numbers.append(number)
                cells.append(order.found() if good else (np.nan,) * 5)
                if cells[-1][2] <= REACTION_ROUNDING * samples.size:
                    # an amplitude that is rounding has no phase
                    cells[-1] = (*cells[-1][:3], np.nan, cells[-1][4])
        cosine, sine, amplitude, phase, error = np.array(cells).reshape(-1, 5).T.copy()
        columns = [
            TableColumn("of", "", words_of(names)),
            TableColumn("order", "", np.array(numbers)),
            TableColumn("cosine", self._unit, cosine),
            TableColumn("sine", self._unit, sine),
            TableColumn("amplitude", self._unit, amplitude),
            self._numbers("phase", ANGLE, phase),
            TableColumn("error", self._unit, error),
        ]
        return _table(balance, columns, faults)


class _RunningFlywheel(RunningBalance):
    """The flywheel; it holds two numbers of every row, as the work is known only with the mean of
    all loads, and then the rows are gone through for each rate that is tried."""

    def __init__(self, balance: Flywheel, rows: int) -> None:
        super().__init__(balance, rows)
        self._balance = balance
        self._loads, self._inertia = _Held("the loads' moment"), _Held("the reduced inertia")

    def _add(self, result: Result, own: slice) -> None:
        if self._cycle.lost is not None:
            return
        parts = powers_along(result, self._balance.cycle)
        efforts = {f"{joint}.{coordinate}.effort" for joint, coordinate in result.problem.acting}
        loads = np.zeros(result.rows)
        for name, values in parts.items():
            if name not in efforts and name != "inertia":
                loads = loads + values
        energy = result.problem.quantities()["row.kinetic_energy"]
        along = rates_along(result, self._balance.cycle)
        inertia = 2.0 * result.evaluated([energy], inputs=along)[energy.name][0]
        self._loads.add(loads[own])
        self._inertia.add(inertia[own])

    def table(self) -> Table:
        size: tuple[float, ...] = (float("nan"),) * 7
        fault, balance = self._cycle.fault(), self._balance
        faults = [] if fault is None else [fault]
        if fault is None:
            both = self._loads, self._inertia
            faults += [one.samples.fault(balance, one.what) for one in both if not one.repeat]
        if not faults:
            loads, inertia = self._loads.values[:-1], self._inertia.values[:-1]
            step, turning = balance.cycle.step, balance.unevenness
            size = sized(loads, inertia, step, turning, balance.rate)
        flywheel, estimate, drive, fluctuation, least, most, without = size
        columns = [
            TableColumn("unevenness", "", np.array([balance.unevenness])),
            self._numbers("rate", ANGULAR_RATE, [balance.rate]),
            self._numbers("flywheel", INERTIA, [flywheel]),
            self._numbers("estimate", INERTIA, [estimate]),
            self._numbers("drive", MOMENT, [drive]),
            self._numbers("work_fluctuation", ENERGY, [fluctuation]),
            self._numbers("least_inertia", INERTIA, [least]),
            self._numbers("largest_inertia", INERTIA, [most]),
            TableColumn("unevenness_without", "", np.array([without])),
        ]
        return _table(balance, columns, faults)


class _Held:
    """Samples over all rows, by what they are of."""

    def __init__(self, what: str) -> None:
        self.what, self.samples = what, _Samples()
        self._parts: list[Floats] = []

    def add(self, values: Floats) -> None:
        """Takes the next samples."""
        self.samples.add(values)
        self._parts.append(values.copy())

    @property
    def repeat(self) -> bool:
        """Whether they are a cycle."""
        return self.samples.repeat

    @property
    def values(self) -> Floats:
        """All of them."""
        return np.concatenate(self._parts)


def _table(balance: AnyBalance, columns: list[TableColumn], faults: list[Diagnostic]) -> Table:
    return Columns(balance.name, balance.title, tuple(columns), of_rows=False), faults
