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
    effort_powers,
    friction_power,
    largest_between,
    load_powers_along,
    mean,
    over_cycle,
    power_against,
    running_integral_of_cycle,
    total,
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


def cycle_fault(result: Result, balance: AnyBalance) -> Diagnostic | None:
    """Why the rows are no closed cycle; None where they are."""
    cycle, rows = balance.cycle, result.row_states
    lost = np.flatnonzero(~result.solved)
    if lost.size:
        text = f"{balance.name}: row {lost[0] + 1} of the cycle has no solution"
        hint = "balances need every row; move or turn the sweep so that all have one"
        return _fault("balance-undefined", balance, text, hint)
    ends = rows.states[:, [0, -1]]
    if stands_elsewhere(result.session, ends) or _turned_in_part(result.session, ends):
        text = f"{balance.name}: the mechanism is not back at the last row where it was at first"
        again = (cycle.turns + 1) if cycle.number is not None else 2
        hint = f"let the rows go over more turns, such as {again}; mechkin ranges shows the circuit"
        return _fault("cycle-not-closed", balance, text, hint)
    moving = result.problem.motion.inputs
    along = rates_along(result, cycle).rates
    for number, item in enumerate(moving):
        if np.ptp(item.values) and not along[number].any():
            text = f"{balance.name}: {item.name} moves, too, but does not follow {cycle.name}"
            hint = f"tie it with {{with: an expression of {cycle.name}}}, or give the sweep a time:"
            return _fault("no-cycle", balance, text, hint)
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


def repeated(values: Floats) -> bool:
    """Whether the last of some samples is the first again, and all are numbers."""
    if not np.isfinite(values).all():
        return False
    size = float(np.max(np.abs(values)))
    return bool(abs(values[-1] - values[0]) <= tolerances.REPEATS * size)


def sample_fault(balance: AnyBalance, what: str, values: Floats) -> Diagnostic:
    """Why samples over the rows are no cycle."""
    lost = np.flatnonzero(~np.isfinite(values))
    if lost.size:
        text = f"{balance.name}: {what} has no value in row {lost[0] + 1}"
        return _fault("balance-undefined", balance, text, "see the notes on that row, and on it")
    text = f"{balance.name}: {what} is not at the last row what it was at the first"
    hint = "what depends on time, or on an angle with its turns, does not repeat; use wrap(angle)"
    measured = f"{values[-1]:.6g} for {values[0]:.6g}"
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


def harmonic(
    values: Floats, cycle: Cycle, order: float
) -> tuple[float, float, float, float, float]:
    """An order of samples over the cycle (rows - 1,): both coefficients, amplitude and phase (rad)
    of amplitude cos(n x - phase), and how far the coefficients may be off."""
    cosine, sine = _coefficients(values, cycle, order)
    error = float("nan")
    if values.size % 2 == 0 and 4 * round(order * cycle.turns) < values.size:
        coarse = _coefficients(values[::2], cycle, order)
        error = max(abs(cosine - coarse[0]), abs(sine - coarse[1]))
    amplitude = float(np.sqrt(cosine * cosine + sine * sine))
    phase = float(atan2(np.array([sine]), np.array([cosine]))[0])
    return cosine, sine, amplitude, phase, error


def _coefficients(values: Floats, cycle: Cycle, order: float) -> tuple[float, float]:
    count, whole = values.size, round(order * cycle.turns)
    # n x from row to row is a whole number of N-th parts of a turn
    part = (whole * np.arange(count)) % count
    angle = np.asarray(part * (2.0 * np.pi / count), dtype=np.float64)
    if cycle.number is not None:
        angle = (angle if cycle.step > 0.0 else -angle) + order * cycle.first
    factor = (1.0 if whole == 0 else 2.0) / count
    cosine = factor * total(values * cos(angle))
    sine = 0.0 if whole == 0 else factor * total(values * sin(angle))
    return cosine, sine


Work = tuple[str, float, float]
"""Name, work over the cycle (J), and how far it may be off."""


def work_over_cycle(result: Result, balance: LoadWork) -> tuple[list[Work], list[Diagnostic]]:
    """Works of efforts, gravity, loads and inertia, and their sum, which is what is missing."""
    cycle, works, faults = balance.cycle, list[Work](), []
    parts = powers_along(result, cycle)
    total = np.zeros(result.rows)
    for values in parts.values():
        total = total + values
    for name, values in parts.items():
        if repeated(values):
            works.append((name, *over_cycle(values[:-1], cycle.step)))
        else:
            faults.append(sample_fault(balance, name, values))
            works.append((name, float("nan"), float("nan")))
    works.append(("sum", *over_cycle(total[:-1], cycle.step)))
    return works, faults


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
    fault = cycle_fault(result, balance)
    if isinstance(balance, LoadWork):
        return _work(balance, result, fault)
    if isinstance(balance, Harmonics):
        return _harmonics(balance, result, fault)
    return _flywheel(balance, result, fault)


