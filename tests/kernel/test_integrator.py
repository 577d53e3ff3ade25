"""Integration in time against closed forms, and what a lane owes to its neighbours: nothing."""

from __future__ import annotations

import numpy as np
import pytest
from kernel.closed_motions import PENDULUM, exact_pendulum, oscillator, wall
from kernel.forced import BORDER, EVENT, EXPLICIT, IMPLICIT, KINK, NOT_FINITE, STOP, End, System

ROWS = [0.0, 1.0, 2.0, 10.0]


def test_oscillator_and_its_quadrature() -> None:
    answer = oscillator().integrate([0.0, 1.0, 0.0], ROWS, tolerance=1e-12)
    for t, (x, v, w) in zip(ROWS, answer.states[:, :, 0], strict=True):
        assert abs(x - np.sin(t)) < 1e-11
        assert abs(v - np.cos(t)) < 1e-11
        assert abs(w - (t / 2 + np.sin(2 * t) / 4)) < 1e-11


@pytest.mark.parametrize("rate", [0.1, 1.0, 1.99])
def test_pendulum(rate: float) -> None:
    rows = np.linspace(0.0, 20.0, 21)
    answer = PENDULUM.integrate([0.0, rate], rows, parameters=[1.0], tolerance=1e-13)
    exact = [exact_pendulum(t, rate, 1.0) for t in rows]
    assert np.abs(answer.states[:, 0, 0] - exact).max() < 2e-11


@pytest.mark.parametrize("scales", [[1.0], [2.0], [1.0, 2.0, 0.3]])
def test_charts_change_no_answer(scales: list[float]) -> None:
    rows = np.linspace(0.0, 20.0, 401)
    answer = PENDULUM.integrate([0.0, 1.0], rows, parameters=[1.0], tolerance=1e-11, scales=scales)
    exact = [exact_pendulum(t, 1.0, 1.0) for t in rows]
    assert answer.inside > 200
    assert np.abs(answer.states[:, 0, 0] - exact).max() < 1e-9


def test_order_of_steps() -> None:
    exact = exact_pendulum(4.0, 1.5, 1.0)
    errors = []
    for count in (14, 28, 56):
        answer = PENDULUM.integrate(
            [0.0, 1.5], [0.0, 4.0], parameters=[1.0], fixed_step=4.0 / count
        )
        errors.append(abs(answer.states[-1, 0, 0] - exact))
        assert answer.reports[0]["evaluations"] == 1 + 12 * count
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((slopes > 7.4) & (slopes < 8.6)), slopes


@pytest.mark.parametrize(
    ("method", "tolerances", "least"),
    [(EXPLICIT, (1e-6, 1e-9), 7.0), (IMPLICIT, (1e-5, 1e-8), 3.5)],
)
def test_order_of_interpolation(method: int, tolerances: tuple[float, float], least: float) -> None:
    rows = np.linspace(0.0, 6.0, 1201)
    exact = [exact_pendulum(t, 1.5, 1.0) for t in rows[::10]]
    steps, errors = [], []
    for tolerance in tolerances:
        answer = PENDULUM.integrate(
            [0.0, 1.5], rows, parameters=[1.0], tolerance=tolerance, method=method
        )
        assert answer.inside > 950
        steps.append(answer.reports[0]["steps"])
        errors.append(np.abs(answer.states[::10, 0, 0] - exact).max())
        assert errors[-1] < 3.0 * tolerance
    assert np.log(errors[0] / errors[1]) / np.log(steps[1] / steps[0]) > least


def test_steps_are_those_of_another_implementation() -> None:
    from scipy.integrate import DOP853

    other = DOP853(
        lambda t, y: np.array([y[1], -np.sin(y[0])]), 0.0, [0.0, 1.5], 4.0, max_step=0.5,
        first_step=0.5, rtol=1.0, atol=1.0,
    )  # fmt: skip
    while other.status == "running":
        other.step()
    answer = PENDULUM.integrate([0.0, 1.5], [0.0, 4.0], parameters=[1.0], fixed_step=0.5)
    assert np.abs(answer.states[-1, :, 0] - other.y).max() < 1e-14


def test_steps_end_on_rows_unless_rows_are_denser() -> None:
    few = oscillator().integrate([0.0, 1.0, 0.0], np.linspace(0.0, 10.0, 11))
    many = oscillator().integrate([0.0, 1.0, 0.0], np.linspace(0.0, 10.0, 1001))
    assert few.inside == 0
    assert 900 < many.inside < 1000
    assert many.reports[0]["evaluations"] < 1.5 * few.reports[0]["evaluations"]


def test_events_to_rounding() -> None:
    answer = oscillator(EVENT, at=0.3).integrate([0.0, 1.0, 0.0], [0.0, 20.0], tolerance=1e-12)
    first = np.arcsin(0.3)
    times = sorted(
        [first + 2 * np.pi * k for k in range(4)] + [np.pi * (2 * k + 1) - first for k in range(3)]
    )
    assert [event[2] for event in answer.events] == [True, False] * 3 + [True]
    for (_, _, _, time, state), exact in zip(answer.events, times, strict=True):
        assert abs(state[0] - 0.3) < 4e-16 * 20
        assert abs(time - exact) < 1e-11


