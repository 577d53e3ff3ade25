"""An existing Dask cluster as an executor (extra `cluster`)."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib import import_module
from typing import Any, NamedTuple

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError

_ADDRESS = re.compile(
    r"inproc://\S+|(?:[a-z]+://)?(?:\[[0-9A-Fa-f:.]+(?:%\w+)?\]|[^\s:/\[\]]+):[0-9]{1,5}"
)

SECONDS = 10
"""How long a scheduler may take to answer."""


class Cluster(NamedTuple):
    """A connected cluster: its executor, how many tasks it does at a time, and what each worker
    answers to a call."""

    executor: Executor
    workers: int
    client: Any

    def ask(self, question: Callable[[], str]) -> dict[str, str]:
        """What every worker answers, by its address.

        Raises:
            UsageError: one cannot answer: it lacks the package.
        """
        found = self.client.run(question, on_error="return")
        for worker, answer in found.items():
            if isinstance(answer, BaseException):
                raise UsageError(
                    f"the worker {worker} cannot run mechkin: {type(answer).__name__}: "
                    f"{str(answer)[:200]}; install the same version there"
                )
        return dict(found)


@contextmanager
def cluster(address: str) -> Iterator[Cluster]:
    """Connects to the scheduler at an address, such as tcp://host:8786.

    Raises:
        UsageError: dask is not installed, nobody answers, or there are no workers.
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
    # what it logs of a scheduler that has gone is told in one sentence
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
        yield Cluster(client.get_executor(), workers, client)
    finally:
        client.close()
