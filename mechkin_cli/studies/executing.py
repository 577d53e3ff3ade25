"""Who computes the pieces of a study: this process, or workers behind an executor.

A task is a stretch of variants. Workers get few tasks at a time, so that memory does not grow with
the study. Where a worker dies, the tasks that it may have died of are tried again one by one, and
halved, until the one variant is found that kills it; that one is recorded, and the rest goes on.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from typing import Generic, NamedTuple, TypeVar

from mechkin_cli.diagnostics import UsageError

Found = TypeVar("Found")

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


class Work(Generic[Found]):
    """What is done with a task.

    Attributes:
        submit: hands it to an executor.
        lost: what is recorded of a single variant that its worker has died of.
    """

    def __init__(
        self,
        submit: Callable[[Executor, Task], Future[Found]],
        lost: Callable[[Task], Found],
    ) -> None:
        self.submit, self.lost = submit, lost


def executed(
    tasks: Iterable[Task], work: Work[Found], executors: Executors, workers: int
) -> Iterator[tuple[Task, Found]]:
    """What is found of each task, in the order in which they end.

    Raises:
        UsageError: there are no workers any more.
        Exception: that of a task, unless its worker has died.
    """
    queue = deque(tasks)
    suspects: deque[Task] = deque()
    running: dict[Future[Found], Task] = {}
    try:
        while queue or suspects or running:
            if suspects and not running:
                _submit(suspects.popleft(), work, executors, running)
            while queue and not suspects and len(running) < PER_WORKER * workers:
                _submit(queue.popleft(), work, executors, running)
            alone = len(running) == 1
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                task = running.pop(future)
                if future.cancelled():
                    raise _gone("what was handed to them has been cancelled")
                error = future.exception()
                if error is None:
                    yield task, future.result()
                elif not _is_death(error):
                    raise error
                elif not (alone or _is_certain(error)):
                    suspects.append(task)
                elif task.end - task.begin > 1:
                    suspects.extendleft(reversed(task.halves))
                else:
                    yield task, work.lost(task)
    finally:
        for future in running:
            future.cancel()


class Executors:
    """Gives an executor, and another one where the first is broken.

    Args:
        make: starts one; None: a broken one stays, and the study ends with it.
        given: the first.
    """

    def __init__(self, given: Executor, make: Callable[[], Executor] | None = None) -> None:
        self.current = given
        self._make = make

    def renew(self) -> bool:
        """Starts another executor; False where there is none to be had."""
        if self._make is None:
            return False
        self.current.shutdown(wait=False, cancel_futures=True)
        self.current = self._make()
        return True


def _submit(
    task: Task, work: Work[Found], executors: Executors, running: dict[Future[Found], Task]
) -> None:
    try:
        running[work.submit(executors.current, task)] = task
    except (RuntimeError, OSError) as error:  # of which a broken executor's is one
        if not executors.renew():
            raise _gone(str(error)[:LONGEST_REASON] or type(error).__name__) from error
        running[work.submit(executors.current, task)] = task


def _gone(reason: str) -> UsageError:
    return UsageError(
        f"the workers have gone away: {reason}; what they have computed is kept in the folder of "
        "results, and the same command goes on with it, on other workers or on none"
    )


def _is_death(error: BaseException) -> bool:
    """Whether a worker has died while it had the task."""
    return isinstance(error, BrokenExecutor) or _is_certain(error)


def _is_certain(error: BaseException) -> bool:
    """Whether the task itself is to blame: a cluster has tried it on several workers."""
    return type(error).__name__ == "KilledWorker"
