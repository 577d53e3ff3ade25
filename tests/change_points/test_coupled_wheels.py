"""Wheels on rods that are a little too long: a dead centre next to the change point, no crossing.

Several rods come to their change points at one place; their signs change together.
"""

from __future__ import annotations

import pytest
from change_points.four_bars import FourBar, apart, file_of, joints_of
from mpmath import mpf

import mechkin_cli as mk

EXCESS = ["1e-12", "1e-10", "1e-8", "1e-5", "1e-3"]
"""Metres; 1e-5 is 10 um."""


LOSABLE = mpf("1e-11")
"""Rods less too long than this come within 1e-6 of a singular place: rows beyond may be lost."""


def text(bars: list[FourBar], pairs: str, at: str, motion: str) -> str:
    """Wheels of radius 0.3 m, 1 m apart, each on a rod of its own to the driven one."""
    links = ["crank"]
    joints = ""
    for k, bar in enumerate(bars):
        links += [f"rod{k}", f"rocker{k}"]
        joints += joints_of(bar, at, str(k), pairs, "crank")
    return file_of(links, joints, motion)


def parallel(excess: str, at: str) -> FourBar:
    """The side on which the wheels turn the same way at an angle of the crank."""
    bars = [FourBar("0.3", str(mpf(1) + mpf(excess)), "0.3", "1", side) for side in (-1, 1)]
    return min(bars, key=lambda bar: apart(float(bar.rocker(mpf(at))), float(at)))


@pytest.mark.parametrize("pairs", ["SS", "RR", "CS"])
@pytest.mark.parametrize("excess", EXCESS)
@pytest.mark.parametrize("rods", [2, 3])
@pytest.mark.parametrize("step", [3.5, 17.0, 45.0])
def test_wheels_stop_at_the_dead_centre(excess: str, rods: int, pairs: str, step: float) -> None:
    bar = parallel(excess, "90")
    (limit,) = bar.dead_centres()
    for to in (360, -360):
        motion = f"{{inputs: {{A.theta: {{from: 0, to: {to}, step: {step}}}}}}}"
        result = mk.loads(text([bar] * rods, pairs, "90", motion)).analyze()
        drawn = float(bar.rocker(mpf(90)))
        # from 90 degrees up over the change point at 180 to 360 - limit, or down to limit
        end = 270 - float(limit) if to > 0 else float(limit) - 90
        for k, turned in enumerate(result["A.theta"]):
            if abs(turned - end) < 1e-6:
                continue
            status = result["row.status"][k]
            if status == "branch-lost" and turned > 89 and mpf(excess) < LOSABLE:
                continue
            if abs(turned) > abs(end):
                assert status == "beyond-dead-centre", (turned, status)
                continue
            assert status in ("ok", "near-singular"), (turned, status)
            want = float(bar.rocker(mpf(90) + mpf(float(turned)))) - drawn
            for number in range(rods):
                assert apart(result[f"D{number}.theta"][k], want) < 1e-6, (turned, number)


@pytest.mark.parametrize("pairs", ["SS", "CS"])
@pytest.mark.parametrize("excess", EXCESS[1:])
def test_wheels_do_not_turn_fully(excess: str, pairs: str) -> None:
    """The second rod is half as much again too long: its dead centres come first, and there its
    two assemblies meet; the first rod stays on its side."""
    bars = [parallel(excess, "90"), parallel(str(mpf(excess) * 3 / 2), "90")]
    (limit,) = bars[1].dead_centres()
    # an excess of a few roundings more is a dead centre elsewhere: limit ~ sqrt(excess)
    exactness = 1e-9 + 4e-16 * float(limit) / (2 * float(excess))
    motion = "{inputs: {A.theta: {from: 0, to: 1, step: 1}}}"
    found = mk.loads(text(bars, pairs, "90", motion)).ranges()
    assert len(found.ranges) == 4
    for item in found.ranges:
        assert (item.lower.kind, item.upper.kind) == ("dead-centre", "dead-centre")
        assert abs(item.lower.value - float(limit - 90)) < exactness
        assert abs(item.upper.value - float(270 - limit)) < exactness
    assert sorted(len(circuit) for circuit in found.circuits) == [2, 2]
