"""The derived quantities of a run as further columns of its outputs."""

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


# Mechanical advantage: the rate of the leading input over the rate of a coordinate.
#
# Without losses the powers of input and load are equal, so it is the load that a unit of input
# effort balances.


def mechanical_advantages(run: BasisQuantities, wanted: Sequence[Wanted]) -> list[Floats]:
    """Each quantity's values (rows,) in SI; nan where the coordinate stands still."""
    problem, layout = run.session.problem, run.session.layout
    known, leading = problem.quantities(), problem.motion.leading
    assert leading is not None
    names = [f"{quantity.owner}.{quantity.coordinate}_dot" for quantity in wanted]
    influence = at_unit_rate(run, [known[name] for name in (f"{leading.name}_dot", *names)])
    given = influence.scalar(f"{leading.name}_dot")
    found = []
    for quantity, name in zip(wanted, names, strict=True):
        rate = influence.scalar(name)
        size = 1.0 if is_angle(quantity.coordinate) else layout.length
        moves = np.abs(rate) > tolerances.STANDS_STILL * size
        found.append(np.where(moves, given / rate, np.nan))
    return found


def derived_columns(run: BasisQuantities, wanted: Sequence[Wanted]) -> dict[str, Floats]:
    """Some derived quantities of a run by name, (1, rows) or (3, rows) in SI."""
    with np.errstate(all="ignore"):
        parts = _computed(run, wanted)
        return {q.name: np.stack(own) for q, own in zip(wanted, parts, strict=True)}


def _moving(run: BasisQuantities, instant: list[Wanted]) -> BasisQuantities:
    """The run whose rates instant screws have: a file that gives none moves at unit rate."""
    session = run.session
    leading = session.problem.motion.leading
    if not instant or session.inputs.rates.any() or leading is None:
        return run
    return at_unit_rate(run, basis_of(session.problem.mechanism, instant))


def _computed(run: BasisQuantities, wanted: Sequence[Wanted]) -> list[list[Floats]]:
    quaternion = cache(lambda owner: continuous_quaternion(run, owner))
    moving = _moving(run, [quantity for quantity in wanted if quantity.kind in INSTANT_KINDS])
    instant = cache(lambda owner: instant_screw(moving, owner))
    finite = cache(lambda owner: finite_screw(run, owner))
    asked = [quantity for quantity in wanted if quantity.kind == "mechanical_advantage"]
    energies = cache(lambda: ledger(run))
    linear = [quantity for quantity in wanted if quantity.kind in COEFFICIENT_KINDS]
    found = coefficients(run, linear)
    advantages = iter(mechanical_advantages(run, asked) if asked else ())

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
            return [*found[quantity.name]]
        if quantity.kind in INSTANT_KINDS:
            value = getattr(instant(owner), quantity.kind.removeprefix("screw_"))
        else:
            assert quantity.kind in FINITE_KINDS
            value = getattr(finite(owner), quantity.kind.removeprefix("finite_"))
        return [*value] if quantity.vector else [value]

    return [parts(quantity) for quantity in wanted]
