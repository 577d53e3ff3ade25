"""Radau IIA: its order, when it takes over, and what it has in common with the explicit method."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from kernel.closed_motions import PENDULUM, exact_pendulum, oscillator, wall
from kernel.forced import AUTOMATIC, EVENT, EXPLICIT, IMPLICIT, KINK, End, System

STIFFNESS, DAMPING, WEIGHT = 8e5, 4e4, 9.81
ROWS = [0.0, 0.1, 0.5, 2.0]


def spring_damper() -> System:
    """1 kg on a spring and a damper under its weight, with the damper's work; stiff by p."""
    return System(
        lambda t, x, v, w, side, p: (
            [WEIGHT - p[0] * (STIFFNESS * x[0] + DAMPING * v[0])],
            [p[0] * DAMPING * v[0] * v[0]],
            [],
            0.0,
        ),
        1, 1, (), 1,
    )  # fmt: skip


def exact_spring_damper(time: float, start: float) -> float:
    with mpmath.workdps(40):
        k, c = mpmath.mpf(STIFFNESS), mpmath.mpf(DAMPING)
        root = mpmath.sqrt(c * c / 4 - k)
        slow, fast = -k / (c / 2 + root), -c / 2 - root
        rest = mpmath.mpf(WEIGHT) / k
        # x - rest = a e^(slow t) + b e^(fast t) from rest at `start`
        b = (mpmath.mpf(start) - rest) / (1 - fast / slow)
        a = -b * fast / slow
        return float(rest + a * mpmath.exp(slow * time) + b * mpmath.exp(fast * time))


def test_order_of_steps() -> None:
    exact = exact_pendulum(4.0, 1.5, 1.0)
    errors = []
    for count in (20, 40, 80, 160):
        answer = PENDULUM.integrate(
            [0.0, 1.5], [0.0, 4.0], parameters=[1.0], tolerance=1e-12,
            fixed_step=4.0 / count, method=IMPLICIT,
        )  # fmt: skip
        errors.append(abs(answer.states[-1, 0, 0] - exact))
        assert answer.reports[0]["steps"] == count
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((slopes > 4.7) & (slopes < 5.3)), slopes


def test_it_takes_over_where_stability_alone_shortens_steps() -> None:
    start = 1e-3
    reports = {}
    for method in (EXPLICIT, AUTOMATIC):
        answer = spring_damper().integrate(
            [start, 0.0, 0.0], ROWS, parameters=[1.0], tolerance=1e-7, method=method
        )
        reports[method] = answer.reports[0]
        exact = [exact_spring_damper(t, start) for t in ROWS]
        assert np.abs(answer.states[:, 0, 0] - exact).max() < 1e-11
        # the damper takes what the weight and the spring give
        x, v, w = answer.states[-1, :, 0]
        rest = WEIGHT / STIFFNESS
        lost = 0.5 * STIFFNESS * ((start - rest) ** 2 - (x - rest) ** 2) - 0.5 * v * v
        assert abs(w - lost) < 1e-7 * lost
    assert not reports[EXPLICIT]["stiff"]
    assert reports[EXPLICIT]["evaluations"] > 1e5
    assert reports[AUTOMATIC]["stiff"]
    assert 0.0 < reports[AUTOMATIC]["stiff_from"] < 0.01
    assert reports[AUTOMATIC]["evaluations"] < 1600


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-10, 1e-12])
def test_it_does_not_take_over_elsewhere(tolerance: float) -> None:
    rows = np.linspace(0.0, 100.0, 11)
    for parameters in ([[0.0, 1.0, 400.0]], [[1e-8, 1e4, 1e-4]]):
        answer = PENDULUM.integrate([0.3, 0.0], rows, parameters=parameters, tolerance=tolerance)
        assert not any(report["stiff"] for report in answer.reports)


def test_a_stiff_lane_does_not_disturb_another() -> None:
    def run(parameters: list[float]) -> tuple[np.ndarray, list[dict[str, object]]]:
        answer = spring_damper().integrate([1e-3, 0.0, 0.0], ROWS, parameters=[parameters])
        return answer.states, answer.reports

    states, reports = run([1e-6, 1.0, 1e-4, 0.5])
    assert [report["stiff"] for report in reports] == [False, True, False, True]
    for lane, parameter in enumerate([1e-6, 1.0, 1e-4, 0.5]):
        alone, told = run([parameter])
        assert alone[:, :, 0].tobytes() == np.ascontiguousarray(states[:, :, lane]).tobytes()
        assert told == [reports[lane]]


