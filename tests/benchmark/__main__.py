"""Run time against error, the yardstick, whole processes; with `--stress`, extreme cases.

    python tests/benchmark [--stress] [--json]

`mechkin bench` has what a row costs on a machine; here it is held against independent solutions, a
throw-away kernel in C and what engineers do by hand. Needs gcc for the yardstick.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from subprocess import CalledProcessError

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.append(str(HERE.parents[1]))

from benchmark import demand_steps, routes, stress, targets
from benchmark.exact import rcsr_specimen, sevenr_specimen
from benchmark.yardstick_kernel import Yardstick, load

from mechkin_cli.bench.report import ReportTable, machine, plain_text
from mechkin_cli.tables.json import json_text

RCSR_FILE = HERE.parents[1] / "mechanisms" / "dissertation" / "rcsr.yaml"


def timing_tables() -> Iterator[ReportTable]:
    """Routes, demand plan, and the targets as far as their programs are there."""
    specimens = (rcsr_specimen(), sevenr_specimen())
    yield from routes.tables(*specimens)
    yield from map(demand_steps.table, specimens)
    yardstick = load()
    if isinstance(yardstick, Yardstick):
        with yardstick:
            for specimen in specimens:
                yield targets.table(specimen, yardstick)
    else:
        print(f"left out: {yardstick}", file=sys.stderr)
    try:
        yield targets.process_table(RCSR_FILE)
    except CalledProcessError as error:
        print(f"left out: no whole processes, {error}", file=sys.stderr)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--stress", action="store_true", help="extreme sizes and positions")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args()
    tables = stress.tables() if options.stress else timing_tables()
    described = machine()
    if options.json:
        record = {"machine": described}
        print(json_text(record | {table.name: table.record() for table in tables}), end="")
        return
    print(", ".join(f"{name} {value}" for name, value in described.items()))
    for table in tables:
        print(f"\n{plain_text(table)}", end="", flush=True)


if __name__ == "__main__":
    main()
