"""The derived quantities of a run as further columns of its outputs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.derived.advantage import mechanical_advantages
from mechkin_cli.analysis.derived.basis import Reading, basis_of
from mechkin_cli.analysis.derived.coefficients import coefficients
from mechkin_cli.analysis.derived.ledger import ledger
from mechkin_cli.analysis.derived.orientation import continuous_quaternion, turn
from mechkin_cli.analysis.derived.screws import finite_screw, instant_screw
from mechkin_cli.analysis.derived.transmission import dynamic_transmission_angle, transmission_angle
from mechkin_cli.analysis.derived.unit_rate import at_unit_rate
from mechkin_cli.mechanism.coefficient_quantities import COEFFICIENT_KINDS
from mechkin_cli.mechanism.derived_quantities import (
    FINITE_KINDS,
    INSTANT_KINDS,
    LEDGER_KINDS,
    QUATERNION,
)
from mechkin_cli.mechanism.quantities import Wanted

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def derived_columns(run: Reading, wanted: Sequence[Wanted]) -> dict[str, Floats]:
    """Some derived quantities of a run by name, (1, rows) or (3, rows) in SI."""
    with np.errstate(all="ignore"):
        parts = _computed(run, wanted)
        return {q.name: np.stack(own) for q, own in zip(wanted, parts, strict=True)}


def _moving(run: Reading, instant: list[Wanted]) -> Reading:
    """The run whose rates instant screws have: a file that gives none moves at unit rate."""
    session = run.session
    leading = session.problem.motion.leading
    if not instant or session.inputs.rates.any() or leading is None:
        return run
    return at_unit_rate(run, basis_of(session.problem.mechanism, instant))


def _computed(run: Reading, wanted: Sequence[Wanted]) -> list[list[Floats]]:
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
