"""The same bits for every width of the packs, any cut of the batch, any neighbours of a row.

They do not depend on the caller's floating-point state or on the machine's libraries either.
"""

from __future__ import annotations

import ctypes
import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
from references import RCSR

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel, functions
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.outputs import OutputPlan, Readout
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.plan.records import Demand
from mechkin_cli.search.search import assemblies
from mechkin_cli.session.assembled_places import solver_graph
from mechkin_cli.session.following import follow
from mechkin_cli.session.kernel_run import Ask, Batch, RowInputs, run

MOTION = Demand.VELOCITY | Demand.ACCELERATION | Demand.JERK
EVERYTHING = MOTION | Demand.FORCES | Demand.CONDITION | Demand.POWER
ROWS = 61
# closed at the S, at an R, at the C: plans without and with quaternions, blocks of 3, 4 and 5
CLOSED_AT = ["O3", "O4", "O2"]

pytestmark = pytest.mark.parametrize("closed_at", CLOSED_AT)


def width(lanes: int) -> Any:
    missing = lanes > _kernel.widest
    reason = f"this machine has packs of {_kernel.widest} lanes at most"
    return pytest.param(lanes, marks=pytest.mark.skipif(missing, reason=reason))


@dataclass(frozen=True)
class Rows:
    """Inputs, rates, accelerations, jerks (inputs, rows) and guesses (states, rows)."""

    inputs: np.ndarray
    rates: np.ndarray
    accelerations: np.ndarray
    jerks: np.ndarray
    guess: np.ndarray

    def take(self, rows: Any) -> Rows:
        return Rows(*(np.ascontiguousarray(array[:, rows]) for array in vars(self).values()))


@cache
def rcsr(closed_at: str) -> tuple[Any, Rows]:
    """The RCSR mechanism, all its quantities, guesses so unlike that Newton needs 1 to 5 steps."""
    problem = mk.load(RCSR).problem
    graph = solver_graph(problem.mechanism, problem.motion.driven, [closed_at])
    layout = Layout(problem.mechanism, graph)
    plan = build_plan(layout)
    outputs = OutputPlan(layout, plan, problem.motion.driven)
    for wanted in problem.quantities().values():
        outputs.add(wanted)
    inputs = np.linspace(2.7, 3.4, ROWS)[None, :]
    followed = follow(plan, inputs, assemblies(layout, plan, inputs[:, 0]).states[:, 0])
    assert followed.reached == ROWS
    generator = np.random.default_rng(2)
    guess = followed.guess
    for carrier in layout.carriers:
        if carrier.part.letter != "S":
            guess[carrier.state] += 10.0 ** generator.uniform(-14, -2, ROWS)
    rates, accelerations, jerks = generator.uniform(-1, 1, (3, 1, ROWS))
    return outputs, Rows(inputs, rates, accelerations, jerks, guess)


def compute(own: Any, rows: Rows, lanes: int = 0) -> Batch:
    return run(
        own.plan,
        RowInputs(rows.inputs, rows.guess, rows.rates, rows.accelerations, rows.jerks),
        Ask(EVERYTHING, Readout(own.outputs, own.slots, ()), derivatives=True),
        lanes=lanes,
    )


def assert_same_bits(found: Batch, expected: Batch, rows: Any = slice(None)) -> None:
    """Every array of `found` holds the bytes of the chosen rows of `expected`."""
    for name, array in expected._asdict().items():
        assert (getattr(found, name) is None) is (array is None), name
        if isinstance(array, np.ndarray):
            assert getattr(found, name).tobytes() == array[..., rows].tobytes(), name


def test_rows_take_different_numbers_of_steps(closed_at: str) -> None:
    """Otherwise frozen lanes would go untested."""
    own, rows = rcsr(closed_at)
    steps = set()
    for row in range(ROWS):
        one = rows.take([row])
        tests = (1e-16, 1e-9, 1e-14)
        closed = [
            run(own.plan, RowInputs(one.inputs, one.guess), Ask(iterations=k, tests=tests))
            for k in range(7)
        ]
        good = [batch.good[0] for batch in closed]
        steps.add(good.index(True))
    assert len(steps) >= 3


@pytest.mark.parametrize("lanes", [width(2), width(4), width(8)])
def test_widths(closed_at: str, lanes: int) -> None:
    own, rows = rcsr(closed_at)
    assert_same_bits(compute(own, rows, lanes), compute(own, rows, 2))


