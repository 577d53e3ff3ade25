"""All modes of vibration of many loops: a ladder of one freedom, and four-bars of one freedom each
that springs join. Processor time, and what part it is of reading the file and sweeping 361 rows
with their efforts in the same run; frequencies are checked against scipy's eigenvalues.

    python -P tests/benchmark/small_motions.py [--loops N]...
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
import scipy.linalg

import mechkin_cli as mk
from mechkin_cli.vibration import Vibration, freed

ROWS = 361
REPETITIONS = 5


def ladder(loops: int) -> str:
    """Parallel bars, joined one to the next by rods: as many loops, one freedom."""
    links, joints, loads = [], [], ["  - {type: gravity, g: [0, -9.81, 0]}"]
    for k in range(loops + 1):
        links.append(f"  bar{k}: {{mass: 1, center_of_mass: [{k}, 0.5, 0], inertia: {{zz: 0.1}}}}")
        joints.append(_hinge(f"A{k}", "ground", f"bar{k}", k, 0))
        loads.append(f"  - {{type: spring, joint: A{k}, coordinate: theta, stiffness: {30 + k}}}")
    for k in range(loops):
        at = f"[{k + 0.5}, 1, 0]"
        links.append(f"  rod{k}: {{mass: 1, center_of_mass: {at}, inertia: {{zz: 0.1}}}}")
        joints.append(_hinge(f"B{k}", f"bar{k}", f"rod{k}", k, 1))
        joints.append(_ball(f"C{k}", f"rod{k}", f"bar{k + 1}", k + 1))
    return _text(links, joints, [], loads, ["A0"])


def four_bars(loops: int) -> str:
    """Four-bars in a row, each of one freedom, with springs from rod to rod."""
    links, joints, loads = [], [], ["  - {type: gravity, g: [0, -9.81, 0]}"]
    points = []
    for k in range(loops):
        x = 3 * k
        for name, at in (("a", x), ("b", x + 0.5), ("c", x + 1)):
            y = 1 if name == "b" else 0.5
            links.append(
                f"  {name}{k}: {{mass: 1, center_of_mass: [{at}, {y}, 0], inertia: {{zz: 0.1}}}}"
            )
        joints += [
            _hinge(f"A{k}", "ground", f"a{k}", x, 0),
            _hinge(f"B{k}", f"a{k}", f"b{k}", x, 1),
            _ball(f"C{k}", f"b{k}", f"c{k}", x + 1),
            _hinge(f"D{k}", "ground", f"c{k}", x + 1, 0),
        ]
        points.append(f"  p{k}: {{link: b{k}, at: [{x + 0.2}, 1, 0]}}")
        loads.append(f"  - {{type: spring, joint: A{k}, coordinate: theta, stiffness: {40 + k}}}")
        if k:
            # as long as drawn without force: the row is in balance
            loads.append(f"  - {{type: spring, between: [p{k - 1}, p{k}], stiffness: 20, free: 3}}")
    return _text(links, joints, points, loads, [f"A{k}" for k in range(loops)])


def _hinge(name: str, first: str, second: str, x: float, y: float) -> str:
    return (
        f"  {name}: {{type: R, links: [{first}, {second}], point: [{x}, {y}, 0], axis: [0, 0, 1]}}"
    )


def _ball(name: str, first: str, second: str, x: float) -> str:
    return f"  {name}: {{type: S, links: [{first}, {second}], point: [{x}, 1, 0]}}"


def _text(
    links: list[str], joints: list[str], points: list[str], loads: list[str], inputs: list[str]
) -> str:
    swept = ", ".join(f"{name}.theta: {{from: 0, to: 2, count: {ROWS}}}" for name in inputs)
    named = ["points:", *points] if points else []
    lines = ["format: 1", "links:", *links, "joints:", *joints, *named, "loads:", *loads]
    return "\n".join([*lines, f"motion: {{inputs: {{{swept}}}}}"])


def least(work: Callable[[], object]) -> float:
    times = []
    for _ in range(REPETITIONS):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return 1e3 * min(times)


def tell(kind: str, loops: int, text: str) -> None:
    model = mk.loads(text)
    efforts = [f"{name}.effort" for name in model.problem.mechanism.joints if name[0] == "A"]
    efforts = [name for name in efforts if name in model.quantities]
    result = model.analyze(efforts, tables=[]).result
    sweep = least(lambda: mk.loads(text).analyze(efforts, tables=[], threads=1))
    modes = least(lambda: Vibration(freed(result, 0, None, ())).frequencies)
    found = Vibration(freed(result, 0, None, ()))
    squares = scipy.linalg.eigh(found.stiffness, found.mass, eigvals_only=True)
    off = np.abs((2 * np.pi * found.frequencies) ** 2 / squares - 1).max()
    print(
        f"{loops:4} loops, {kind}: {len(found.frequencies)} modes in {modes:.1f} ms, "
        f"{modes / sweep:.2f} of file and sweep; eigenvalues off by {off:.0e}",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--loops", type=int, action="append")
    for loops in parser.parse_args().loops or (1, 10, 40):
        tell("one freedom", loops, ladder(loops))
        tell("a freedom each", loops, four_bars(loops))


if __name__ == "__main__":
    main()
