"""Rows over threads: the same bytes for every count, in any number of callers, after a fork."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from functools import cache
from typing import Any

import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel import _kernel, functions as width
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.outputs import OutputPlan, Readout
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.plan.records import Demand
from mechkin_cli.session.kernel_run import Ask, Batch, RowInputs, run

MOTION = Demand.VELOCITY | Demand.ACCELERATION | Demand.JERK
EVERYTHING = MOTION | Demand.FORCES | Demand.CONDITION | Demand.POWER
COUNTS = [1, 2, 3, 7, 64]


@cache
def case(name: str) -> tuple[Any, np.ndarray]:
    model = mk.load(FILE_OF[name])
    layout = Layout(model.problem.mechanism, model.graph)
    own = OutputPlan(layout, build_plan(layout), model.problem.motion.driven)
    for wanted in model.problem.quantities().values():
        own.add(wanted)
    return own, np.array([item.values[0] for item in model.problem.motion.inputs])


def computed(name: str, rows: int, threads: int) -> Batch:
    """Rows near the drawing, some of which do not close: their bytes count as well."""
    own, first = case(name)
    generator = np.random.default_rng(5)
    inputs = first[:, None] + generator.uniform(-0.3, 0.3, (first.size, rows))
    guess = generator.uniform(-0.5, 0.5, (own.plan.states, rows))
    rates, accelerations, jerks = generator.uniform(-1, 1, (3, first.size, rows))
    return run(
        own.plan,
        RowInputs(inputs, guess, rates, accelerations, jerks),
        Ask(EVERYTHING, Readout(own.outputs, own.slots, ()), derivatives=True),
        threads=threads,
    )


def assert_same_bytes(found: Batch, expected: Batch) -> None:
    for name, array in expected._asdict().items():
        if isinstance(array, np.ndarray):
            assert getattr(found, name).tobytes() == array.tobytes(), name


@pytest.mark.parametrize("threads", COUNTS[1:])
@pytest.mark.parametrize("rows", [1, 63, 64, 65, 1001])
@pytest.mark.parametrize("name", ["rcsr", "sevenr", "parallelogram"])
def test_the_same_bytes_for_every_count(name: str, rows: int, threads: int) -> None:
    assert_same_bytes(computed(name, rows, threads), computed(name, rows, 1))


def test_one_plan_runs_in_several_callers_at_once() -> None:
    expected = computed("rcsr", 1001, 1)
    found: list[Batch] = []

    def call(threads: int) -> None:
        found.extend(computed("rcsr", 1001, threads) for _ in range(5))

    callers = [threading.Thread(target=call, args=(1 + k % 3,)) for k in range(6)]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    assert len(found) == 30
    for batch in found:
        assert_same_bytes(batch, expected)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_a_forked_child_has_threads_of_its_own() -> None:
    program = (
        "import os, sys\n"
        "from kernel.test_threads import assert_same_bytes, computed\n"
        "expected = computed('rcsr', 1001, 4)\n"
        "child = os.fork()\n"
        "assert_same_bytes(computed('rcsr', 1001, 4), expected)\n"
        "if child:\n"
        "    sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n"
    )
    path = os.pathsep.join(p for p in sys.path if p)
    environment = os.environ | {"PYTHONPATH": path}
    command = [sys.executable, "-P", "-c", program]
    subprocess.run(command, check=True, env=environment, timeout=60)


def test_few_rows_are_not_worth_a_thread() -> None:
    processors = _kernel.available_processors()
    assert width.threads_for(2 * tolerances.THREAD_ROWS - 1) == 1
    assert width.threads_for(2 * tolerances.THREAD_ROWS) == min(2, processors)
    assert width.threads_for(10**6) == processors
    assert width.threads_for(1, 3) == 3


def test_the_number_of_threads_may_be_forced() -> None:
    width.force_threads(1)
    try:
        assert width.threads_for(10**6) == 1
        assert width.threads_for(10**6, 2) == 2
    finally:
        width.force_threads(0)


@pytest.mark.parametrize("threads", [-1, 1025, 1.5, "2", True, None])
def test_a_wrong_number_of_threads_is_refused(threads: Any) -> None:
    with pytest.raises(UsageError, match="a whole number from 1 to 1024"):
        width.force_threads(threads)
