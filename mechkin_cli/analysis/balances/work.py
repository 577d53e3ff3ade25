"""The work of every effort and load over a cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.analysis.balances.along import rates_along, repeated, sample_fault
from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.analysis.derived.coefficients import unloaded
from mechkin_cli.analysis.derived.load_powers import (
    GRAVITY,
    effort_powers,
    friction_power,
    load_powers_along,
    power_against,
)
from mechkin_cli.analysis.derived.quadrature import over_cycle

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism.balance import Cycle, Work
    from mechkin_cli.mechanism.model import Load


class Item(NamedTuple):
    """Work over the cycle (J), and how far it may be off."""

    name: str
    work: float
    error: float


def work_over_cycle(result: Result, balance: Work) -> tuple[list[Item], list[Diagnostic]]:
    """Works of efforts, gravity, loads and inertia, and their sum, which is what is missing."""
    cycle, items, faults = balance.cycle, [], []
    parts = powers_along(result, cycle)
    total = np.zeros(result.rows)
    for values in parts.values():
        total = total + values
    for name, values in parts.items():
        if repeated(values):
            items.append(Item(name, *over_cycle(values[:-1], cycle.step)))
        else:
            faults.append(sample_fault(balance, name, values))
            items.append(Item(name, float("nan"), float("nan")))
    items.append(Item("sum", *over_cycle(total[:-1], cycle.step)))
    return items, faults


def powers_along(result: Result, cycle: Cycle) -> dict[str, Floats]:
    """The forces' products with the motion along the cycle (J per rad or s, rows), by name: of
    efforts, gravity and loads, and of inertia, by which they are in balance."""
    run = Reading(result, {}, result.session.inputs)
    along = rates_along(result, cycle)
    found = effort_powers(run, along)
    for number, (load, power) in enumerate(load_powers_along(run, along)):
        found[load_name(result, number, load)] = power
    rubbed = friction_power(run, along)
    if rubbed is not None:
        found["friction"] = rubbed
    masses = unloaded(result.session, at_inputs=True)
    return found | {"inertia": power_against(run, along, masses)}


def load_name(result: Result, number: int, load: Load | str) -> str:
    """`load 2: damper`, counted as they act; gravity is not among them."""
    if load == GRAVITY:
        return GRAVITY
    first = 1 if any(result.problem.mechanism.gravity) else 0
    words = {"LinkLoad": "on link", "JointLoad": "at joint"}
    kind = type(load).__name__
    what = words.get(kind, kind.lower())
    owner = getattr(load, "link", None) or getattr(load, "joint", None)
    return f"load {number - first + 1}: {what}{f' {owner}' if owner else ''}"
