"""Mechanical advantage: the rate of the leading input over the rate of a coordinate.

Without losses the powers of input and load are equal, so it is the load that a unit of input effort
balances.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.analysis.derived.unit_rate import at_unit_rate
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.quantities import Wanted

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def mechanical_advantages(run: Reading, wanted: Sequence[Wanted]) -> list[Floats]:
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
