"""Rod and rocker drawn twice or thrice next to the change point: the same rows as once."""

from __future__ import annotations

import pytest
from change_points.four_bars import FourBar, apart, file_of, joints_of
from mpmath import mp, mpf

import mechkin_cli as mk

GAPS = ["1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12"]


def near(gap: str, inside: bool) -> FourBar:
    """Crank-rocker whose crank passes its change point at 180 degrees, or has a dead centre."""
    rod = mpf("0.5") + mpf("2") - mpf("1.1") + (mpf(gap) if inside else -mpf(gap))
    return FourBar("0.5", mp.nstr(rod, 20), "1.1", "2", 1)


@pytest.mark.parametrize("copies", [1, 2, 3])
@pytest.mark.parametrize("pairs", ["SS", "RR", "CS", "RC"])
@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("inside", [True, False])
def test_doubled_rockers_go_as_one(gap: str, inside: bool, pairs: str, copies: int) -> None:
    bar = near(gap, inside)
    links, joints = ["crank"], ""
    for k in range(copies):
        links += [f"rod{k}", f"rocker{k}"]
        joints += joints_of(bar, "90", str(k), pairs, "crank")
    motion = "{inputs: {A.theta: {from: 0, to: 270, step: 7.3}}}"
    result = mk.loads(file_of(links, joints, motion)).analyze()
    end = mp.inf if inside else min(bar.dead_centres()) - 90
    drawn = bar.rocker(mpf(90))
    for k, turned in enumerate(result["A.theta"]):
        status = result["row.status"][k]
        if turned > end:
            assert status == "beyond-dead-centre", (turned, status)
            continue
        if status == "branch-lost" and turned > 90 and gap == "1e-12":
            continue  # the least singular value at 180 degrees is below 1e-6
        assert status in ("ok", "near-singular"), (turned, status)
        want = float(bar.rocker(mpf(90) + mpf(float(turned))) - drawn)
        for number in range(copies):
            assert apart(result[f"D{number}.theta"][k], want) < 1e-6, (turned, number)
