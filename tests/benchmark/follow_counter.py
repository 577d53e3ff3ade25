"""Counts steps and times of sweeps for `cost.py`, in an interpreter with any version of mechkin.

Reads lines of JSON [text, rounds] from stdin and answers each with {"steps", "attempts", "follow",
"sweep"}: steps taken and tried of all ways that the kernel follows for one sweep, and the least
processor time, in seconds, of these ways and of the whole sweep.
"""

import json
import sys
from time import process_time

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel
from mechkin_cli.session import following as follow


class Counting:
    """Stands for the kernel where ways are followed."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.steps, self.attempts, self.seconds = 0, 0, 0.0

    def __getattr__(self, name: str) -> object:
        return getattr(_kernel, name)

    def follow_rows(self, *arguments: object) -> object:
        start = process_time()
        found = _kernel.follow_rows(*arguments)
        self.seconds += process_time() - start
        self.steps += found[2]
        self.attempts += found[2] + found[3]
        return found


def measured(text: str, rounds: int, kernel: Counting) -> dict[str, float]:
    ways, sweeps = [], []
    for _ in range(rounds):
        model = mk.loads(text)
        kernel.clear()
        start = process_time()
        model.analyze(tables=[])
        sweeps.append(process_time() - start)
        ways.append(kernel.seconds)
    return {
        "steps": kernel.steps,
        "attempts": kernel.attempts,
        "follow": min(ways),
        "sweep": min(sweeps),
    }


def main() -> None:
    kernel = Counting()
    follow._kernel = kernel  # the module's own name for the kernel
    for line in sys.stdin:
        text, rounds = json.loads(line)
        print(json.dumps(measured(text, rounds, kernel)), flush=True)


if __name__ == "__main__":
    main()
