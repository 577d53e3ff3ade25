"""Times whole processes: `mechkin analyze` against a program of its stack that computes nothing.

    python tests/benchmark/process_time.py [FILE]

Prints medians and their ratio (limit 1.4); both start in turns, so that a slow moment meets both.
"""

import sys
from pathlib import Path

from mechkin_cli.benchmark.process import command
from mechkin_cli.benchmark.report import plain_text
from mechkin_cli.benchmark.targets import process_table

HERE = Path(__file__).resolve().parent
RCSR = HERE.parents[1] / "mechanisms" / "rcsr.yaml"


def main() -> None:
    file = Path(sys.argv[1]) if len(sys.argv) > 1 else RCSR
    print(plain_text(process_table(file, HERE / "do_nothing.py")))
    print(f"timed: {' '.join(command())} analyze {file}")


if __name__ == "__main__":
    main()
