"""Motions through branch points: along the smooth continuation where `straight` asks for it, else
an end that says so."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from response.parallel_cranks import GRAVITY, CompoundPendulum, parallel_cranks
from scipy.integrate import solve_ivp

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths


def miss(found: Any, pendulum: CompoundPendulum) -> float:
    """By how much the rows come too early or late, s."""
    pairs = zip(found["A0.theta"], found["time"], strict=True)
    return max(abs(float(pendulum.time(float(x)) - mp.mpf(float(t)))) for x, t in pairs)


@pytest.mark.parametrize(("loops", "rate"), [(1, 5.0), (2, -30.0), (4, 9.0)])
def test_parallel_cranks_are_a_compound_pendulum(loops: int, rate: float) -> None:
    text = parallel_cranks(
        loops,
        f"start: {{A0.theta: 0, A0.theta_dot: {rate} rad/s}}",
        "time: {from: 0, to: 3, step: 0.125}",
        "tolerance: 1e-12",
    )
    found = mk.loads(text).respond("run")
    pendulum = CompoundPendulum(loops, rate)
    assert set(found["row.status"]) == {"ok"}
    assert miss(found, pendulum) < 1e-9
    for x, v in zip(found["A0.theta"], found["A0.theta_dot"], strict=True):
        assert abs(v - float(pendulum.rate_at(float(x)))) < 1e-9 * abs(v)
    assert np.max(np.abs(found[f"A{loops}.theta"] - found["A0.theta"])) < 1e-11
    assert np.max(found["row.energy_error"]) < 1e-9
    (note,) = (d for d in found.diagnostics if d.code == "branch-point-passed")
    assert note.severity == "note"
    first = np.copysign(np.pi / 2, rate)
    assert f"A0.theta = {first:.12g} rad; A0.theta = {3 * first:.12g} rad" in str(note)
    # each passing of the line was noted
    turned = abs(found["A0.theta"][-1])
    assert f"and {int(np.floor(turned / np.pi + 0.5)) - 4} more" in str(note)


@pytest.mark.parametrize("loops", [20, 40, 120])
def test_many_parallel_cranks_pass_at_once(loops: int) -> None:
    text = parallel_cranks(
        loops,
        "start: {A0.theta: 0, A0.theta_dot: 9 rad/s}",
        "time: {values: [0, 0.1, 0.2]}",
        "tolerance: 1e-12",
        flat=True,
    )
    found = mk.loads(text).respond("run")
    assert set(found["row.status"]) == {"ok"}
    assert found["A0.theta"][-1] > np.pi / 2
    assert miss(found, CompoundPendulum(loops, 9.0)) < 1e-11
    assert np.max(np.abs(found[f"A{loops}.theta"] - found["A0.theta"])) < 1e-12
    assert np.max(found["row.energy_error"]) < 1e-10


def test_rows_at_a_branch_point_and_next_to_it_are_there() -> None:
    pendulum = CompoundPendulum(1, 2.0)
    angles = [mp.pi / 2 + off for off in (-1e-3, -1e-6, 0, 1e-6, 1e-3)]
    times = ", ".join(mp.nstr(pendulum.time(angle), 17) for angle in angles)
    text = parallel_cranks(
        1,
        "start: {A0.theta: 0, A0.theta_dot: 2 rad/s}",
        f"time: {{values: [0, {times}]}}",
        "tolerance: 1e-12",
    )
    found = mk.loads(text).respond("run")
    for name in ("A0.theta", "A1.theta"):
        assert np.max(np.abs(found[name][1:] - [float(x) for x in angles])) < 2e-9
    status = [str(word) for word in found["row.status"]]
    assert status[3] in ("near-singular", "rank-unclear")
    assert status[:2] + status[5:] == ["ok"] * 3


def test_without_being_asked_it_ends_there_and_says_so() -> None:
    text = parallel_cranks(
        1,
        "start: {A0.theta: 0, A0.theta_dot: 2 rad/s}",
        "time: {from: 0, to: 2, step: 0.125}",
        straight=False,
    )
    found = mk.loads(text).respond("run")
    reached = CompoundPendulum(1, 2.0).time(mp.pi / 2)
    status = [str(word) for word in found["row.status"]]
    before = int(np.sum(found["time"] < float(reached)))
    assert status == ["ok"] * before + ["branch-lost"] * (17 - before)
    (end,) = (d for d in found.diagnostics if d.severity == "error")
    assert end.code == "branch-point"
    assert "A0.theta = 1.57079632679 rad" in str(end)
    assert "at_branch_points: straight" in str(end)
    assert f"the response ends at {float(reached):.6g} s" in str(end)


@pytest.mark.parametrize("straight", [True, False])
def test_crossed_cranks_stay_crossed(straight: bool) -> None:
    """The other branch through the same place has its own smooth continuation: the cranks of a
    crossed square turn against each other (theta_1 = -theta_0), and never in parallel."""
    text = parallel_cranks(
        1,
        "start: {A0.theta: 0.2, A0.theta_dot: 5 rad/s}",
        "near: {A1.theta: 2.5}",
        "time: {from: 0, to: 2, step: 0.125}",
        straight=straight,
    )
    found = mk.loads(text).respond("run")
    assert found["row.status"][0] == "ok"
    good = np.isfinite(found["A1.theta"])
    gap = np.cos(found["A1.theta"][good]) - np.cos(found["A0.theta"][good])
    assert good.sum() > 1
    assert np.max(np.abs(gap)) > 0.5
    assert np.nanmax(found["row.energy_error"]) < 1e-9


def test_a_mirrored_motion_is_the_mirror_image() -> None:
    def moved(sign: int) -> Any:
        text = parallel_cranks(
            2,
            f"start: {{A0.theta: {sign * 0.3}, A0.theta_dot: {sign * 3} rad/s}}",
            "time: {from: 0, to: 2, step: 0.25}",
            "tolerance: 1e-12",
        )
        return mk.loads(text).respond("run")["A0.theta"]

    assert np.max(np.abs(moved(1) + moved(-1))) < 1e-10


def test_reversed_it_goes_back() -> None:
    def moved(angle: float, rate: float) -> tuple[float, float]:
        text = parallel_cranks(
            2,
            f"start: {{A0.theta: {angle!r}, A0.theta_dot: {rate!r} rad/s}}",
            "time: {values: [0, 1.5]}",
            "tolerance: 1e-12",
        )
        found = mk.loads(text).respond("run")
        return found["A0.theta"][-1], found["A0.theta_dot"][-1]

    angle, rate = moved(0.25, 2.0)
    assert angle > 3 * np.pi / 2
    back, speed = moved(float(angle), -float(rate))
    assert abs(back - 0.25) < 1e-9
    assert abs(speed + 2.0) < 1e-9


def test_a_motion_may_turn_back_at_a_branch_point() -> None:
    """Swinging from rest 0.02 rad behind the line, and back through it."""
    text = parallel_cranks(
        1,
        f"start: {{A0.theta: {np.pi / 2 - 0.02!r}}}",
        "time: {from: 0, to: 5, step: 0.125}",
        "tolerance: 1e-12",
    )
    found = mk.loads(text).respond("run")
    angle = found["A0.theta"]
    assert set(found["row.status"]) == {"ok"}
    assert np.min(angle) > np.pi / 2 - 0.0201
    assert np.max(angle) < 3 * np.pi / 2 + 0.0201
    assert np.max(np.abs(found["A1.theta"] - angle)) < 1e-11
    assert np.max(found["row.energy_error"]) < 1e-9


def with_bob(*lines: str, straight: bool = True) -> str:
    """One loop with a pendulum of 0.4 that hangs on its bar."""
    text = parallel_cranks(1, *lines, straight=straight)
    text = text.replace("joints:\n", "  bob: {mass: 1, center_of_mass: [0, 0.6, 0]}\njoints:\n")
    hinge = "  K: {type: R, links: [bar0, bob], point: [0, 1, 0], axis: [0, 0, 1]}\n"
    return text.replace("loads:", f"{hinge}loads:")


def bob_on_a_crank(rate: float, times: Any, driven: bool) -> Any:
    """Crank, bob and their rates (4, rows): the bar only shifts, so the bob hangs on a point that
    moves on a circle, free or at a constant rate."""
    inertia, r = 2 / 3 + 1, 0.4

    def rates(_: float, y: Any) -> Any:
        turn, bob, fast, swing = y
        along, inwards = (-np.cos(turn), -np.sin(turn)), (np.sin(turn), -np.cos(turn))
        hang, up = (np.cos(bob), np.sin(bob)), (-np.sin(bob), np.cos(bob))
        pull = [(0, -GRAVITY)[k] - fast**2 * inwards[k] - r * swing**2 * up[k] for k in range(2)]
        coupled = r * (along[0] * hang[0] + along[1] * hang[1])
        force = along[0] * pull[0] + along[1] * pull[1] - 2 * GRAVITY * along[1]
        moment = r * (hang[0] * pull[0] + hang[1] * pull[1])
        if driven:
            return [fast, swing, 0.0, moment / r**2]
        first, second = np.linalg.solve([[inertia + 1, coupled], [coupled, r**2]], [force, moment])
        return [fast, swing, first, second]

    start = [0.0, 0.3, rate, 0.0]
    found = solve_ivp(
        rates, (0, times[-1]), start, method="DOP853", rtol=1e-13, atol=1e-14, t_eval=times
    )
    return found.y


@pytest.mark.parametrize("tolerance", [1e-12, 1e-8])
def test_several_freedoms_pass_together(tolerance: float) -> None:
    text = with_bob(
        "start: {A0.theta: 0, A0.theta_dot: 4 rad/s, K.theta: 0.3}",
        "time: {from: 0, to: 1.5, step: 0.125}",
        f"tolerance: {tolerance}",
    )
    found = mk.loads(text).respond("run")
    exact = bob_on_a_crank(4.0, found["time"], driven=False)
    assert set(found["row.status"]) == {"ok"}
    assert found["A0.theta"][-1] > 3 * np.pi / 2
    for name, values in zip(("A0.theta", "K.theta"), exact, strict=False):
        assert np.max(np.abs(found[name] - values)) < 100 * tolerance, name
    assert np.max(np.abs(found["A1.theta"] - found["A0.theta"])) < 1e-11
    assert np.max(found["row.energy_error"]) < 10 * tolerance


@pytest.mark.parametrize("steps", ["tolerance: 1e-12", "fixed_step: 0.005"])
def test_a_drive_goes_through(steps: str) -> None:
    text = with_bob(
        "start: {K.theta: 0.3}",
        "driven: {A0.theta: {law: constant-rate, at: 0, rate: -4 rad/s}}",
        "time: {from: 0, to: 1.5, step: 0.125}",
        steps,
    )
    found = mk.loads(text).respond("run")
    exact = bob_on_a_crank(-4.0, found["time"], driven=True)
    assert set(found["row.status"]) == {"ok"}
    assert np.max(np.abs(found["K.theta"] - exact[1])) < 1e-10
    assert np.max(found["row.energy_error"]) < 1e-11
    ended = mk.loads(text.replace("assembly: {at_branch_points: straight}\n", "")).respond("run")
    (end,) = (d for d in ended.diagnostics if d.severity == "error")
    assert end.code == "branch-point"
    assert "A0.theta = -1.5707963" in str(end)


def test_where_joints_rub_it_ends_there() -> None:
    text = parallel_cranks(
        1,
        "start: {A0.theta: 0, A0.theta_dot: 4 rad/s}",
        "time: {from: 0, to: 1, step: 0.125}",
    )
    rub = "{type: friction, joint: A0, coefficient: 0.001, radius: 0.02}"
    text = text.replace("loads: [", f"loads: [{rub}, ")
    text = text.replace("B0: {type: R", "B0: {type: S").replace("C0: {type: R", "C0: {type: C")
    text = text.replace("point: [0, 1, 0], axis: [0, 0, 1]}", "point: [0, 1, 0]}")
    found = mk.loads(text).respond("run")
    (end,) = (d for d in found.diagnostics if d.severity == "error")
    assert end.code == "branch-point"
    assert "with friction it is not passed" in str(end)


def test_no_bit_depends_on_the_lanes() -> None:
    text = parallel_cranks(
        2, "start: {A0.theta: 0, A0.theta_dot: 4 rad/s}", "time: {from: 0, to: 2, step: 0.5}"
    )
    cells = [mk.loads(text).respond("run", lanes=lanes)["A2.theta"].tobytes() for lanes in widths()]
    assert len(set(cells)) == 1


def test_double_speed_takes_half_the_time() -> None:
    def moved(rate: float, end: float) -> Any:
        text = parallel_cranks(
            2,
            f"start: {{A0.theta: 0.3, A0.theta_dot: {rate} rad/s}}",
            f"time: {{values: [0, {end}, {2 * end}]}}",
            "tolerance: 1e-12",
        )
        return mk.loads(text.replace("-9.81", "0")).respond("run")["A2.theta"]

    assert np.max(np.abs(moved(3.0, 1.0) - moved(6.0, 0.5))) < 1e-10


def test_neither_order_nor_names_matter() -> None:
    text = parallel_cranks(
        2,
        "start: {A0.theta: 0.3, A0.theta_dot: 4 rad/s}",
        "time: {from: 0, to: 2, step: 0.5}",
        "tolerance: 1e-12",
    )
    begin, end = text.index("joints:\n") + len("joints:\n"), text.index("loads:")
    turned = "".join(reversed(text[begin:end].splitlines(keepends=True)))
    other = text[:begin] + turned + text[end:]
    other = other.replace("crank1", "alpha").replace("bar0", "zeta")
    found, again = (mk.loads(one).respond("run")["A1.theta"] for one in (text, other))
    assert np.max(np.abs(found - again)) < 1e-9


def test_variants_that_cross_at_their_own_times_are_as_alone() -> None:
    text = parallel_cranks(
        2, "start: {A0.theta: 0.1, A0.theta_dot: 4 rad/s}", "time: {from: 0, to: 1, step: 0.5}"
    )
    text = text.replace("mass: 1,", "mass: m * 1 kg,", 1)
    text = text.replace("links:\n", "parameters: {m: 1}\nlinks:\n", 1)
    masses = [0.5, 1.0, 3.0]
    together = mk.loads(text).vary({"m": masses}, ["A2.theta"], run="run")["A2.theta"]
    for row, mass in zip(together, masses, strict=True):
        alone = mk.loads(text.replace("{m: 1}", f"{{m: {mass}}}")).respond("run")
        assert set(alone["row.status"]) == {"ok"}
        assert row.tobytes() == alone["A2.theta"].tobytes()
