"""Blocks shared among processes that end with the one that started them.

Each reads tasks as lines of JSON and answers with tallies; where its input ends, it ends.
"""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
from collections.abc import Iterable, Iterator
from queue import SimpleQueue
from threading import Thread
from time import monotonic
from typing import IO, NamedTuple

from benchmarks import ROOT
from benchmarks.stress.block import run_block
from benchmarks.stress.plan import Task
from benchmarks.stress.tally import Tally, of_record


class Done(NamedTuple):
    """A block, what became of it, and how long that took in s."""

    task: Task
    tally: Tally
    seconds: float


COMMAND = (sys.executable, "-m", "benchmarks.stress.worker")
"""Run in the folder of the package."""


def results(tasks: Iterable[Task], seed: int, processes: int) -> Iterator[Done]:
    """The tally of every task, in the order in which they are done."""
    if processes == 1:
        for task in tasks:
            start = monotonic()
            tally = run_block(task.family, seed, task.numbers)
            yield Done(task, tally, monotonic() - start)
        return
    waiting: Iterator[Task] = iter(tasks)
    done: SimpleQueue[tuple[int, str]] = SimpleQueue()
    with contextlib.ExitStack() as stack:
        workers = [stack.enter_context(_Worker(k, done)) for k in range(processes)]
        busy = sum(worker.give(next(waiting, None), seed) for worker in workers)
        while busy:
            number, line = done.get()
            if not line:
                raise RuntimeError("a process of the stress test ended before its answer")
            task, start = workers[number].given
            yield Done(task, of_record(json.loads(line)), monotonic() - start)
            busy -= not workers[number].give(next(waiting, None), seed)


class _Worker:
    """One process; its answers are put into a queue with its number, "" where it has ended."""

    def __init__(self, number: int, done: SimpleQueue[tuple[int, str]]) -> None:
        self.number = number
        self.done = done
        self.process = subprocess.Popen(
            COMMAND,
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )
        self.given = Task("", ()), 0.0
        Thread(target=self._read, args=(self.process.stdout,), daemon=True).start()

    def _read(self, answers: IO[str]) -> None:
        for line in answers:
            self.done.put((self.number, line))
        self.done.put((self.number, ""))

    def give(self, task: Task | None, seed: int) -> bool:
        """Whether there was a task to give."""
        if task is None:
            return False
        assert self.process.stdin is not None
        self.given = task, monotonic()
        self.process.stdin.write(json.dumps([task.family, seed, list(task.numbers)]) + "\n")
        self.process.stdin.flush()
        return True

    def __enter__(self) -> _Worker:
        return self

    def __exit__(self, *_: object) -> None:
        assert self.process.stdin is not None
        with contextlib.suppress(OSError):
            self.process.stdin.close()
        # a task that nobody waits for is not finished
        self.process.terminate()
        self.process.wait()