@pytest.mark.parametrize("depth", [1e-2, 1e-4, 1e-7])
def test_a_crossing_and_its_return_within_one_step(depth: float) -> None:
    answer = oscillator(EVENT, at=1.0 - depth).integrate(
        [0.0, 1.0, 0.0], [0.0, 3.0], tolerance=1e-11
    )
    first = np.arcsin(1.0 - depth)
    assert [event[2] for event in answer.events] == [True, False]
    assert abs(answer.events[0][3] - first) < 1e-10 / np.sqrt(depth)
    assert abs(answer.events[1][3] - (np.pi - first)) < 1e-10 / np.sqrt(depth)


def test_what_is_only_touched_from_afar_is_no_event() -> None:
    assert not oscillator(EVENT, at=1.0 + 1e-6).integrate([0.0, 1.0, 0.0], [0.0, 30.0]).events


def test_a_stop_ends_its_lane_alone() -> None:
    answer = oscillator(STOP, at=0.5).integrate([0.0, [1.0, 0.4], 0.0], [0.0, 0.3, 10.0])
    stopped, other = answer.reports
    assert (stopped["end"], stopped["which"], stopped["rows"]) == (End.STOPPED, 0, 2)
    assert abs(stopped["time"] - np.pi / 6) < 1e-10
    assert np.isnan(answer.states[2, 0, 0])
    assert (other["end"], other["rows"]) == (End.DONE, 3)


def test_steps_end_on_kinks() -> None:
    """x'' = -sign x: parabolas, which every step of the method has exactly."""
    system = System(lambda t, x, v, w, side, p: ([-side[0]], [], [x[0] + 0.0], 0.0), 1, 0, (KINK,))
    answer = system.integrate([0.0, 1.0], [0.0, 1.0, 2.0, 3.0, 39.0])
    assert len(answer.events) == 19
    for k, (_, _, rising, time, state) in enumerate(answer.events):
        assert rising is bool(k % 2)
        assert abs(time - 2.0 * (k + 1)) < 1e-11
        assert abs(state[0]) < 1e-13
    assert np.abs(answer.states[:, 0, 0] - [0.0, 0.5, 0.0, -0.5, -0.5]).max() < 1e-12
    assert answer.reports[0]["rejections"] == 0


def test_a_corner_costs_a_few_steps() -> None:
    """x'' = -(2 + sign x) x is two half periods."""
    system = System(
        lambda t, x, v, w, side, p: ([-(2.0 + side[0]) * x[0]], [], [x[0] + 0.0], 0.0),
        1,
        0,
        (KINK,),
    )
    period = np.pi * (1.0 + 1.0 / np.sqrt(3.0))
    answer = system.integrate([0.0, 1.0], [0.0, 5 * period], tolerance=1e-12)
    assert np.abs(answer.states[-1, :, 0] - [0.0, 1.0]).max() < 3e-11


def test_borders_move() -> None:
    """x'' = -k/10 from x = k to k + 1, as a table of steps has it."""
    system = System(
        lambda t, x, v, w, side, p: ([-0.1 * side[0]], [], [side[0] + 1.0 - x[0]], 0.0),
        1,
        0,
        (BORDER,),
    )
    answer = system.integrate([0.0, [1.5, 2.0]], [0.0, 1.0, 3.0])
    assert not answer.events
    for lane, speed in enumerate((1.5, 2.0)):
        k, time, v = 0, 0.0, speed
        while True:  # from border to border
            square = v * v - 0.2 * k
            needed = 1.0 / v if k == 0 else 10.0 * (v - np.sqrt(square)) / k
            if time + needed > 3.0:
                break
            k, time, v = k + 1, time + needed, np.sqrt(square)
        rest = 3.0 - time
        assert k > 2
        exact = [k + v * rest - 0.05 * k * rest**2, v - 0.1 * k * rest]
        assert np.abs(answer.states[2, :, lane] - exact).max() < 1e-12


def test_rates_may_jump_at_borders() -> None:
    """A ball that leaves the floor half as fast as it meets it: the bounces end at time 3."""
    system = System(
        lambda t, x, v, w, side, p: ([-2.0], [], [x[0] + 0.0 * side[0]], 0.0), 1, 0, (BORDER,)
    )
    answer = system.integrate([0.0, 1.5], [0.0, 2.0, 2.5, 2.9, 9.0], bounce=-0.5)
    exact = []
    for t in (2.0, 2.5, 2.9):
        begin, speed = 0.0, 1.5
        while begin + speed <= t:
            begin, speed = begin + speed, 0.5 * speed
        exact.append((speed - (t - begin)) * (t - begin))
    assert np.abs(answer.states[1:4, 0, 0] - exact).max() < 1e-12
    report = answer.reports[0]
    assert (report["end"], report["which"], report["rows"]) == (End.HELD, 0, 4)
    assert abs(report["time"] - 3.0) < 1e-6


