"""One process of a stress test: tasks come as lines of JSON, tallies go as lines of JSON."""

from __future__ import annotations

import json
import os
import signal
import sys
from queue import SimpleQueue
from threading import Thread
from typing import NoReturn

from benchmarks.stress.block import run_block


def main() -> NoReturn:
    """Answers until its input ends, and then ends at once."""
    # the process that started this one is asked; its end ends the input
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    tasks: SimpleQueue[str] = SimpleQueue()
    Thread(target=_read, args=(tasks,), daemon=True).start()
    while True:
        family, seed, numbers = json.loads(tasks.get())
        answer = run_block(family, seed, numbers).record()
        try:
            sys.stdout.write(json.dumps(answer) + "\n")
            sys.stdout.flush()
        except OSError:
            os._exit(1)


def _read(tasks: SimpleQueue[str]) -> NoReturn:
    """Nobody waits for the rest of a task once the input has ended."""
    for line in sys.stdin:
        tasks.put(line)
    os._exit(0)


if __name__ == "__main__":
    main()
