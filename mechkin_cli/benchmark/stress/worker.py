"""One process of a stress test: tasks come as lines of JSON, tallies go as lines of JSON."""

from __future__ import annotations

import json
import os
import signal
import sys

from mechkin_cli.benchmark.stress.block import run_block


def main() -> None:
    """Answers until its input ends."""
    # the process that started this one is asked; its end ends the input
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for line in sys.stdin:
        family, seed, numbers = json.loads(line)
        answer = run_block(family, seed, numbers).record()
        try:
            sys.stdout.write(json.dumps(answer) + "\n")
            sys.stdout.flush()
        except OSError:
            os._exit(1)


if __name__ == "__main__":
    main()
