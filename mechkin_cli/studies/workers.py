"""Who computes the pieces of a study: this process, or workers behind an executor.

A task is a stretch of variants. Workers get few tasks at a time, so that memory does not grow with
the study. Where a worker dies, the tasks that it may have died of are tried again one by one, and
halved, until the one variant is found that kills it; that one is recorded, and the rest goes on.
Executors are new processes of this machine, or an existing Dask cluster (extra `cluster`).
"""

from __future__ import annotations

import logging
import multiprocessing
import os
import re
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import contextmanager
from importlib import import_module
from multiprocessing import resource_tracker
from typing import Any, TypeVar

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.record import NamedTuple

Result = TypeVar("Result")

LONGEST_REASON = 200

PER_WORKER = 2
"""Tasks that each worker has at a time: one that it computes, one that waits."""


class Task(NamedTuple):
    """Variants `begin` to `end` (without it) of a piece."""

    piece: int
    begin: int
    end: int

    @property
    def halves(self) -> tuple[Task, Task]:
        """The same variants in two tasks."""
        middle = (self.begin + self.end) // 2
        return self._replace(end=middle), self._replace(begin=middle)


def executed(
    tasks: Iterable[Task],
    submit: Callable[[Executor, Task], Future[Result]],
    lost: Callable[[Task], Result],
    executors: Executors,
    workers: int,
) -> Iterator[tuple[Task, Result]]:
    """The result of each task, in the order in which they end.

    Args:
        submit: hands a task to an executor.
        lost: the result of a single variant that its worker has died of.
        executors: they compute.
        workers: how many tasks they do at a time.

    Raises:
        UsageError: there are no workers any more.
        Exception: that of a task, unless its worker has died.
    """
    queue = deque(tasks)
    suspects: deque[Task] = deque()
    running: dict[Future[Result], Task] = {}

    def start(task: Task) -> None:
        try:
            running[submit(executors.current, task)] = task
        except (RuntimeError, OSError) as error:  # of which a broken executor's is one
            if not executors.renew():
                raise _gone(str(error)[:LONGEST_REASON] or type(error).__name__) from error
            running[submit(executors.current, task)] = task

    try:
        while queue or suspects or running:
            if suspects and not running:
                start(suspects.popleft())
            while queue and not suspects and len(running) < PER_WORKER * workers:
                start(queue.popleft())
            alone = len(running) == 1
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                task = running.pop(future)
                if future.cancelled():
                    raise _gone("what was handed to them has been cancelled")
                error = future.exception()
                if error is None:
                    yield task, future.result()
                elif not isinstance(error, BrokenExecutor) and not _is_to_blame(error):
                    raise error
                elif not (alone or _is_to_blame(error)):
                    suspects.append(task)
                elif task.end - task.begin > 1:
                    suspects.extendleft(reversed(task.halves))
                else:
                    yield task, lost(task)
    finally:
        for future in running:
            future.cancel()


class Executors:
    """An executor, and another one where it is broken.

    Args:
        first: the first.
        make: starts one; None: a broken one stays, and the study ends with it.
    """

    def __init__(self, first: Executor, make: Callable[[], Executor] | None = None) -> None:
        self.current = first
        self._make = make

    def renew(self) -> bool:
        """Starts another executor; False where there is none to be had."""
        if self._make is None:
            return False
        self.current.shutdown(wait=False, cancel_futures=True)
        self.current = self._make()
        return True


def _gone(reason: str) -> UsageError:
    return UsageError(
        f"the workers have gone away: {reason}; what they have computed is kept in the folder of "
        "results, and the same command goes on with it, on other workers or on none"
    )


def _is_to_blame(error: BaseException) -> bool:
    """Whether the task itself is to blame: a cluster has tried it on several workers."""
    return type(error).__name__ == "KilledWorker"


def processes(count: int) -> ProcessPoolExecutor:
    """An executor of so many new processes, which end with this one whatever ends it.

    Raises:
        UsageError: they end before they compute anything.
    """
    context = multiprocessing.get_context("spawn")
    executor = ProcessPoolExecutor(count, mp_context=context, initializer=_begin)
    try:
        executor.submit(os.getpid).result()
    except BrokenExecutor:
        raise UsageError(
            "new processes end before they compute anything; a script that starts them does its "
            'work below `if __name__ == "__main__":`, since each of them reads it, too'
        ) from None
    return executor


def end_without_warnings() -> None:
    """For a command that a signal ends at once: what is left of its pools is cleared away by
    Python's tracker, which is to do so without a warning on the command's stderr.

    Before the first pool; a tracker that runs already is left as it is.
    """
    if os.name != "posix":
        return  # no tracker elsewhere: nothing of pools outlives their processes
    own = "ignore::UserWarning:multiprocessing.resource_tracker"
    before = os.environ.get("PYTHONWARNINGS")
    os.environ["PYTHONWARNINGS"] = own if before is None else f"{before},{own}"
    try:
        resource_tracker.ensure_running()
    finally:
        if before is None:
            del os.environ["PYTHONWARNINGS"]
        else:
            os.environ["PYTHONWARNINGS"] = before


def _begin() -> None:
    """In a new process: Ctrl-C is for the first one, and its end is the end of all."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: multiprocessing.process.BaseProcess) -> None:
    parent.join()
    os._exit(1)


_ADDRESS = re.compile(
    r"inproc://\S+|(?:[a-z]+://)?(?:\[[0-9A-Fa-f:.]+(?:%\w+)?\]|[^\s:/\[\]]+):[0-9]{1,5}"
)

SECONDS = 10
"""How long a scheduler may take to answer."""


@contextmanager
def cluster(address: str, question: Callable[[], str]) -> Iterator[tuple[Executor, int, list[str]]]:
    """Connects to the scheduler at an address, such as tcp://host:8786.

    Returns:
        Its executor, how many tasks it does at a time, and what every worker answers to a call.

    Raises:
        UsageError: dask is not installed, nobody answers, there are no workers, or one of them
            cannot answer: it lacks the package.
    """
    if not _ADDRESS.fullmatch(address):
        raise UsageError(
            f"--scheduler {address[:LONGEST_NAME]}: expected an address such as tcp://host:8786, "
            "as `dask scheduler` prints it"
        )
    try:
        # by name: its functions have no types
        distributed: Any = import_module("distributed")
    except ImportError:
        raise UsageError("--scheduler needs dask: pip install 'mechkin[cluster]'") from None
    # a scheduler that has gone is reported in one sentence, not by its log
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = distributed.Client(address, timeout=SECONDS, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise UsageError(
            f"no scheduler answers at {address}: {str(error)[:200]}; start one with "
            "`dask scheduler`, and workers with `dask worker ADDRESS`"
        ) from None
    try:
        workers = sum(client.nthreads().values())
        if not workers:
            raise UsageError(
                f"the scheduler at {address} has no workers; start some with `dask worker "
                f"{address}`"
            )
        answers = client.run(question, on_error="return")
        for worker, answer in answers.items():
            if isinstance(answer, BaseException):
                raise UsageError(
                    f"the worker {worker} cannot run mechkin: {type(answer).__name__}: "
                    f"{str(answer)[:200]}; install the same version there"
                )
        yield client.get_executor(), workers, list(answers.values())
    finally:
        client.close()
