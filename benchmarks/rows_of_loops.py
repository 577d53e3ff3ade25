"""Times responses of N four-bars in a row, which are all in one matrix.

    python -m benchmarks.rows_of_loops [--rounds N] [--end SECONDS] [LOOPS...]

Parallel cranks swing under gravity, once at some distance from their branch points and once through
them. Responses take turns, so that a slow moment of the machine meets each. Printed are the best
time for a loop and a second of motion, reading left out, and its ratio to that of ten loops: one,
if the work goes with the number of loops. The last column says by how much the motion differs from
the compound pendulum that parallel cranks are.

At the end stands problem A02 of the IFToMM library of multibody benchmarks, the same cranks that
turn over and pass their branch points twice a turn, beside times that others published: of their
machines, not measured here.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from time import process_time

import numpy as np

from mechkin_cli.model.model import Model, loads

LOOPS = (1, 10, 20, 40, 80, 160)
COMPARED_WITH = 10
ROUNDS = 5
END = 10.0
GRAVITY = 9.81
STARTS = {"apart": 3.0, "through branch points": 1.0}
"""Angles at which the cranks are drawn and let go, from upright on (rad)."""

A02 = ((2, 10.0), (40, 10.0), (40, 20.0))
"""Loops and seconds. The problem itself is of 40 and 20 s (M. Gonzalez and others, A benchmarking
system for MBS simulation software, Multibody System Dynamics 16, 2006); it is published for 2, too.
"""
A02_RATE = -1.0
"""Of the cranks at first, upright, so that the first joint moves by 1 m/s along x (rad/s)."""
PUBLISHED = {(2, 10.0): "455 ms, OpenSim 3.2, Core i5-4570 at 3.2 GHz (MBSbenchmarksInOpenSim)"}
"""What others say of these, in their words and on their machines."""

HEAD = """format: 1
name: four-bars in a row
plane: xy
units: {angle: rad}
assembly: {at_branch_points: straight}
"""


def text(loops: int, angle: float, end: float, rate: float = 0.0) -> str:
    """Uniform rods, 1 m long and of 1 kg, that begin at rest or turn at a rate (rad/s)."""
    s, c = float(np.sin(angle)), float(np.cos(angle))
    begun = f", A0.theta_dot: {rate!r}" if rate else ""
    rod = f"inertia: {1 / 12!r}"
    links, joints = [], []
    for k in range(loops + 1):
        centre = f"[{k - 0.5 * s!r}, {0.5 * c!r}]"
        links.append(f"  crank{k}: {{mass: 1, center_of_mass: {centre}, {rod}}}")
        joints.append(f"  A{k}: {{type: R, links: [ground, crank{k}], point: [{k}, 0]}}")
    for k in range(loops):
        centre = f"[{k + 0.5 - s!r}, {c!r}]"
        links.append(f"  bar{k}: {{mass: 1, center_of_mass: {centre}, {rod}}}")
        at, beyond = f"[{k - s!r}, {c!r}]", f"[{k + 1 - s!r}, {c!r}]"
        joints.append(f"  B{k}: {{type: R, links: [crank{k}, bar{k}], point: {at}}}")
        joints.append(f"  C{k}: {{type: R, links: [bar{k}, crank{k + 1}], point: {beyond}}}")
    return "\n".join(
        [
            f"{HEAD}links:",
            *links,
            "joints:",
            *joints,
            f"loads: [{{type: gravity, g: [0, -{GRAVITY}]}}]",
            f"responses:\n  fall:\n    start: {{A0.theta: 0{begun}}}",
            f"    time: {{from: 0, to: {end!r}, step: {end / 10.0!r}}}",
            "",
        ]
    )


def pendulum(loops: int, angle: float, times: np.ndarray, rate: float = 0.0) -> np.ndarray:
    """The angle from upright on, by Taylor's method of fourth order in steps of 0.1 ms."""
    cranks = loops + 1
    pull = GRAVITY * (0.5 * cranks + loops) / (cranks / 3 + loops)
    found, x, v, now, step = [], angle, rate, 0.0, 1e-4
    for time in times:
        while now < time - 0.5 * step:
            s, c = np.sin(x), np.cos(x)
            a = pull * s
            jerk, snap = pull * c * v, pull * (c * a - s * v * v)
            x += step * (v + step / 2 * (a + step / 3 * (jerk + step / 4 * snap)))
            crackle = pull * (c * jerk - 3 * s * v * a - c * v**3)
            v += step * (a + step / 2 * (jerk + step / 3 * (snap + step / 4 * crackle)))
            now += step
        found.append(x)
    return np.array(found) - angle


def best_times(runs: dict[int, Callable[[], object]], rounds: int) -> dict[int, float]:
    """The shortest processor time of each, s, after one round to warm up."""
    best = dict.fromkeys(runs, float("inf"))
    for number in range(rounds + 1):
        for loops, run in runs.items():
            start = process_time()
            run()
            if number:
                best[loops] = min(best[loops], process_time() - start)
    return best


def main() -> None:
    """Prints the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--end", type=float, default=END)
    parser.add_argument("loops", nargs="*", type=int, default=list(LOOPS), metavar="LOOPS")
    given = parser.parse_args()
    numbers = sorted({*given.loops, COMPARED_WITH})
    for name, angle in STARTS.items():
        models = {loops: loads(text(loops, angle, given.end)) for loops in numbers}
        best = best_times({loops: _run(model) for loops, model in models.items()}, given.rounds)
        print(f"{name}: loops, ms per loop and s, ratio to {COMPARED_WITH} loops, off by (rad)")
        one = best[COMPARED_WITH] / COMPARED_WITH
        for loops in numbers:
            found = models[loops].respond("fall", ["A0.theta"], threads=1)
            exact = pendulum(loops, angle, np.asarray(found["time"], float))
            off = float(np.max(np.abs(found["A0.theta"] - exact)))
            each = best[loops] / loops
            print(f"{loops:>5} {1000 * each / given.end:9.3f} {each / one:7.2f} {off:10.1e}")
    print("A02: loops, s of motion, ms in all, off by (rad), published by others")
    for loops, end in A02:
        model = loads(text(loops, 0.0, end, A02_RATE))
        shortest = best_times({loops: _run(model)}, given.rounds)[loops]
        found = model.respond("fall", ["A0.theta"], threads=1)
        exact = pendulum(loops, 0.0, np.asarray(found["time"], float), A02_RATE)
        off = float(np.max(np.abs(found["A0.theta"] - exact)))
        said = PUBLISHED.get((loops, end), "")
        print(f"{loops:>5} {end:5g} {1000 * shortest:9.2f} {off:10.1e}  {said}".rstrip())


def _run(model: Model) -> Callable[[], object]:
    return lambda: model.respond("fall", ["A0.theta"], threads=1)


if __name__ == "__main__":
    main()
