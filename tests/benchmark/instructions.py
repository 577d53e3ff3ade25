"""Instructions per row, which no other load of the machine changes: needs `valgrind`.

    python -P tests/benchmark/instructions.py [RCSR] [7R] [--lanes 2|4] [--json]

Counts what a kernel call of 2048 rows takes with one part of the demand plan more at a time, what
following 361 rows takes, and what the yardstick takes for the same rows, at a width that valgrind
can run (not 8 lanes). The interpreter's share of a call is counted with it.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.append(str(Path(__file__).resolve().parents[2]))

from benchmark.demand_steps import steps
from benchmark.kernel_case import (
    BATCH,
    SWEEP_ROWS,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
    sweep_rows,
)
from benchmark.specimen import Specimen
from benchmark.specimens import rcsr_specimen, sevenr_specimen
from benchmark.targets import YARDSTICK_NAMES
from benchmark.yardstick_kernel import LEVELS, Yardstick

from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, plain_text
from mechkin_cli.plan.records import Demand
from mechkin_cli.session.following import follow
from mechkin_cli.tables.json import json_text

SPECIMENS = {"RCSR": rcsr_specimen, "7R": sevenr_specimen}
MARK = "getppid"
"""A function that nothing else calls: valgrind writes its counts whenever it is entered."""

COLUMNS = (
    ReportColumn("case", "case"),
    ReportColumn("instructions", "instructions\nper row", "count"),
    ReportColumn("rows", "rows\na call", "count"),
)


def calls(specimen: Specimen, lanes: int) -> dict[str, tuple[int, Callable[[], object]]]:
    """What is counted, by name: rows and the call."""
    coarse = KernelCase(specimen, degree_rows(specimen))
    fine = KernelCase(specimen, sweep_rows(specimen))
    inputs, guesses = repeated(coarse.inputs), repeated(coarse.second_order_guesses())
    found: dict[str, tuple[int, Callable[[], object]]] = {}
    planned = {name: PlannedRun(coarse, names, more) for name, names, more in steps(specimen)}
    planned["position, condition"] = PlannedRun(coarse, specimen.levels[0], Demand.CONDITION)
    for name, run in planned.items():
        found[name] = BATCH, partial(run, inputs, guesses, lanes=lanes)
    plan = PlannedRun(fine, specimen.levels[2]).plan
    start = np.ascontiguousarray(fine.states[:, 0])
    found["follow"] = SWEEP_ROWS, lambda: follow(plan, fine.inputs, start)
    return found


def run_marked(specimen: Specimen, lanes: int) -> None:
    """Runs each call between two marks, after once to warm up; prints names and rows."""
    with Yardstick() as yardstick:
        found = calls(specimen, lanes)
        case = yardstick.case(YARDSTICK_NAMES[specimen.name])
        for level, name in enumerate(LEVELS):
            found[f"yardstick: {name}"] = BATCH, case.call(lanes, level)
        for _, call in found.values():
            call()
            os.getppid()
            call()
            os.getppid()
    print(json.dumps({name: rows for name, (rows, _) in found.items()}))


def counted(name: str, lanes: int) -> dict[str, tuple[int, int]]:
    """Rows and instructions of each call.

    Raises:
        OSError: no valgrind.
        CalledProcessError: it failed.
    """
    with TemporaryDirectory(prefix="mechkin-instructions-") as folder:
        out = Path(folder) / "counts"
        command = [
            *("valgrind", "--tool=callgrind", f"--dump-before={MARK}"),
            f"--callgrind-out-file={out}",
            *(sys.executable, "-P", __file__, "--marked", name, "--lanes", str(lanes)),
        ]
        # a hash that differs from run to run would change the interpreter's share
        environment = os.environ | {"PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}
        done = subprocess.run(command, check=True, env=environment, capture_output=True, text=True)
        rows: dict[str, int] = json.loads(done.stdout)
        return {
            # a dump holds what was counted since the one before: every second is a call
            case: (count, total(Path(f"{out}.{2 * number + 2}")))
            for number, (case, count) in enumerate(rows.items())
        }


def total(dump: Path) -> int:
    """Instructions in a dump of callgrind."""
    for line in dump.read_text(encoding="utf-8").splitlines():
        if line.startswith("summary:"):
            return int(line.split()[1])
    raise ValueError(f"{dump} has no sum")


def table(name: str, lanes: int) -> ReportTable:
    """A specimen's counts."""
    lines: list[dict[str, Cell]] = [
        {"case": case, "instructions": round(instructions / rows), "rows": rows}
        for case, (rows, instructions) in counted(name, lanes).items()
    ]
    notes = (f"{lanes} lanes; each line of the demand plan computes all lines above it as well.",)
    return ReportTable(
        f"instructions_{name.lower()}", f"{name}: instructions", COLUMNS, lines, notes
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", choices=[[], *SPECIMENS], metavar="NAME")
    parser.add_argument("--lanes", type=int, choices=(2, 4), default=2)
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.add_argument("--marked", choices=list(SPECIMENS), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.marked:
        run_marked(SPECIMENS[options.marked](), options.lanes)
        return
    tables = [table(name, options.lanes) for name in options.names or SPECIMENS]
    if options.json:
        print(json_text({table.name: table.record() for table in tables}), end="")
        return
    for each in tables:
        print(f"\n{plain_text(each)}", end="")


if __name__ == "__main__":
    main()
