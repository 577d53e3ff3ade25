"""Balances as small tables in the file's units."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.balances.along import (
    cycle_fault,
    rates_along,
    repeated,
    sample_fault,
)
from mechkin_cli.analysis.balances.flywheel import Sized, sized
from mechkin_cli.analysis.balances.harmonics import harmonic
from mechkin_cli.analysis.balances.work import powers_along, work_over_cycle
from mechkin_cli.mechanism.balance import AnyBalance, Flywheel, Harmonics, Work
from mechkin_cli.tables.columns import Column, Columns, Words, column_of
from mechkin_cli.tables.layout import ColumnLayout
from mechkin_cli.tolerances import REACTION_ROUNDING
from mechkin_cli.units import ANGLE, ANGULAR_RATE, ENERGY, INERTIA, MOMENT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.units import Dimension

Table = tuple[Columns, list["Diagnostic"]]


def balance_table(balance: AnyBalance, result: Result) -> Table:
    """A balance over the rows, and what is wrong with it; its cells are empty then."""
    fault = cycle_fault(result, balance)
    if isinstance(balance, Work):
        return _work(balance, result, fault)
    if isinstance(balance, Harmonics):
        return _harmonics(balance, result, fault)
    return _flywheel(balance, result, fault)


def _work(balance: Work, result: Result, fault: Diagnostic | None) -> Table:
    if fault is not None:
        return _table(
            balance, [_words("of", ["sum"]), *_energies(result, [np.nan], [np.nan])], [fault]
        )
    items, faults = work_over_cycle(result, balance)
    energies = _energies(result, [i.work for i in items], [i.error for i in items])
    return _table(balance, [_words("of", [item.name for item in items]), *energies], faults)


def _energies(result: Result, work: Sequence[float], error: Sequence[float]) -> list[Column]:
    return [
        _numbers(result, "work", ENERGY, work),
        _numbers(result, "error", ENERGY, error),
    ]


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
            found = harmonic(values[:-1], balance.cycle, order) if good else None
            if found and found.amplitude <= REACTION_ROUNDING * float(np.max(np.abs(values))):
                # what rounding leaves has no phase
                found = found._replace(phase=np.nan)
            cells.append(found[1:] if found else (np.nan,) * 5)
    cosine, sine, amplitude, phase, error = np.array(cells).reshape(-1, 5).T.copy()
    return _table(
        balance,
        [
            _words("of", names),
            Column("order", "", np.array(orders)),
            Column("cosine", unit, cosine),
            Column("sine", unit, sine),
            Column("amplitude", unit, amplitude),
            _numbers(result, "phase", ANGLE, phase),
            Column("error", unit, error),
        ],
        faults,
    )


def _flywheel(balance: Flywheel, result: Result, fault: Diagnostic | None) -> Table:
    found, faults = Sized(*[float("nan")] * 7), [] if fault is None else [fault]
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
            found = sized(loads[:-1], inertia[:-1], step, turning, balance.rate)
    columns = [
        Column("unevenness", "", np.array([balance.unevenness])),
        _numbers(result, "rate", ANGULAR_RATE, [balance.rate]),
        _numbers(result, "flywheel", INERTIA, [found.flywheel]),
        _numbers(result, "estimate", INERTIA, [found.estimate]),
        _numbers(result, "drive", MOMENT, [found.drive]),
        _numbers(result, "work_fluctuation", ENERGY, [found.fluctuation]),
        _numbers(result, "least_inertia", INERTIA, [found.least]),
        _numbers(result, "largest_inertia", INERTIA, [found.most]),
        Column("unevenness_without", "", np.array([found.without])),
    ]
    return _table(balance, columns, faults)


def _table(balance: AnyBalance, columns: list[Column], faults: list[Diagnostic]) -> Table:
    return Columns(balance.name, balance.title, tuple(columns), of_rows=False), faults


def _words(label: str, texts: Sequence[str]) -> Column:
    known = tuple(dict.fromkeys(texts))
    codes = np.array([known.index(text) for text in texts], dtype=np.int32)
    return Column(label, "", Words(codes, known))


def _numbers(
    result: Result, label: str, dimension: Dimension, values: Sequence[float] | np.ndarray
) -> Column:
    units = result.units
    in_file = units.from_si(np.array(values, dtype=np.float64), dimension)
    return Column(label, units.label(dimension), np.asarray(in_file))
