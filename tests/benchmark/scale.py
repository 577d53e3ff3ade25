"""Runs of any length: time and memory of sweeps of 10^2 to 10^8 rows as whole processes, beside
polars and pyarrow writing the same numbers, and what scale_parts.py measures; prints the tables of
docs/scale.md.

    python -P tests/benchmark/scale.py [--most ROWS] [--up-to NUMBER] [PART...] [--json]
    python -P tests/benchmark/scale.py --kernel [--most ROWS]
    python -P tests/benchmark/scale.py --text [--most ROWS]

Ten columns of RCSR: positions, rates, an effort and a reaction. Times are by the processor's
clock, as the machine may be shared. Slopes are of log time over log of what grows: of the last
step, and of the whole table. `--kernel`: what a run that keeps no rows takes in parts of its calls
of the kernel alone, and responses of a pendulum with as many rows. `--text`: CSV beside
std::to_chars of all its numbers on as many threads as there are processors, Parquet beside pyarrow
writing the arrays of both tables, by the processor's clock and by that on the wall.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

HERE = Path(__file__).resolve().parent
RCSR = HERE.parents[1] / "mechanisms" / "dissertation" / "rcsr.yaml"
COLUMNS = (
    *("O1.theta", "O2.theta", "O4.theta", "O4.theta_dot", "O4.theta_ddot"),
    *("O1.effort", "O2.s", "O2.s_dot", "O4.force.x", "O4.force.y"),
)
PARTS = "rows", "loops", "coupled", "variants", "freedoms", "response-loops"
WAYS = {
    "csv": ["--format", "csv"],
    "parquet": ["--format", "parquet"],
    "summary only": ["--summary-only"],
}


def long_text(rows: int) -> str:
    """RCSR with so many rows over its range, and one table of ten columns."""
    text = RCSR.read_text(encoding="utf-8")
    motion = r"(\{from: [^,]*, to: [^,]*, )step: [^,}]*"
    text = re.split(r"(?m)^tables:", re.sub(motion, rf"\1count: {rows}", text, count=1))[0]
    columns = "".join(f"      - {{label: c{k}, value: {one}}}\n" for k, one in enumerate(COLUMNS))
    return f"{text}tables:\n  - name: t\n    columns:\n{columns}"


def cost(command: Sequence[str]) -> tuple[float, float]:
    """Seconds of the processor and megabytes at most of a process."""
    pid = os.posix_spawn(command[0], command, dict(os.environ))
    _, status, usage = os.wait4(pid, 0)
    if status:
        raise SystemExit(f"{' '.join(command)} failed")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0


PEERS = """
import json, sys
from time import process_time
import polars, pyarrow.parquet as parquet

def timed(work):
    start = process_time()
    work()
    return process_time() - start

table = parquet.read_table(sys.argv[1] + "/t.parquet")
frame = polars.from_arrow(table)
csv = timed(lambda: frame.write_csv(sys.argv[1] + "/peer.csv"))
own = sys.argv[1] + "/peer.parquet"
print(json.dumps([csv, timed(lambda: parquet.write_table(table, own, compression="zstd"))]))
"""
"""In a process of its own: the memory of a process counts for those that it begins."""


def peers(folder: Path) -> tuple[float, float]:
    """Seconds that polars and pyarrow take to write the table that stands in a folder."""
    command = [sys.executable, "-P", "-c", PEERS, str(folder)]
    found = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    csv, parquet = json.loads(found)
    return csv, parquet


MOST_HELD = 10**7
"""Rows of which the peers, which hold all numbers, are measured."""


def measured(most: int) -> list[dict[str, float | None]]:
    """A line for each number of rows."""
    lines = []
    for rows in (10**k for k in range(2, round(math.log10(most)) + 1)):
        line: dict[str, float | None] = {"rows": rows}
        with TemporaryDirectory() as name:
            folder = Path(name)
            path = folder / "rcsr.yaml"
            path.write_text(long_text(rows), encoding="utf-8")
            for way, options in WAYS.items():
                program = [sys.executable, "-P", "-m", "mechkin_cli", "analyze", str(path)]
                out = ["--quiet", "--out", str(folder / way.split()[0])]
                line[way], line[f"{way} MB"] = cost([*program, *options, *out])
            line["polars csv"] = line["pyarrow parquet"] = None
            if rows <= MOST_HELD:
                line["polars csv"], line["pyarrow parquet"] = peers(folder / "parquet")
        lines.append(line)
        print(json.dumps(line), file=sys.stderr, flush=True)
    return lines


PENDULUM = """format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{bob: {{mass: 1, center_of_mass: [0, -1], inertia: 0}}}}
joints: {{O: {{type: R, links: [ground, bob], point: [0, 0]}}}}
loads: [{{type: gravity, g: [0, -9.80665]}}]
responses: {{swing: {{start: {{O.theta: 1}}, time: {{from: 0, to: 10, count: {rows}}}}}}}
tables:
  - {{name: t, run: swing, columns: [time, O.theta, O.theta_dot, row.energy_error]}}
