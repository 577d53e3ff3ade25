"""How fast studies are: variants of 361 rows with forces, on a core and on two, and their memory.
Where other work is on the machine, the share of the one thread tells what two cores would gain.
With CasADi installed (extra `bench`), beside them the same rows by Newton's method as compiled C.

    python -P tests/benchmark/studies.py [--variants 10000]

CasADi finds positions, rates and accelerations of one variant, whose dimensions are constants of
its code, again and again; it finds no forces, reduces nothing and writes nothing. The seconds in
which its code is compiled do not count.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from time import perf_counter, process_time, thread_time
from typing import Any

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))

import mechkin_cli as mk
from benchmarks import rcsr, sevenr
from mechkin_cli.bench.scene import BenchScene

ROWS = 361
ROUNDS = 3
PEER_CALLS = 20
"""Variants of CasADi in a round."""

MICRO, MILLI, MEGA = 1e6, 1e3, 1024.0

PIECES, COLUMNS, TASKS = 20, 10, 2000
"""Pieces that are written, their columns, and tasks that do nothing."""


@dataclass(frozen=True)
class Case:
    """A mechanism, what varies in it and what is kept of it."""

    name: str
    text: str
    vary: dict[str, Any]
    keep: list[dict[str, Any]]

    def study(self, count: int) -> dict[str, Any]:
        """Of so many variants."""
        return {"vary": self.vary, "keep": self.keep, "sample": {"count": count}}


def varied_seven_r() -> str:
    """The 7R with two of its joints at places that vary."""
    text = sevenr.text(f"from: 0 deg, to: 360 deg, count: {ROWS}")
    for number, name in ((2, "a"), (5, "b")):
        x, *others = sevenr.LINES[number - 1].point
        was = f"point: {[x, *others]}"
        assert was in text
        text = text.replace(was, f"point: [{x} m + {name}, {others[0]}, {others[1]}]")
    return text.replace("links:\n", "parameters: {a: 0 m, b: 0 m}\nlinks:\n", 1)


def cases() -> tuple[Case, ...]:
    """RCSR up to its dead centre, and a full turn of a 7R."""
    return (
        Case(
            "RCSR",
            rcsr.dimensions().text(f"from: 150 deg, to: 200 deg, count: {ROWS}"),
            {"P1": {"between": ["0.49 m", "0.51 m"]}, "P2": {"tolerance": "0.01 m"}},
            [{"of": "O1.effort", "as": ["peak", "rms"]}, {"of": "norm(O4.force)", "as": "max"}],
        ),
        Case(
            "7R",
            varied_seven_r(),
            {"a": {"tolerance": "5 mm"}, "b": {"tolerance": "5 mm"}},
            [{"of": "J1.effort", "as": ["peak", "rms"]}, {"of": "norm(J7.force)", "as": "max"}],
        ),
    )


def peer(case: Case) -> Callable[[], None] | None:
    """Some variants by CasADi."""
    if find_spec("casadi") is None:
        return None
    from benchmarks.peers.with_casadi import methods

    scene = BenchScene(case.name, mk.loads(case.text, case.name), most_places=ROWS)
    assert scene.rows == ROWS
    found = next(m for m in methods(scene) if m.level == "motion")

    def call() -> None:
        for _ in range(PEER_CALLS):
            found.call()

    return call


def seconds(call: Callable[[], object]) -> float:
    """Of one call."""
    begin = perf_counter()
    call()
    return perf_counter() - begin


def measured(case: Case, count: int, compared: Callable[[], None] | None) -> str:
    """A line for so many variants, timed in turns."""
    model = mk.loads(case.text, case.name)

    def into_folder(threads: int) -> None:
        with tempfile.TemporaryDirectory() as folder:
            model.study(case.study(count), folder, threads=threads)

    into_folder(2)  # what is built once
    whole, alone = process_time(), thread_time()
    into_folder(2)
    serial = (thread_time() - alone) / (process_time() - whole)
    taken: dict[str, list[float]] = {"one": [], "two": [], "peer": []}
    for _ in range(ROUNDS):
        taken["one"].append(seconds(lambda: into_folder(1)))
        taken["two"].append(seconds(lambda: into_folder(2)))
        if compared is not None:
            taken["peer"].append(seconds(compared) / PEER_CALLS * count)
    one, two = min(taken["one"]), min(taken["two"])
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / MEGA
    line = (
        f"{case.name}: {count} variants of {ROWS} rows: {one:.3g} s on a core "
        f"({one / count * MICRO:.0f} us each), {one / two:.2f} times that on two, of which the "
        f"thread that hands out pieces and writes computes {serial:.1%}; {memory:.0f} MB"
    )
    if compared is None:
        return line
    return f"{line}; CasADi {min(taken['peer']) / one:.2f} times as long, without forces"


def writing() -> str:
    """What the process that writes takes for a piece of ten columns."""
    from mechkin_cli.studies.folder import StudyFolder
    from mechkin_cli.studies.formats import Csv, Heading
    from mechkin_cli.studies.study import MOST_IN_PIECE

    generator = np.random.default_rng(1)
    values = {f"c{k}": generator.normal(size=MOST_IN_PIECE) for k in range(COLUMNS)}
    headings = tuple(Heading(label) for label in values)
    variants, tables = PIECES * MOST_IN_PIECE, {"variants": headings}
    with (
        tempfile.TemporaryDirectory() as name,
        StudyFolder(Path(name), {}, variants, tables, Csv(), MOST_IN_PIECE) as folder,
    ):
        folder.begin()
        taken = [seconds(partial(folder.put, k, {"variants": values})) for k in folder.pieces]
        joined = seconds(folder.finish) / PIECES
    return (
        f"a piece of {MOST_IN_PIECE} variants and {COLUMNS} columns: {MILLI * median(taken):.1f} ms"
        f" to write (flushed to the disk), {MILLI * joined:.1f} ms to put together at the end"
    )


def scheduling() -> str:
    """What a Dask scheduler on this machine takes for a task that does nothing."""
    from distributed import Client, LocalCluster, as_completed

    with (
        LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        client.submit(abs, -1).result()
        taken = seconds(
            lambda: list(as_completed(client.submit(abs, k, pure=False) for k in range(TASKS)))
        )
    return f"a task of Dask: {MILLI * taken / TASKS:.2f} ms"


def main() -> None:
    """Prints a line for a tenth of the variants, and for all."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--variants", type=int, default=10_000)
    count = parser.parse_args().variants
    print(writing())
    if find_spec("distributed") is not None:
        print(scheduling())
    for case in cases():
        for part in (count // 10, count):
            print(measured(case, part, None), flush=True)
    # afterwards, so that the memory of a peer is not counted as ours
    for case in cases():
        compared = peer(case)
        if compared is not None:
            print(measured(case, count // 10, compared), flush=True)


if __name__ == "__main__":
    main()
