"""The peers of the benchmark are right: the kernel is timed against no straw men."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import references
from benchmark.accuracy import errors
from benchmark.arithmetic import Arithmetic, extended
from benchmark.closure import dead_centre, drawing, kinematics
from benchmark.dense_forces import equations
from benchmark.exact import rcsr_specimen, sevenr_specimen
from benchmark.kernel_case import KernelCase, PlannedRun, degree_rows
from benchmark.peers import Closure, dense_loads, differences, fsolve_positions
from benchmark.reference import (
    ACCELERATIONS,
    POSITIONS,
    VELOCITIES,
    row_by_row,
    solution,
)
from benchmark.stress import NEAR_DEAD_CENTRE, SIZES, dead_centre_table, size_table
from benchmark.yardstick_kernel import load
from oracle import fold, mp, read

from benchmarks.rcsr import COORDINATES, dimensions
from mechkin_cli.bench.measurement import SHORTEST, Timing, in_turns
from mechkin_cli.bench.report import ReportColumn, ReportTable, cell_text, plain_text
from mechkin_cli.kernel.functions import widths
from mechkin_cli.tape.double_double import eliminate

DOUBLE = Arithmetic("double", 2.0**-52, np.float64, np.cos, np.sin)
EXACT_MOTION = dict(
    zip(
        (*POSITIONS, *VELOCITIES, *ACCELERATIONS),
        ("theta2", "s2", "theta4", "omega2", "s2_dot", "omega4", "alpha2", "s2_ddot", "alpha4"),
        strict=True,
    )
)
SIZE = dimensions()
RCSR = rcsr_specimen()


def column(name):
    return np.array(references.exact("rcsr")[name], dtype=np.float64)


def vector(prefix):
    return np.stack([column(f"{prefix}_{axis}") for axis in "xyz"], axis=1)


def motion():
    """The published mechanism's exact motion, angles in rad."""
    found = {name: column(header) for name, header in EXACT_MOTION.items()}
    return found | {name: np.radians(found[name]) for name in ("O2.theta", "O4.theta")}


@pytest.fixture(scope="module")
def theta1():
    return np.radians(column("theta1"))


@pytest.fixture(scope="module")
def exact(theta1):
    known = motion()
    return solution(SIZE, theta1, [known[name] for name in COORDINATES])


def relative(found, wanted):
    return float(np.max(np.abs(found - wanted)) / np.max(np.abs(wanted)))


@pytest.mark.parametrize("name", EXACT_MOTION)
def test_reference_motion_is_that_of_the_40_digit_data(exact, name):
    assert relative(exact[name], motion()[name]) < 3e-15


def test_reference_loads_are_the_newton_euler_data(exact):
    a1 = np.array([1.0, 0.0, 0.0])
    a4 = np.array([np.cos(np.radians(15)), 0.0, -np.sin(np.radians(15))])
    crank = vector("ne_F41") + column("ne_FA1")[:, None] * a1
    rocker = vector("ne_F43") + column("ne_FA4")[:, None] * a4
    assert relative(exact["O1.force"], crank) < 1e-13
    assert relative(exact["O2.force"], vector("ne_F21")) < 1e-13
    assert relative(exact["O4.force"], rocker) < 1e-13
    assert relative(exact["O1.effort"], -column("ne_MIN")) < 1e-13
    # the data have moments about the ground origin, the reference about J.point
    point = np.array([-5.0, 0.0, 0.0])
    assert relative(exact["O1.moment"] + np.cross(point, crank), vector("ne_M41")) < 1e-13


def test_dense_system_in_double_precision_agrees(theta1, exact):
    known = motion()
    d = drawing(SIZE, DOUBLE)
    found = dense_loads(SIZE, d, kinematics(d, theta1, [known[name] for name in COORDINATES]))
    assert errors(RCSR, found, exact).loads < 1e-12


def test_dense_system_is_24_by_24_and_regular(theta1):
    known = motion()
    d = drawing(SIZE, DOUBLE)
    k = kinematics(d, theta1[:1], [known[name][:1] for name in COORDINATES])
    matrix, right = equations(SIZE, d, k).arrays(1, np.float64)
    assert matrix.shape == (1, 24, 24)
    assert right.shape == (1, 24)
    assert np.linalg.matrix_rank(matrix[0]) == 24


def test_fsolve_agrees(theta1, exact):
    start = np.array([motion()[name][0] for name in COORDINATES])
    found = fsolve_positions(Closure(drawing(SIZE, DOUBLE)), theta1, start)
    assert errors(RCSR, dict(zip(POSITIONS, found, strict=True)), exact).position < 1e-7


def test_differences_agree(theta1, exact):
    start = np.array([motion()[name][0] for name in COORDINATES])
    solved = partial(fsolve_positions, Closure(drawing(SIZE, DOUBLE)), start=start)
    found = errors(RCSR, differences(solved, theta1), exact)
    assert found.velocity < 1e-5
    assert found.acceleration < 1e-4


