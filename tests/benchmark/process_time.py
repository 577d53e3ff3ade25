"""Times whole processes: `mechkin analyze` against the bare imports of the libraries it is built
on, and against the same work written with Pinocchio.

    python tests/benchmark/process_time.py [--pinocchio PYTHON]

PYTHON is an interpreter with `pin` and `pyyaml`; left out, this one if it has them. Prints medians
and their ratios (limit for bare imports: 1.45), and how far Pinocchio's numbers are from mechkin's;
all start in turns, so that a slow moment meets each.
"""

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.append(str(HERE.parents[1]))

from benchmark.process import command
from benchmark.targets import process_table

from benchmarks import sevenr
from mechkin_cli.bench.report import plain_text

RCSR = HERE.parents[1] / "mechanisms" / "dissertation" / "rcsr.yaml"
PINOCCHIO = HERE / "pinocchio_7r.py"


def compared(python: str) -> bool:
    """Says how far Pinocchio's numbers are from mechkin's, or why it is left out."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "7r.yaml"
        file.write_text(sevenr.text(), encoding="utf-8")
        analyze = [*command(), "analyze", str(file), "--out", folder, "--quiet"]
        subprocess.run(analyze, check=True, stdout=subprocess.DEVNULL)
        table = str(Path(folder) / "everything.csv")
        line = [python, str(PINOCCHIO), str(file), folder, table]
        done = subprocess.run(line, capture_output=True, text=True, check=False)
    print(f"Pinocchio: {(done.stdout or done.stderr).strip()}")
    return done.returncode == 0


def main() -> None:
    python = sys.argv[2] if sys.argv[1:2] == ["--pinocchio"] else sys.executable
    peer = [python, str(PINOCCHIO), "FILE", "DIR"] if compared(python) else []
    print()
    print(plain_text(process_table(RCSR, peer)))
    print(f"timed: {' '.join(command())} analyze")


if __name__ == "__main__":
    main()
