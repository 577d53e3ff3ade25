"""Tests import `benchmarks` from the repository's root, and mechkin from where it is installed."""

import gc
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

# tests that are started in the background ignore interrupts, and so would the commands they run
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# behind everything else: the source folder of the package lies in the root, too
sys.path.append(str(Path(__file__).resolve().parents[1]))

# tens of thousands of tests stay to the end: they are searched for garbage neither while they are
# collected nor afterwards
gc.disable()


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.enable()


TOGETHER = {
    "tests/properties/": "references",
    "tests/view/test_live_page": "browser",
    "tests/view/test_page_": "browser",
}
"""Beginnings of files that share what is dear: references, a browser. Tested in one process."""

FIRST = (
    "browser",
    "tests/kernel/test_changed_sources.py",
    "references",
    "tests/hard_mechanisms/test_command.py",
    "tests/random_families/no_wrong_row/test_no_wrong_row.py",
    "tests/studies/test_cluster.py",
    "tests/studies/test_command.py",
    "tests/cli/test_progress.py",
    "tests/response/test_true_errors.py",
    "tests/response/test_kinks.py",
)
"""What takes longest is begun first: nothing long is left for one process at the end."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """`--dist loadfile`, with `TOGETHER` and `FIRST`."""
    if config.getoption("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            shared = (word for start, word in TOGETHER.items() if nodeid.startswith(start))
            return next(shared, None) or super()._split_scope(nodeid)

        def _assign_work_unit(self, node: Any) -> None:
            long = next((scope for scope in FIRST if scope in self.workqueue), None)
            if long is not None:
                self.workqueue.move_to_end(long, last=False)
            super()._assign_work_unit(node)

    return Scheduling(config, log)
