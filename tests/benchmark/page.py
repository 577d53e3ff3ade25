"""Makes `docs/validation.md` and its figure: everything that is measured, on this machine.

    python -P tests/benchmark/page.py [--quick] [--out FOLDER]

`python -m benchmarks` on the known mechanisms, then the yardstick at every width (needs gcc), whole
processes, and the same 7R table by a script with Pinocchio where it is installed. Run it on an
otherwise idle machine; it takes about five minutes.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from subprocess import CalledProcessError

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent))
sys.path.append(str(HERE.parents[1]))

from benchmark import targets
from benchmark.script_table import script_table
from benchmark.specimens import rcsr_specimen, sevenr_specimen
from benchmark.yardstick_kernel import Yardstick, load

from benchmarks.peers import FAMILIES
from benchmarks.scenes import known_scenes
from benchmarks.suite import whole_tables
from mechkin_cli.bench.report import ReportTable, csv_text, figure, machine, page
from mechkin_cli.bench.runs import FULL, QUICK, bench

RCSR_FILE = ROOT / "mechanisms" / "dissertation" / "rcsr.yaml"
PINOCCHIO = HERE / "pinocchio_7r.py"
COMMAND = "python -P tests/benchmark/page.py"


SCRIPT_RUNS, QUICK_RUNS = 11, 1


def against(runs: int) -> Iterator[ReportTable]:
    """The yardstick, and whole processes; scripts of other libraries in so many rounds."""
    yardstick = load()
    if isinstance(yardstick, Yardstick):
        with yardstick:
            for specimen in (rcsr_specimen(), sevenr_specimen()):
                yield targets.table(specimen, yardstick)
    else:
        print(f"left out: {yardstick}", file=sys.stderr)
    peer = [sys.executable, "-P", str(PINOCCHIO), "FILE", "DIR"] if find_spec("pinocchio") else []
    try:
        yield targets.process_table(RCSR_FILE, peer)
    except CalledProcessError as error:
        print(f"left out: no whole processes, {error}", file=sys.stderr)
    yield script_table(runs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="few rounds, rougher")
    parser.add_argument("--out", type=Path, default=ROOT / "docs", help="the folder")
    options = parser.parse_args()
    rounds = QUICK if options.quick else FULL
    known = known_scenes()
    benches = []
    for scene in known:
        print(scene.name, file=sys.stderr, flush=True)
        benches.append(bench(scene, rounds, FAMILIES))
    print("settings, variants, responses, yardstick, processes", file=sys.stderr, flush=True)
    found = [
        *whole_tables(known, rounds),
        *against(QUICK_RUNS if options.quick else SCRIPT_RUNS),
    ]
    text = page(machine(), benches, found, "bench.svg", COMMAND)
    for name, content in {
        "validation.md": text,
        "bench.svg": figure(benches),
        "bench.csv": csv_text(benches),
    }.items():
        (options.out / name).write_text(content, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
