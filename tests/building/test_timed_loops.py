"""A closed loop driven over time: a plane slider-crank through rests, returns and whole turns."""

import re

import mpmath as mp
import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk

TEXT = re.sub(
    r"motion:\n.*?\n(?=loads:)",
    "motion: {time: {from: 0, to: 2, step: 0.1}, inputs: {A.theta: LAW}}\n",
    FILE_OF["slider_crank"].read_text(),
    flags=re.DOTALL,
)


def rise(t: mp.mpf) -> mp.mpf:
    """From 0 to 400 degrees between 0.45 and 1.65 s."""
    u = min(max((t - mp.mpf("0.45")) / mp.mpf("1.2"), 0), 1)
    return mp.radians(400) * (u - mp.sin(2 * mp.pi * u) / (2 * mp.pi))


LAWS = {
    "{law: cycloidal, from: 0, to: 400, start: 0.45, duration: 1.2}": rise,
    "{law: polynomial, coefficients: [0, 9 rad/s, -5 rad/s^2]}": lambda t: 9 * t - 5 * t * t,
    "{with: 3 rad*sin(2 rad/s*time)}": lambda t: 3 * mp.sin(2 * t),
}


@pytest.mark.parametrize("law", LAWS)
def test_the_slide_follows_the_law_of_the_crank(law: str) -> None:
    analysis = mk.loads(TEXT.replace("LAW", law)).analyze()
    assert analysis.result.complete
    crank, rod = mp.mpf("0.1"), mp.mpf("0.35")

    def slide(t: mp.mpf) -> mp.mpf:
        a = LAWS[law](t)
        return crank * (mp.cos(a) - 1) + mp.sqrt(rod**2 - (crank * mp.sin(a)) ** 2) - rod

    with mp.workdps(40):
        rows = [mp.taylor(slide, mp.mpf(k) / 10, 2) for k in range(21)]
    expected = np.array([[float(c * mp.factorial(k)) for k, c in enumerate(row)] for row in rows]).T
    for order, name in enumerate(("D.s", "D.s_dot", "D.s_ddot")):
        scale = np.abs(expected[order]).max()
        np.testing.assert_allclose(analysis[name], expected[order], rtol=0, atol=1e-13 * scale)


def test_time_may_stand_in_columns() -> None:
    text = TEXT.replace("LAW", "{law: constant-rate, at: 0, rate: 2}")
    analysis = mk.loads(text + "      - {label: t, value: time}\n").analyze()
    assert analysis["A.theta - 2 rad/s*time"] == pytest.approx(np.zeros(21), abs=1e-13)
    assert analysis.tables[0].columns[-1].values.tolist() == [k / 10 for k in range(21)]
    with pytest.raises(mk.InvalidFile, match="nothing named time"):
        mk.loads(
            text.replace("time: {from: 0, to: 2, step: 0.1}, ", "").replace(
                "{law: constant-rate, at: 0, rate: 2}", "{at: 0}"
            )
            + "      - {label: t, value: time}\n"
        )
