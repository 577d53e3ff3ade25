"""Random arms of two or three pins that rub, against an integration from event to event.

    python -m random_families.friction_arms 100

from `tests/` prints the errors of as many arms, and how many joints end at rest.
"""

from __future__ import annotations

import random
import sys
from typing import NamedTuple

import numpy as np
from friction.arm_reference import Arm, Floats

import mechkin_cli as mk

LAST, NUDGE = 2.0, 1e-10


class Compared(NamedTuple):
    """The largest errors of angles, what a nudge of the start makes of them, the largest error of
    the energy, and how many pins rest at the end."""

    error: float
    nudged: float
    energy: float
    resting: int


def random_arm(seed: int) -> tuple[Arm, list[float], list[float]]:
    """An arm with the angles and rates that it starts with."""
    rng = random.Random(seed)
    count, u = rng.choice([2, 2, 3]), rng.uniform
    static = [u(0.05, 0.4) for _ in range(count)]
    arm = Arm(
        length=[u(0.3, 1) for _ in range(count)],
        mass=[u(0.5, 3) for _ in range(count)],
        centre=[u(0.1, 0.6) for _ in range(count)],
        inertia=[u(0.02, 0.2) for _ in range(count)],
        radius=[u(0.03, 0.15) for _ in range(count)],
        static=static,
        sliding=[s * rng.choice([1.0, u(0.5, 1)]) for s in static],
    )
    angle = [u(-2, 2) for _ in range(count)]
    return arm, angle, [rng.choice([0.0, u(-4, 4)]) for _ in range(count)]


def responded(arm: Arm, angle: list[float], rate: list[float]) -> tuple[Floats, mk.Analysis]:
    """Angles (n, rows) and the whole response."""
    names = [f"J{k}.theta" for k in range(arm.count)]
    rates = [f"{name}_dot" for name in names]
    model = mk.loads(arm.text(angle, rate, "0.1", LAST))
    found = model.respond("go", [*names, *rates, "time", "row.energy_error"])
    return np.array([found[name] for name in names]), found


def compare(seed: int) -> Compared:
    """A random arm, the reference, and the arm from a start that is nudged."""
    arm, angle, rate = random_arm(seed)
    here, found = responded(arm, angle, rate)
    nudged, _ = responded(arm, [a + NUDGE for a in angle], rate)
    expected = arm.integrated(angle, rate, np.asarray(found["time"]))[: arm.count]
    return Compared(
        float(np.max(np.abs(here - expected))),
        float(np.max(np.abs(here - nudged))),
        float(np.max(found["row.energy_error"])),
        sum(found[f"J{k}.theta_dot"][-1] == 0.0 for k in range(arm.count)),
    )


if __name__ == "__main__":
    all_compared = []
    for number in range(int(sys.argv[1])):
        all_compared.append(compare(number))
        print(number, *(f"{x:.2g}" for x in all_compared[-1]), flush=True)
    worst = np.max(all_compared, axis=0)
    print(f"largest error {worst[0]:.2g}, of the energy {worst[2]:.2g}")
