"""What scale.py measures beside rows: loops, loops solved together, variants, freedoms and loops of
responses, each from few to many, beside what the same takes elsewhere.

A part is a generator of lines, each a number that grows and seconds of the processor by what they
are for. What is compared with: PyYAML's reader in C of the same text, a dense solution by LAPACK
of as many unknowns, the yardstick's C kernel (yardstick/kern.c), CasADi where it is installed, and
scipy's DOP853 with equations of motion in numpy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np
import yaml
from benchmark import studies
from benchmark.kernel_case import BATCH
from benchmark.yardstick_kernel import LEVELS, Yardstick, load
from response.points_on_bars import GRAVITY, points_on_bars
from structure.networks import scissors, windows

import mechkin_cli as mk
from benchmarks.rows_of_loops import LOOPS, text as falling

Line = dict[str, float]
ROUNDS = 3
ROWS = 100
"""Of a sweep of loops that are solved together."""
END = 10.0
"""Seconds of a response of loops."""
LONG_ROUND = 2.0
"""Seconds from which on one round is enough."""


def seconds(work: Callable[[], object]) -> float:
    """The best of some rounds, or the first of a long one."""
    best = float("inf")
    for _ in range(ROUNDS):
        start = process_time()
        work()
        best = min(best, process_time() - start)
        if best > LONG_ROUND:
            break
    return best


def loops(most: int) -> Iterator[Line]:
    """Four-bars in a row, each by itself: reading the file, and a sweep of three rows."""
    reader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    for count in powers(0, most):
        text = windows(count).plane_text
        line = {"loops": count, "load": seconds(partial(mk.loads, text))}
        line["run"] = seconds(mk.loads(text).analyze)
        line["PyYAML reads"] = seconds(partial(yaml.load, text, Loader=reader))
        yield line


def coupled(most: int) -> Iterator[Line]:
    """Scissors driven on top, whose loops are one system of equations."""
    for count in doubled(8, most):
        network = scissors(count)._replace(inputs=[f"M{count - 1}.theta"])
        text = network.plane_text.replace("to: 5, count: 3", f"to: 1, count: {ROWS}")
        model = mk.loads(text)
        model.analyze(["A0.theta"])  # what is made once
        matrix = np.random.default_rng(1).normal(size=(2 * count, 2 * count))
        yield {
            "storeys": count,
            "unknowns": 2 * count,
            f"{ROWS} rows": seconds(partial(model.analyze, ["A0.theta"])),
            f"LAPACK, {ROWS} dense solutions": ROWS
            * seconds(partial(np.linalg.solve, matrix, matrix[0])),
        }


def variants(most: int) -> Iterator[Line]:
    """RCSR, 361 rows with forces, peaks kept in a folder, on one thread; the rows alone in C."""
    case = next(one for one in studies.cases() if one.name == "RCSR")
    model = mk.loads(case.text)
    found = load()
    row = yardstick_row(found) if isinstance(found, Yardstick) else float("nan")
    peer = studies.peer(case)
    once = seconds(peer) / studies.PEER_CALLS if peer is not None else None
    for count in powers(2, most):

        def study(count: int = count) -> None:
            with TemporaryDirectory() as folder:
                model.study(case.study(count), folder, threads=1)

        line = {"variants": count, "study": seconds(study)}
        line["C yardstick, rows alone"] = count * studies.ROWS * row
        if once is not None:
            line["CasADi, without forces"] = count * once
        yield line


def yardstick_row(yardstick: Yardstick) -> float:
    """Seconds of the yardstick for a row of RCSR with all forces, in its widest lanes."""
    with yardstick:
        call = yardstick.case("rcsr").call(max(yardstick.widths), len(LEVELS) - 1)
        return seconds(call) / BATCH


def freedoms(most: int) -> Iterator[Line]:
    """Chains of pendulums, one second of fall; scipy at the same tolerance."""
    for count in doubled(1, most):
        model = mk.loads(pendulums(count))
        respond = partial(model.respond, "fall", ["A0.theta"], threads=1)
        yield {
            "freedoms": count,
            "response": seconds(respond),
            "scipy DOP853, numpy": seconds(partial(fall_by_scipy, count)),
        }


def response_loops(most: int) -> Iterator[Line]:
    """Parallel cranks in a row, ten seconds of fall, apart from branch points and through them."""
    for count in (one for one in LOOPS if one <= most):
        line: Line = {"loops": count}
        for name, angle in (("fall", 3.0), ("through branch points", 1.0)):
            model = mk.loads(falling(count, angle, END))
            line[name] = seconds(partial(model.respond, "fall", ["A0.theta"], threads=1))
        yield line


def powers(first: int, most: int) -> Iterator[int]:
    """Powers of ten."""
    count = 10**first
    while count <= most:
        yield count
        count *= 10


def doubled(first: int, most: int) -> Iterator[int]:
    """Powers of two times the first."""
    count = first
    while count <= most:
        yield count
        count *= 2


TOLERANCE = 1e-9


def pendulums(count: int) -> str:
    """Points of 1 kg on massless bars of 1 m / count that lie level at first."""
    length = 1.0 / count
    links, joints = [], []
    for k in range(count):
        links.append(f"  b{k}: {{mass: 1, center_of_mass: [{(k + 1) * length!r}, 0]}}")
        before = f"b{k - 1}" if k else "ground"
        joints.append(f"  A{k}: {{type: R, links: [{before}, b{k}], point: [{k * length!r}, 0]}}")
    return "\n".join(
        [
            "format: 1\nplane: xy\nunits: {length: m, angle: rad}\nlinks:",
            *links,
            "joints:",
            *joints,
            f"loads: [{{type: gravity, g: [0, -{GRAVITY}]}}]",
            f"responses:\n  fall:\n    tolerance: {TOLERANCE}",
            f"    start: {{{', '.join(f'A{k}.theta: 0' for k in range(count))}}}",
            "    time: {from: 0, to: 1, step: 0.1}\n",
        ]
    )


def fall_by_scipy(count: int) -> np.ndarray:
    """The angles of the bars against the level after a second."""
    level = [0.5 * np.pi] * count
    return np.asarray(points_on_bars(level, (0.0, 1.0), TOLERANCE)[-1] - 0.5 * np.pi)


PARTS = {
    "loops": (loops, 10_000),
    "coupled": (coupled, 512),
    "variants": (variants, 1_000_000),
    "freedoms": (freedoms, 64),
    "response-loops": (response_loops, 160),
}
"""Each with how far it goes."""