def test_mpmath_and_long_double_agree(exact, theta1):
    mpmath = pytest.importorskip("mpmath")
    context = mpmath.MPContext()
    context.dps = 40
    forty = Arithmetic("mpmath", 1e-40, context.mpf, context.cos, context.sin)
    rows = np.array([0, len(theta1) - 1])
    known = motion()
    found = row_by_row(SIZE, theta1[rows], [known[name][rows] for name in COORDINATES], forty)
    tolerance = 1e3 * extended().epsilon
    for name in (*POSITIONS, *VELOCITIES, *ACCELERATIONS, "O1.effort", "O2.force"):
        difference = np.asarray(found[name] - exact[name][rows], dtype=np.float64)
        scale = np.max(np.abs(np.asarray(exact[name][rows], dtype=np.float64)))
        assert np.max(np.abs(difference)) < tolerance * scale, name


def test_dead_centre_of_the_matrices():
    found = dead_centre(drawing(SIZE, extended()), NEAR_DEAD_CENTRE)
    guess = {name: mp.mpf(values[-1]) for name, values in motion().items()}
    guess["O1.theta"] = mp.radians(202)
    known, _ = fold(read(references.RCSR), "O1.theta", guess)
    # the oracle takes lengths such as 0.8 as written, the matrices as the nearest double
    assert abs(known - mp.mpf(str(found.theta1))) < 2**-52


def test_elimination_exchanges_rows():
    matrix = np.array([[[0.0, 2.0], [4.0, 0.0]], [[1.0, 1.0], [1.0, -1.0]]])
    right = np.array([[6.0, 8.0], [5.0, 1.0]])
    assert np.array_equal(eliminate(matrix, right), [[2.0, 3.0], [3.0, 2.0]])


@pytest.mark.parametrize("lanes", [0, *widths()])
@pytest.mark.parametrize("specimen", [rcsr_specimen(), sevenr_specimen()], ids=lambda s: s.name)
def test_timed_kernel_call_finds_what_is_right(specimen, lanes):
    case = KernelCase(specimen, degree_rows(specimen))
    wanted = specimen.solution(case.positions, [case.found[x] for x in specimen.coordinates])
    run = PlannedRun(case, specimen.levels[2])
    batch = run(case.inputs, case.second_order_guesses(), lanes=lanes)
    found = errors(specimen, run.quantities(batch), wanted)
    assert found.position < 1e-14
    assert found.velocity < 2e-14
    assert found.acceleration < 2e-14
    assert found.loads < 1e-12


@pytest.mark.parametrize("scaled", [rcsr_specimen, sevenr_specimen])
def test_sizes_keep_their_errors(scaled):
    rows = size_table(scaled, SIZES[::3], extended()).rows
    assert {row["status"] for row in rows} == {"ok"}
    assert max(row["position"] for row in rows) < 1e-14
    assert max(row["loads"] for row in rows) < 1e-12


def test_errors_near_the_dead_centre_grow_with_the_condition():
    for row in dead_centre_table(extended()).rows:
        assert row["status"] in ("ok", "near-singular")
        assert row["residual"] <= 1e-14
        # a handful of roundings, each moving the position by 2^-53 times the condition
        assert row["share"] < 5.0


def test_timing_takes_medians_and_ratios_round_by_round():
    fast, slow = Timing((1.0, 2.0, 9.0)), Timing((2.0, 4.0, 27.0))
    assert fast.median == 2.0
    assert slow.ratio(fast) == 2.0
    assert slow.ratio(fast, factor=4.0) == 0.5


class Clock:
    """A clock that goes on only where a call says how long it took, s."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def test_calls_are_timed_in_turns():
    clock, order = Clock(), []

    def call(name, seconds):
        order.append(name)
        clock.now += seconds

    calls = {"a": partial(call, "a", 2.0), "b": partial(call, "b", 1.0)}
    times = in_turns(calls, rounds=3, clock=clock)
    assert order[-6:] == list("ababab")
    assert times["a"].seconds == (2.0, 2.0, 2.0)
    assert times["b"].seconds == (1.0, 1.0, 1.0)


def test_short_calls_are_repeated_within_a_round():
    clock, order = Clock(), []

    def call(name, seconds):
        order.append(name)
        clock.now += seconds

    short = SHORTEST / 4.0
    calls = {"a": partial(call, "a", SHORTEST), "b": partial(call, "b", short)}
    times = in_turns(calls, rounds=2, clock=clock)
    assert order[-10:] == list("abbbbabbbb")
    assert times["b"].seconds == pytest.approx((short, short), rel=1e-9)


def test_tables_are_aligned():
    columns = (ReportColumn("name", "name"), ReportColumn("us", "time\nus", "time"))
    table = ReportTable(
        "t", "title", columns, [{"name": "one", "us": 0.0123}, {"name": "b", "us": None}]
    )
    assert plain_text(table) == "title\n\n       time\nname     us\none   0.012\nb\n"
    assert max(map(len, plain_text(replace(table, notes=())).splitlines())) == 11


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (0.07341, "time", "0.073"),
        (1280.4, "time", "1280"),
        (1.2345e-15, "error", "1.2e-15"),
        (0.034, "percent", "3"),
        (True, "verdict", "yes"),
        (None, "time", ""),
    ],
)
def test_cells(value, kind, text):
    assert cell_text(value, kind) == text


def test_a_machine_without_a_compiler_leaves_the_yardstick_out(monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert "no yardstick" in load()