def test_interpolated_rows() -> None:
    rows = np.linspace(0.0, 4.0, 4001)
    answer = PENDULUM.integrate(
        [0.0, 1.5], rows, parameters=[1.0], tolerance=1e-8, method=IMPLICIT, scales=[1.0, 0.5]
    )
    exact = [exact_pendulum(t, 1.5, 1.0) for t in rows[::40]]
    assert answer.inside > 3000
    assert np.abs(answer.states[::40, 0, 0] - exact).max() < 1e-7


def test_coupled_freedoms() -> None:
    """A chain of three with a stiff damper between each two: its middle moves as one body."""

    def rates(t, x, v, w, side, p):
        between = [1e5 * (v[k + 1] - v[k]) for k in range(2)]
        forces = [between[0], between[1] - between[0], -between[1]]
        return [f - a for f, a in zip(forces, x, strict=True)], [], [], 0.0

    answer = System(rates, 3).integrate([1.0, 0.5, 0.0, 0.0, 0.3, 0.9], [0.0, 10.0], tolerance=1e-9)
    assert answer.reports[0]["stiff"]
    mean = answer.states[-1, :, 0].reshape(2, 3).mean(axis=1)
    exact = [0.5 * np.cos(10.0) + 0.4 * np.sin(10.0), -0.5 * np.sin(10.0) + 0.4 * np.cos(10.0)]
    assert np.abs(mean - exact).max() < 1e-8


def test_events_and_kinks() -> None:
    answer = oscillator(EVENT, at=0.3).integrate(
        [0.0, 1.0, 0.0], [0.0, 20.0], tolerance=1e-9, method=IMPLICIT
    )
    first = np.arcsin(0.3)
    exact = sorted(
        [first + 2 * np.pi * k for k in range(4)] + [np.pi * (2 * k + 1) - first for k in range(3)]
    )
    for (_, _, _, time, state), t in zip(answer.events, exact, strict=True):
        assert abs(state[0] - 0.3) < 1e-13
        assert abs(time - t) < 1e-7
    system = System(lambda t, x, v, w, side, p: ([-side[0]], [], [x[0] + 0.0], 0.0), 1, 0, (KINK,))
    answer = system.integrate([0.0, 1.0], [0.0, 1.0, 2.0, 39.0], method=IMPLICIT)
    assert len(answer.events) == 19
    assert np.abs(answer.states[:, 0, 0] - [0.0, 0.5, 0.0, -0.5]).max() < 1e-11


def test_a_kink_on_the_way_of_a_stiff_lane() -> None:
    """A damper that is ten times as hard on one side, and pulls faster: the stiff lane ends a step
    there."""
    system = System(
        lambda t, x, v, w, side, p: (
            [-1e4 * (5.5 + 4.5 * side[0]) * (v[0] - (1.5 + 0.5 * side[0]))], [], [x[0] - 1.0], 0.0,
        ),
        1, 0, (KINK,),
    )  # fmt: skip
    answer = system.integrate([0.0, 0.0], [0.0, 0.5, 3.0], tolerance=1e-8)
    assert answer.reports[0]["stiff"]
    assert len(answer.events) == 1
    # v = 1 - exp(-1e4 t) until x = 1, then 2 - exp(-1e5 t)
    assert abs(answer.events[0][3] - 1.0001) < 1e-8
    assert np.abs(answer.states[1:, 0, 0] - [0.4999, 4.99979]).max() < 1e-8


def test_a_kink_that_bends_nothing_on_the_way_of_a_stiff_lane() -> None:
    """The same damper at the speed where it does nothing: no step ends at the kink."""
    system = System(
        lambda t, x, v, w, side, p: (
            [-1e4 * (5.5 + 4.5 * side[0]) * (v[0] - 1.0)], [], [x[0] - 1.0], 0.0,
        ),
        1, 0, (KINK,),
    )  # fmt: skip
    answer = system.integrate([0.0, 0.0], [0.0, 0.5, 3.0], tolerance=1e-8)
    assert answer.reports[0]["stiff"]
    assert not answer.events
    assert np.abs(answer.states[1:, 0, 0] - [0.4999, 2.9999]).max() < 1e-8


def test_a_fault_ends_its_lane_where_it_is() -> None:
    stuck, other = wall().integrate(
        [0.0, 1.0], [0.0, 0.5, 9.0], parameters=[[0.5, 2.0]], tolerance=1e-8, method=IMPLICIT
    ).reports  # fmt: skip
    assert (stuck["end"], stuck["fault"], stuck["rows"]) == (End.STUCK, 7, 2)
    assert abs(stuck["time"] - np.pi / 6) < 1e-6
    assert other["end"] == End.DONE
