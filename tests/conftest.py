"""Tests import `benchmarks` from the repository's root, and mechkin from where it is installed."""

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

TOGETHER = ("tests/properties",)
"""Folders whose files read the same references, which take a minute: tested in one process."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """`--dist loadfile`, but a folder of `TOGETHER` counts as one file."""
    if config.getoption("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            folder = nodeid.partition("::")[0].rpartition("/")[0]
            return folder if folder in TOGETHER else super()._split_scope(nodeid)

    return Scheduling(config, log)
