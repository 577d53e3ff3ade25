"""The derived quantities of a run as further columns of its outputs; the mechanical advantage.

Mechanical advantage is the rate of the leading input over the rate of a coordinate. Without losses
the powers of input and load are equal, so it is the load that a unit of input effort balances.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.derived.basis import BasisQuantities, at_unit_rate, basis_of
from mechkin_cli.derived.coefficients import coefficients
from mechkin_cli.derived.energy import ledger
from mechkin_cli.derived.rotation import continuous_quaternion, turn
from mechkin_cli.derived.transmission import (
    dynamic_transmission_angle,
    finite_screw,
    instant_screw,
    transmission_angle,
)
from mechkin_cli.mechanism import (
    COEFFICIENT_KINDS,
    FINITE_KINDS,
    INSTANT_KINDS,
    LEDGER_KINDS,
    QUATERNION,
    Wanted,
    is_angle,
)

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


def mechanical_advantages(run: BasisQuantities, wanted: Sequence[Wanted]) -> list[Floats]:
    """Each quantity's values (rows,) in SI; nan where the coordinate stands still."""
    problem, layout = run.session.problem, run.session.layout
    known, leading = problem.quantities(), problem.motion.leading
    assert leading is not None
    names = [f"{quantity.owner}.{quantity.coordinate}_dot" for quantity in wanted]
    influence = at_unit_rate(run, [known[name] for name in (f"{leading.name}_dot", *names)])
    driven = influence.scalar(f"{leading.name}_dot")
    advantages = []
    for quantity, name in zip(wanted, names, strict=True):
        rate = influence.scalar(name)
        size = 1.0 if is_angle(quantity.coordinate) else layout.length
        moves = np.abs(rate) > tolerances.STANDS_STILL * size
        advantages.append(np.where(moves, driven / rate, np.nan))
    return advantages


def derived_columns(run: BasisQuantities, wanted: Sequence[Wanted]) -> dict[str, Floats]:
    """Some derived quantities of a run by name, (1, rows) or (3, rows) in SI."""
    with np.errstate(all="ignore"):
        parts = _computed(run, wanted)
        return {q.name: np.stack(own) for q, own in zip(wanted, parts, strict=True)}


def _computed(run: BasisQuantities, wanted: Sequence[Wanted]) -> list[list[Floats]]:
    session, moving = run.session, run
    of_screws = [quantity for quantity in wanted if quantity.kind in INSTANT_KINDS]
    driven = session.problem.motion.leading is not None
    if of_screws and driven and not session.inputs.rates.any():
        # a file without rates has the instant screws of unit rate
        moving = at_unit_rate(run, basis_of(session.problem.mechanism, of_screws))
    quaternion = cache(lambda owner: continuous_quaternion(run, owner))
    instant = cache(lambda owner: instant_screw(moving, owner))
    finite = cache(lambda owner: finite_screw(run, owner))
    of_advantages = [quantity for quantity in wanted if quantity.kind == "mechanical_advantage"]
    advantages = iter(mechanical_advantages(run, of_advantages) if of_advantages else ())
    energies = cache(lambda: ledger(run))
    linear = coefficients(run, [q for q in wanted if q.kind in COEFFICIENT_KINDS])

    def parts(quantity: Wanted) -> list[Floats]:
        owner = quantity.owner
        if quantity.kind == "quaternion":
            return [quaternion(owner)[QUATERNION.index(quantity.coordinate)]]
        if quantity.kind == "turn":
            return [*turn(run, owner)]
        if quantity.kind == "mechanical_advantage":
            return [next(advantages)]
        if quantity.kind == "transmission_angle":
            return [transmission_angle(run, quantity)]
        if quantity.kind == "dynamic_transmission_angle":
            return [dynamic_transmission_angle(run, quantity)]
        if quantity.kind in LEDGER_KINDS:
            return [energies()[quantity.kind.removeprefix("ledger_")]]
        if quantity.kind in COEFFICIENT_KINDS:
            return [*linear[quantity.name]]
        if quantity.kind in INSTANT_KINDS:
            part = instant(owner)[quantity.kind.removeprefix("screw_")]
        else:
            assert quantity.kind in FINITE_KINDS
            part = finite(owner)[quantity.kind.removeprefix("finite_")]
        return [*part] if isinstance(part, tuple) else [part]

    return [parts(quantity) for quantity in wanted]
