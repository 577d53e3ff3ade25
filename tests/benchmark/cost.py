"""Steps and times of sweeps, here against another version of mechkin in the same run.

    python -P tests/benchmark/cost.py --before PYTHON [--rounds N] [--random N] [--json]

PYTHON is an interpreter with the other version; left out, this one stands alone. Both take turns,
case by case; times are the least processor times. Generic mechanisms may cost 1.3 times as much as
before; near change points a turn may take 400 attempts for every gap that it meets. `--random` asks
for so many random mechanisms near change points besides the four-bars.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.append(str(HERE.parents[1]))

from benchmark.specimens import sevenr_specimen
from change_points.four_bars import FourBar, file_of, joints_of
from oracle.numerics import mp
from random_families.no_wrong_row.branch import TURN, Undecided, way
from random_families.no_wrong_row.case import drawn

from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, machine, plain_text
from mechkin_cli.tables.json import json_text

MECHANISMS = HERE.parents[1] / "mechanisms"
GENERIC = {"RCSR": "rcsr", "RCSR-CSR": "rcsr_csr", "RCHCH": "rchch", "Stewart": "stewart"}
RATIO = 1.3
ATTEMPTS = 400
GAPS = ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12")
MET = 1e-3
"""A discriminant (in parts of its scale) with a minimum below this is a gap met."""

COST = (
    ReportColumn("case", "case"),
    ReportColumn("before", "before", "time"),
    ReportColumn("after", "after", "time"),
    ReportColumn("unit", "unit"),
    ReportColumn("ratio", "ratio", "time"),
    ReportColumn("limit", "limit", "time"),
    ReportColumn("met", "met", "verdict"),
)


class Version:
    """A process that sweeps what it is given."""

    def __init__(self, python: str) -> None:
        line = [python, "-P", str(HERE / "follow_counter.py")]
        self.process = subprocess.Popen(
            line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd="/"
        )

    def measure(self, text: str, rounds: int) -> dict[str, float]:
        """Raises: RuntimeError where the process has ended."""
        assert self.process.stdin
        assert self.process.stdout
        self.process.stdin.write(json.dumps([text, rounds]) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError("the version that is compared has ended")
        found: dict[str, float] = json.loads(answer)
        return found


def generic() -> Iterator[tuple[str, str]]:
    for name, stem in GENERIC.items():
        yield name, (next(MECHANISMS.glob(f"*/{stem}.yaml"))).read_text(encoding="utf-8")
    yield "7R", sevenr_specimen().text("from: 0 deg, to: 360 deg, count: 361")


def in_turns(versions: dict[str, Version], text: str, rounds: int) -> dict[str, dict[str, float]]:
    """Least times of rounds in turns."""
    found: dict[str, dict[str, float]] = {}
    for _ in range(rounds):
        for name, version in versions.items():
            now, least = version.measure(text, 2), found.get(name)
            found[name] = now if least is None else {k: min(now[k], least[k]) for k in now}
    return found


def ratios(versions: dict[str, Version], rounds: int) -> ReportTable:
    """Generic mechanisms: steps, and times of following and of whole sweeps."""
    lines: list[dict[str, Cell]] = []
    for name, text in generic():
        found = in_turns(versions, text, rounds)
        for what, unit, scale in (
            ("steps", "", 1.0), ("attempts", "", 1.0), ("follow", "us", 1e6), ("sweep", "us", 1e6),
        ):  # fmt: skip
            before, after = (
                scale * found[v][what] if v in found else None for v in ("before", "after")
            )
            ratio = after / before if before and after is not None else None
            limit = RATIO if what in ("steps", "sweep") else None
            met = None if ratio is None or limit is None else ratio <= limit
            line = {"case": f"{name}, {what}", "before": before, "after": after, "unit": unit}
            lines.append({**line, "ratio": ratio, "limit": limit, "met": met})
    return ReportTable("generic", "generic mechanisms", COST, lines, ())


def near_change_point(gap: str, pairs: str, copies: int) -> str:
    """A crank-rocker, drawn several times over, that passes its change point by a gap."""
    rod = mp.mpf("0.5") + mp.mpf("2") - mp.mpf("1.1") + mp.mpf(gap)
    bar = FourBar("0.5", mp.nstr(rod, 20), "1.1", "2", 1)
    links, joints = ["crank"], ""
    for k in range(copies):
        links += [f"rod{k}", f"rocker{k}"]
        joints += joints_of(bar, "90", str(k), pairs, "crank")
    return file_of(links, joints, "{inputs: {A.theta: {from: 0, to: 360, step: 10}}}")


def four_bars(versions: dict[str, Version]) -> ReportTable:
    lines = []
    for gap in GAPS:
        for copies in (1, 2):
            cells = {
                name: max(
                    version.measure(near_change_point(gap, pairs, copies), 1)["attempts"]
                    for pairs in ("SS", "RR", "CS")
                )
                for name, version in versions.items()
            }
            what = f"gap {gap}" + (", drawn twice" if copies == 2 else "")
            lines.append(attempts_line(what, cells))
    return ReportTable("gaps", "most attempts a turn, four-bars with one gap", COST, lines, ())


def attempts_line(case: str, cells: dict[str, float]) -> dict[str, Cell]:
    before, after = cells.get("before"), cells["after"]
    ratio = after / before if before else None
    line: dict[str, Cell] = {"case": case, "before": before, "after": after, "unit": ""}
    return {**line, "ratio": ratio, "limit": ATTEMPTS, "met": after <= ATTEMPTS}


def gaps_met(number: int) -> tuple[str, int] | None:
    """A random mechanism for one turn, and how many gaps it meets; None if it does not turn."""
    case = drawn(number)
    try:
        one = way(case.drawing.linkage(), 1, TURN)
    except Undecided:
        return None
    met = sum(margin < MET for _, _, margin in one.critical)
    if one.folds is not None or not met:
        return None
    moving = f"A.theta: {case.travel.text}"
    whole = case.text.replace(moving, "A.theta: {from: 0, to: 360, step: 10}")
    return (whole.replace(case.travel.head, "") if case.travel.head else whole), met


def random_mechanisms(versions: dict[str, Version], count: int) -> ReportTable:
    """Attempts for every gap met in a turn, over mechanisms that turn fully."""
    found: dict[str, list[float]] = {name: [] for name in versions}
    for number in range(count):
        given = gaps_met(number)
        if given is None:
            continue
        for name, version in versions.items():
            found[name].append(version.measure(given[0], 1)["attempts"] / given[1])
    lines = []
    for what, part in (("median", 0.5), ("nine of ten below", 0.9), ("most", 1.0)):
        cells = {
            name: sorted(values)[math.ceil(part * len(values)) - 1]
            for name, values in found.items()
            if values
        }
        if cells:
            lines.append(attempts_line(f"{len(found['after'])} mechanisms, {what}", cells))
    return ReportTable("random", "attempts a turn for every gap met", COST, lines, ())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--before", metavar="PYTHON", help="interpreter with another version")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--random", type=int, default=0, metavar="N")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args()
    versions = {"before": Version(options.before)} if options.before else {}
    versions["after"] = Version(sys.executable)
    tables = [ratios(versions, options.rounds), four_bars(versions)]
    if options.random:
        tables.append(random_mechanisms(versions, options.random))
    if options.json:
        record = {"machine": machine()} | {table.name: table.record() for table in tables}
        print(json_text(record), end="")
        return
    print(", ".join(f"{name} {value}" for name, value in machine().items()))
    for table in tables:
        print(f"\n{plain_text(table)}", end="", flush=True)


if __name__ == "__main__":
    main()
