"""The flywheel that keeps a machine's rate within bounds, under a drive of constant effort.

With the work W(x) of drive and loads from the first row on and the reduced inertia J(x), the energy
T0 + W = (J + J_F) omega^2 / 2 has to keep omega between the bounds everywhere:

    T0 - w_min^2/2 J_F  >=  A = max(w_min^2/2 J - W)
    T0 - w_max^2/2 J_F  <=  B = min(w_max^2/2 J - W)

The least flywheel meets both: J_F = (A - B) / (unevenness mean^2). These are the tangents to
Wittenbauer's diagram of energy over inertia (Wittenbauer, Graphische Dynamik, 1923), without the
usual approximation, which takes one rate for both bounds. Loads are those of the rows: what reads
rates does not follow the fluctuation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.analysis.derived.quadrature import (
    largest_between,
    mean,
    running_integral_of_cycle,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.arrays import Floats


class Sized(NamedTuple):
    """What a flywheel is sized by, SI.

    Attributes:
        flywheel: its inertia; 0 where none is needed.
        estimate: the same with the mean rate at both bounds.
        drive: the constant effort that balances the loads' work.
        fluctuation: largest less least work of drive and loads.
        least, most: reduced inertia of the mechanism.
        without: the unevenness without a flywheel; nan where it would not go round.
    """

    flywheel: float
    estimate: float
    drive: float
    fluctuation: float
    least: float
    most: float
    without: float


def sized(loads: Floats, inertia: Floats, step: float, unevenness: float, rate: float) -> Sized:
    """The flywheel of a machine.

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

    return Sized(
        flywheel=max(needed(unevenness, unevenness), 0.0),
        estimate=max(needed(unevenness, 0.0), 0.0),
        drive=drive,
        fluctuation=largest_between(work) + largest_between(-work),
        least=-largest_between(-inertia),
        most=largest_between(inertia),
        without=_root(lambda share: needed(share, share)),
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