@pytest.mark.parametrize("lanes", [width(2), width(4), width(8)])
@pytest.mark.parametrize("size", [1, 2, 3, 5, 7, 8, 13, ROWS])
def test_pieces_of_a_batch(closed_at: str, lanes: int, size: int) -> None:
    own, rows = rcsr(closed_at)
    whole = compute(own, rows)
    for begin in range(0, ROWS, size):
        piece = slice(begin, begin + size)
        assert_same_bits(compute(own, rows.take(piece), lanes), whole, piece)


@pytest.mark.parametrize("lanes", [width(2), width(4), width(8)])
def test_order_of_the_rows(closed_at: str, lanes: int) -> None:
    own, rows = rcsr(closed_at)
    order = np.random.default_rng(5).permutation(ROWS)
    assert_same_bits(compute(own, rows.take(order), lanes), compute(own, rows), order)


@pytest.mark.parametrize("lanes", [width(2), width(4), width(8)])
def test_nonsense_in_the_neighbouring_rows(closed_at: str, lanes: int) -> None:
    """Rows that never converge, or are not even numbers, leave the others alone."""
    own, rows = rcsr(closed_at)
    spoilt = rows.take(slice(None))
    spoilt.guess[:, 1::3] = np.nan
    spoilt.inputs[:, 2::3] = 1e300
    found = compute(own, spoilt, lanes)
    whole = compute(own, rows)
    good = np.arange(0, ROWS, 3)
    for name, array in whole._asdict().items():
        if isinstance(array, np.ndarray):
            assert getattr(found, name)[..., good].tobytes() == array[..., good].tobytes(), name
    assert np.all(found.flags[1::3] != 0)


def test_repeated_calls(closed_at: str) -> None:
    own, rows = rcsr(closed_at)
    first = compute(own, rows)
    for _ in range(3):
        assert_same_bits(compute(own, rows), first)


@contextmanager
def floating_point_state(control: int) -> Iterator[None]:
    """MXCSR bits set beside the usual ones; the C library's fenv_t is 28 bytes and MXCSR."""
    library = ctypes.CDLL(None)
    usual = (ctypes.c_uint32 * 8)()
    assert library.fegetenv(usual) == 0
    changed = (ctypes.c_uint32 * 8)(*usual)
    changed[7] |= control
    library.fesetenv(changed)
    try:
        yield
        kept = (ctypes.c_uint32 * 8)()
        library.fegetenv(kept)
        state = kept[7] & control
    finally:
        library.fesetenv(usual)
    assert state == control, "the caller's state did not come back"


STATES = {
    "flush to zero": 0x8000,
    "denormals are zero": 0x0040,
    "round up": 0x4000,
    "round to zero": 0x6000,
}
X86_LINUX = platform.machine() == "x86_64" and sys.platform == "linux"


@pytest.mark.skipif(not X86_LINUX, reason="the layout of fenv_t is that of Linux on x86-64")
@pytest.mark.parametrize("control", STATES.values(), ids=list(STATES))
def test_floating_point_state_of_the_caller(closed_at: str, control: int) -> None:
    own, rows = rcsr(closed_at)
    expected = compute(own, rows)
    angles = np.array([5e-324, 1e-310, 0.3, 2.5, 1e300])
    sines = functions.sin(angles)
    with floating_point_state(control):
        found = compute(own, rows)
        found_sines = functions.sin(angles)
    assert_same_bits(found, expected)
    assert found_sines.tobytes() == sines.tobytes()


SCRIPT = """
import sys
import mechkin_cli as mk
from mechkin_cli.tables.csv import csv_bytes
analysis = mk.load(sys.argv[1]).analyze(closed_at=[sys.argv[2]])
for table in analysis.tables:
    sys.stdout.buffer.write(csv_bytes(table))
"""
MACHINES = {
    "no AVX2 and FMA in the C library": {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"},
    "an old machine for OpenBLAS": {"OPENBLAS_CORETYPE": "Nehalem"},
    "an old machine for NumPy": {
        "NPY_DISABLE_CPU_FEATURES": "FMA3 AVX2 AVX512F AVX512_SKX X86_V3 X86_V4"
    },
}


@cache
def tables_of(closed_at: str, machine: str | None) -> bytes:
    command = [sys.executable, "-P", "-c", SCRIPT, str(RCSR), closed_at]
    environment = os.environ | (MACHINES[machine] if machine else {})
    return subprocess.run(command, check=True, capture_output=True, env=environment).stdout


@pytest.mark.parametrize("machine", MACHINES)
def test_tables_on_other_machines(closed_at: str, machine: str) -> None:
    usual = tables_of(closed_at, None)
    assert usual.count(b"\n") >= 11 * 28
    assert tables_of(closed_at, machine) == usual
