"""A few of the runs that `stopped_streams.py` stops by the hundred."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


def test_streamed_runs_are_stopped(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    from random_families.stopped_streams import stopped

    counts = stopped(20 * TIMES, 0, tmp_path)
    # when a signal comes goes by the machine: that some runs end, and some are stopped
    assert counts["new"] > 0
    assert counts["old"] > 2 * TIMES