@pytest.mark.parametrize("reach", [1.0, 0.3, 0.05])
def test_charts_of_small_reach_cost_few_refusals(reach: float) -> None:
    answer = oscillator().integrate([0.0, 1.0, 0.0], [0.0, 20.0], tolerance=1e-6, reach=reach)
    report = answer.reports[0]
    assert abs(answer.states[-1, 0, 0] - np.sin(20.0)) < 1e-5
    # the way is 4 in each of 3.2 turns
    assert report["steps"] < 3.0 * 4.0 * 3.2 / reach + 40
    assert report["rejections"] < 0.5 * report["steps"] + 10


def test_a_motion_that_a_kink_holds_is_told() -> None:
    """x'' = -sign v comes to rest at time 1, where both sides lead back."""
    system = System(lambda t, x, v, w, side, p: ([-side[0]], [], [v[0] + 0.0], 0.0), 1, 0, (KINK,))
    report = system.integrate([0.0, [1.0, 100.0]], [0.0, 5.0]).reports
    assert (report[0]["end"], report[0]["which"], report[0]["rows"]) == (End.HELD, 0, 1)
    assert abs(report[0]["time"] - 1.0) < 1e-12
    assert report[1]["end"] == End.DONE


def test_two_switches_at_one_place() -> None:
    system = System(
        lambda t, x, v, w, side, p: ([-side[0], -side[1]], [], [x[0] + 0.0, x[1] + 0.0], 0.0),
        2,
        0,
        (KINK, KINK),
    )
    answer = system.integrate([0.0, 0.0, 1.0, 1.0], [0.0, 3.0, 9.0])
    assert [event[1] for event in answer.events] == [0, 1] * 4
    assert np.abs(answer.states[:, :2, 0] - [[0.0], [-0.5], [0.5]]).max() < 1e-12


def test_an_event_that_rests_at_its_zero_goes_on() -> None:
    assert oscillator(EVENT).integrate([0.0, 0.0, 0.0], [0.0, 10.0]).reports[0]["end"] == End.DONE


def test_a_fault_ends_its_lane_where_it_is() -> None:
    answer = wall().integrate([0.0, 1.0], [0.0, 0.5, 9.0], parameters=[[0.5, 2.0]])
    stuck, other = answer.reports
    assert (stuck["end"], stuck["fault"], stuck["rows"]) == (End.STUCK, 7, 2)
    assert abs(stuck["time"] - np.pi / 6) < 1e-10
    assert stuck["evaluations"] < 600
    alone = wall().integrate([0.0, 1.0], [0.0, 0.5, 9.0], parameters=[2.0])
    assert answer.states[:, :, 1].tobytes() == alone.states[:, :, 0].tobytes()
    assert other == alone.reports[0]


def test_rates_that_are_no_numbers() -> None:
    system = System(lambda t, x, v, w, side, p: ([x[0] / p[0]], [], [], 0.0), 1, 0, (), 1)
    first, second = system.integrate([0.0, 1.0], [0.0, 1.0], parameters=[[0.0, 1.0]]).reports
    assert (first["end"], first["fault"], first["rows"]) == (End.STUCK, NOT_FINITE, 0)
    assert second["end"] == End.DONE


def test_the_limit_of_steps() -> None:
    report = oscillator().integrate([0.0, 1.0, 0.0], [0.0, 1e3], most_steps=50).reports[0]
    assert report["end"] == End.STEP_LIMIT
    assert report["steps"] + report["rejections"] == 50


def test_a_fixed_step_that_meets_a_fault_is_stuck() -> None:
    report = wall().integrate([0.0, 1.0], [0.0, 9.0], parameters=[0.5], fixed_step=0.1).reports[0]
    assert (report["end"], report["fault"], report["steps"]) == (End.STUCK, 7, 5)


def test_lanes_owe_nothing_to_their_neighbours() -> None:
    rng = np.random.default_rng(5)
    squares, rates = rng.uniform(0.1, 30.0, 13), rng.uniform(0.1, 9.0, 13)
    rows = [0.0, 0.7, 0.71, 0.72, 0.73, 0.74, 5.0]

    def run(which: list[int]) -> tuple[np.ndarray, list[dict[str, object]]]:
        answer = PENDULUM.integrate([0.0, rates[which]], rows, parameters=[squares[which]])
        return answer.states, answer.reports

    states, reports = run(list(range(13)))
    for which in ([12, 0, 5], [7], [3, 3, 3, 3, 3, 3, 3, 3, 3]):
        part, told = run(which)
        assert part.tobytes() == np.ascontiguousarray(states[:, :, which]).tobytes()
        assert told == [reports[k] for k in which]


@pytest.mark.parametrize(
    "change",
    [{"rows": [0.0, 2.0, 1.0]}, {"rows": [0.0, np.nan]}, {"start": 3.0}, {"tolerance": 0.0},
     {"scales": [0.0]}, {"most_steps": 0}, {"method": 3}, {"dense_rows": 0}, {"least_step": -1.0}],
)  # fmt: skip
def test_what_is_no_integration_is_refused(change: dict[str, object]) -> None:
    with pytest.raises(ValueError):  # noqa: PT011
        oscillator().integrate([0.0, 1.0, 0.0], **{"rows": [0.0, 1.0]} | change)
