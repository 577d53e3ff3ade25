"""What true errors cost: `python -P tests/benchmark/true_errors.py`.

Of two sweeps of the RCSR, 27 and 521 rows, and of a response: seconds of processor of the run, of
reading the text exactly (once a model) and of measuring all cells then, each the median of five;
ratios within one run count.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

import mechkin_cli as mk

MECHANISMS = Path(__file__).parents[2] / "mechanisms"
REPEATS = 5


def seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    """How long a call takes, and what it returns."""
    begin = process_time()
    found = call()
    return process_time() - begin, found


def costs(text: str, name: str, run: str) -> tuple[float, float, float]:
    """Seconds of a run, of reading its text exactly, and of measuring its errors then."""
    runs, reads, measured = [], [], []
    for _ in range(REPEATS):
        model = mk.loads(text, name)
        ask = model.analyze if run == "sweep" else lambda model=model: model.respond(run)
        ask()  # what is found once for a model
        taken, found = seconds(lambda ask=ask: (r := ask(), r.tables)[0])
        runs.append(taken)
        session = found.result.session if run == "sweep" else found.result.chosen
        reads.append(seconds(lambda session=session: session.precise)[0])
        measured.append(seconds(lambda found=found: found.errors)[0])
    return median(runs), median(reads), median(measured)


def scenes() -> list[tuple[str, str, str]]:
    """(name, text, run)."""
    rcsr = (MECHANISMS / "dissertation" / "rcsr.yaml").read_text(encoding="utf-8")
    dense = rcsr.replace("step: 2, rate", "step: 0.1, rate")
    assert dense != rcsr
    response = (MECHANISMS / "dissertation" / "rcsr_response.yaml").read_text(encoding="utf-8")
    return [
        ("rcsr", rcsr, "sweep"),
        ("rcsr, fine", dense, "sweep"),
        ("rcsr_response", response, "response"),
    ]


def main() -> int:
    print(f"{'':16}{'run':>10}{'text':>10}{'errors':>10}{'errors/run':>12}")
    for name, text, run in scenes():
        once, read, errors = costs(text, str(MECHANISMS / "dissertation" / name), run)
        print(f"{name:16}{once:10.4f}{read:10.4f}{errors:10.4f}{errors / once:12.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