"""

INSIDE = """
import sys
from time import process_time
from mechkin_cli.session import Session
from mechkin_cli.__main__ import main

spent = [0.0]

def timed(work):
    def call(*args, **named):
        start = process_time()
        try:
            return work(*args, **named)
        finally:
            spent[0] += process_time() - start
    return call

Session.run, Session.follow_rows = timed(Session.run), timed(Session.follow_rows)
try:
    main()
except SystemExit as ended:
    assert not ended.code
print(spent[0], process_time())
"""
"""A command in a process of its own, and the seconds that it spends in calls of the kernel, and in
all."""


def inside(text: str, folder: Path) -> tuple[float, float]:
    """Seconds of the kernel and of all in a run that keeps no rows."""
    path = folder / "own.yaml"
    path.write_text(text, encoding="utf-8")
    words = ["analyze", str(path), "--summary-only", "--quiet", "--out", str(folder / "o")]
    command = [sys.executable, "-P", "-c", INSIDE, *words]
    found = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    kernel, whole = map(float, found.split())
    return kernel, whole


def beside_the_kernel(rows: int) -> str:
    """What peaks alone take in parts of the kernel's calls; and responses, by their rows."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        start = min(inside(long_text(100), folder)[1] for _ in range(3))
        kernel, whole = min(inside(long_text(rows), folder) for _ in range(3))
        said = [
            f"RCSR, {rows:,} rows, peaks alone: {whole:.2f} s, {start:.2f} of them to start; the "
            f"kernel {kernel:.2f} s; behind the start {(whole - start) / kernel:.2f} times that"
        ]
        for count in (rows // 10, rows):
            path = folder / "p.yaml"
            path.write_text(PENDULUM.format(rows=count), encoding="utf-8")
            program = [sys.executable, "-P", "-m", "mechkin_cli", "analyze", str(path)]
            for way, options in WAYS.items():
                out = ["--quiet", "--out", str(folder / "r")]
                seconds, megabytes = cost([*program, *options, *out])
                said.append(f"response, {count:,} rows, {way}: {seconds:.2f} s, {megabytes:.0f} MB")
    return "\n".join(said)


WRITTEN = """
import subprocess, sys
from pathlib import Path
from time import perf_counter, process_time
import numpy as np
from pyarrow import parquet

here, folder, threads = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
sys.path[:0] = [str(here.parent)]
from kernel.compiler import compile_with

tables = [parquet.read_table(path) for path in sorted(folder.glob("parquet/*.parquet"))]
start = process_time(), perf_counter()
for number, table in enumerate(tables):
    parquet.write_table(table, folder / f"{number}.peer", compression="zstd")
print(process_time() - start[0], perf_counter() - start[1])
numbers = [c.to_numpy() for t in tables for c in t.columns if str(c.type) in ("double", "int64")]
numbers = np.nan_to_num(np.stack(numbers, axis=1).astype(float))
numbers.tofile(folder / "numbers")
program = compile_with(here / "to_chars.cpp", folder / "to_chars", "-O3", "-pthread")
words = [str(program), str(folder / "numbers"), str(numbers.size), threads, "3"]
found = subprocess.run(words, capture_output=True, check=True, text=True).stdout.splitlines()
print(min(found, key=lambda line: float(line.split()[1])))
"""
"""In a process of its own, as `PEERS`."""


def beside_to_chars(rows: int) -> str:
    """What CSV and Parquet take in parts of what their numbers take elsewhere."""
    said = []
    with TemporaryDirectory() as name:
        folder = Path(name)
        took: dict[tuple[str, int], tuple[float, float]] = {}
        for count in (100, rows):
            path = folder / f"{count}.yaml"
            path.write_text(long_text(count), encoding="utf-8")
            for way in ("csv", "parquet"):
                program = [sys.executable, "-P", "-m", "mechkin_cli", "analyze", str(path)]
                begun = perf_counter()
                own = cost([*program, *WAYS[way], "--quiet", "--out", str(folder / way)])[0]
                took[way, count] = own, perf_counter() - begun
        threads = str(len(os.sched_getaffinity(0)))
        words = [sys.executable, "-P", "-c", WRITTEN, str(HERE), str(folder), threads]
        found = subprocess.run(words, capture_output=True, text=True, check=True).stdout
        peers = dict(zip(("parquet", "csv"), found.splitlines(), strict=True))
        for way, peer in (("csv", "to_chars"), ("parquet", "pyarrow")):
            clocks = []
            for clock, word in enumerate(("of the processor", "on the wall")):
                behind = took[way, rows][clock] - took[way, 100][clock]
                other = float(peers[way].split()[clock])
                clocks.append(
                    f"{behind:.2f} s {word}, {behind / other:.2f} times {peer}'s {other:.2f} s"
                )
            said.append(f"{rows:,} rows, {way}, behind the start: {'; '.join(clocks)}")
    return "\n".join(said)


def page(lines: Sequence[dict[str, float | None]]) -> str:
    """The table, as docs/scale.md has it."""
    heads = ["rows"]
    for way in WAYS:
        heads += [f"{way}, s", "MB"]
    heads += ["polars `write_csv`, s", "pyarrow, zstd, s"]
    found = [f"| {' | '.join(heads)} |", f"|{'---|' * len(heads)}"]
    for line in lines:
        cells = [f"{line['rows']:,.0f}"]
        for way in WAYS:
            cells += [f"{line[way]:.2f}", f"{line[f'{way} MB']:.0f}"]
        others = (line["polars csv"], line["pyarrow parquet"])
        cells += ["-" if one is None else f"{one:.2f}" for one in others]
        found.append(f"| {' | '.join(cells)} |")
    return "\n".join([*found, "", slopes(lines, "rows", list(WAYS))])


def slopes(lines: Sequence[dict[str, float]], by: str, names: Sequence[str]) -> str:
    """On log-log paper, from the line before to the last, and over all."""

    def slope(one: str, first: dict[str, float]) -> str:
        last = lines[-1]
        if not first[one] or not last[one]:
            return "-"
        return f"{math.log(last[one] / first[one]) / math.log(last[by] / first[by]):.2f}"

    if len(lines) < 2:
        return ""
    told = [f"{one} {slope(one, lines[-2])} ({slope(one, lines[0])})" for one in names]
    return f"Slopes of the last step (of all): {', '.join(told)}."


def part_page(lines: Sequence[dict[str, float]]) -> str:
    """The table of a part of scale_parts.py: what grows, then seconds."""
    by, *names = lines[0]
    counted = [name for name in names if name == "unknowns"]
    timed = [name for name in names if name not in counted]
    heads = [by, *counted, *(f"{name}, s" for name in timed)]
    found = [f"| {' | '.join(heads)} |", f"|{'---|' * len(heads)}"]
    for line in lines:
        cells = [f"{line[name]:,.0f}" for name in (by, *counted)]
        found.append(f"| {' | '.join([*cells, *(f'{line[name]:.2g}' for name in timed)])} |")
    return "\n".join([*found, "", slopes(lines, by, timed)])


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--most", type=float, default=1e7, help="rows of the longest run")
    parser.add_argument("--up-to", type=float, default=math.inf, help="of the other parts")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--kernel", action="store_true", help="peaks beside the kernel; responses")
    parser.add_argument("--text", action="store_true", help="CSV and Parquet beside their peers")
    parser.add_argument("parts", nargs="*", choices=[[], *PARTS], metavar="PART")
    options = parser.parse_args()
    if options.kernel:
        print(beside_the_kernel(round(options.most)))
        return
    if options.text:
        print(beside_to_chars(round(options.most)))
        return
    for name in options.parts or PARTS:
        if name == "rows":
            lines, shown = measured(round(options.most)), page
        else:
            # after the rows: the memory of this process would count for those that it begins
            sys.path[:0] = [str(HERE.parent), str(HERE.parents[1])]
            from benchmark import scale_parts

            part, most = scale_parts.PARTS[name]
            lines, shown = [], part_page
            for line in part(int(min(most, options.up_to))):
                lines.append(line)
                print(json.dumps(line), file=sys.stderr, flush=True)
        print(json.dumps({name: lines}) if options.json else f"{name}\n\n{shown(lines)}\n")


if __name__ == "__main__":
    main()