def _work(balance: LoadWork, result: Result, fault: Diagnostic | None) -> Table:
    works, faults = [("sum", np.nan, np.nan)], [] if fault is None else [fault]
    if fault is None:
        works, faults = work_over_cycle(result, balance)
    names, work, error = zip(*works, strict=True)
    columns = [
        TableColumn("of", "", words_of(names)),
        _numbers(result, "work", ENERGY, work),
        _numbers(result, "error", ENERGY, error),
    ]
    return _table(balance, columns, faults)


def _harmonics(balance: Harmonics, result: Result, fault: Diagnostic | None) -> Table:
    names, orders, cells, unit = [], [], [], ""
    faults = [] if fault is None else [fault]
    for label, expression in balance.of:
        column = column_of(ColumnLayout(label, expression), result)
        values, unit = np.asarray(column.values, dtype=np.float64), column.unit
        if fault is None and not repeated(values):
            faults.append(sample_fault(balance, label, values))
        good = fault is None and repeated(values)
        for order in balance.orders:
            names.append(label)
            orders.append(order)
            cells.append(harmonic(values[:-1], balance.cycle, order) if good else (np.nan,) * 5)
            if cells[-1][2] <= REACTION_ROUNDING * float(np.max(np.abs(values))):
                # an amplitude that is rounding has no phase
                cells[-1] = (*cells[-1][:3], np.nan, cells[-1][4])
    cosine, sine, amplitude, phase, error = np.array(cells).reshape(-1, 5).T.copy()
    columns = [
        TableColumn("of", "", words_of(names)),
        TableColumn("order", "", np.array(orders)),
        TableColumn("cosine", unit, cosine),
        TableColumn("sine", unit, sine),
        TableColumn("amplitude", unit, amplitude),
        _numbers(result, "phase", ANGLE, phase),
        TableColumn("error", unit, error),
    ]
    return _table(balance, columns, faults)


def _flywheel(balance: Flywheel, result: Result, fault: Diagnostic | None) -> Table:
    size: tuple[float, ...] = (float("nan"),) * 7
    faults = [] if fault is None else [fault]
    if fault is None:
        parts = powers_along(result, balance.cycle)
        efforts = {f"{joint}.{coordinate}.effort" for joint, coordinate in result.problem.acting}
        loads = np.zeros(result.rows)
        for name, values in parts.items():
            if name not in efforts and name != "inertia":
                loads = loads + values
        energy = result.problem.quantities()["row.kinetic_energy"]
        along = rates_along(result, balance.cycle)
        inertia = 2.0 * result.evaluated([energy], inputs=along)[energy.name][0]
        for what, values in (("the loads' moment", loads), ("the reduced inertia", inertia)):
            if not repeated(values):
                faults.append(sample_fault(balance, what, values))
        if not faults:
            step, turning = balance.cycle.step, balance.unevenness
            size = sized(loads[:-1], inertia[:-1], step, turning, balance.rate)
    flywheel, estimate, drive, fluctuation, least, most, without = size
    columns = [
        TableColumn("unevenness", "", np.array([balance.unevenness])),
        _numbers(result, "rate", ANGULAR_RATE, [balance.rate]),
        _numbers(result, "flywheel", INERTIA, [flywheel]),
        _numbers(result, "estimate", INERTIA, [estimate]),
        _numbers(result, "drive", MOMENT, [drive]),
        _numbers(result, "work_fluctuation", ENERGY, [fluctuation]),
        _numbers(result, "least_inertia", INERTIA, [least]),
        _numbers(result, "largest_inertia", INERTIA, [most]),
        TableColumn("unevenness_without", "", np.array([without])),
    ]
    return _table(balance, columns, faults)


def _table(balance: AnyBalance, columns: list[TableColumn], faults: list[Diagnostic]) -> Table:
    return Columns(balance.name, balance.title, tuple(columns), of_rows=False), faults


def _numbers(
    result: Result, label: str, dimension: Dimension, values: Sequence[float] | np.ndarray
) -> TableColumn:
    units = result.units
    in_file = units.from_si(np.array(values, dtype=np.float64), dimension)
    return TableColumn(label, units.label(dimension), np.asarray(in_file))
