"""Laws of motion over time: values, rates, accelerations and jerks against closed forms."""

from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.mechanism.motion import DrivenInput
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.markup import rows_table

FILE = """\
format: 1
units: {length: mm, angle: deg, time: ms}
links: {crank: {}, slide: {}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [crank, slide], point: [0, 0, 0], axis: [1, 0, 0]}
motion:
  time: {from: 100, to: 900, step: 50}
  inputs:
    O.theta: LAW
    S.s: {at: 7}
tables: [{name: t, columns: [time, O.theta, S.s, O.theta_dot, 2*time]}]
"""
TIMES = np.arange(100, 901, 50) / 1000
DEG = mp.pi / 180


def driven(law: str, coordinate: str = "O.theta") -> DrivenInput:
    motion = mk.loads(FILE.replace("LAW", law)).problem.motion
    return next(item for item in motion.inputs if item.name == coordinate)


def smooth(u: mp.mpf) -> mp.mpf:
    return u - mp.sin(2 * mp.pi * u) / (2 * mp.pi)


LAWS = [
    ("{law: constant-rate, at: 30, rate: 2}", lambda t: 30 * DEG + 2 * (t - 0.1)),
    (
        "{law: constant-acceleration, at: 30 deg, rate: 60 rpm, acceleration: -3}",
        lambda t: 30 * DEG + 2 * mp.pi * (t - 0.1) - 1.5 * (t - 0.1) ** 2,
    ),
    (
        "{law: polynomial, coefficients: [10, 0.5 rad/s, -3 deg/s^2, 4 rad/s^3, 2 rad/s^4]}",
        lambda t: (
            10 * DEG
            + (t - 0.1) / 2
            - 3 * DEG * (t - 0.1) ** 2
            + 4 * (t - 0.1) ** 3
            + 2 * (t - 0.1) ** 4
        ),
    ),
    ("{law: polynomial, coefficients: [0.25 rad]}", lambda t: mp.mpf(0.25)),
    (
        "{law: harmonic, from: 20, to: -70}",
        lambda t: DEG * (20 - 90 * (1 - mp.cos(mp.pi * (t - 0.1) / 0.8)) / 2),
    ),
    (
        "{law: cycloidal, from: 20, to: 110}",
        lambda t: DEG * (20 + 90 * smooth((t - 0.1) / 0.8)),
    ),
    (
        "{law: cycloidal, from: 20, to: 110, start: -1 s, duration: 3000}",
        lambda t: DEG * (20 + 90 * smooth((t + 1) / 3)),
    ),
]


@pytest.mark.parametrize(("law", "closed_form"), LAWS, ids=[law for law, _ in LAWS])
def test_a_law_and_its_derivatives(law: str, closed_form: object) -> None:
    item = driven(law)
    found = np.array([item.values, item.rates, item.accelerations, item.jerks])
    with mp.workdps(40):
        series = [mp.taylor(closed_form, mp.mpf(round(1000 * t)) / 1000, 3) for t in TIMES]
    expected = np.array([[float(c * mp.factorial(k)) for k, c in enumerate(s)] for s in series]).T
    for order in range(4):
        scale = max(1.0, np.abs(expected[order]).max())
        np.testing.assert_allclose(found[order], expected[order], rtol=0, atol=4e-15 * scale)


@pytest.mark.parametrize("law", ["harmonic", "cycloidal"])
def test_a_rise_rests_before_and_after(law: str) -> None:
    item = driven(f"{{law: {law}, from: 10, to: 100.1, start: 300, duration: 400}}")
    assert item.written[:5].tolist() == [10.0] * 5
    assert item.written[8] == pytest.approx(55.05, abs=1e-13)
    assert item.written[12:].tolist() == [100.1] * 5
    resting = np.r_[0:4, 13:17]
    for orders in (item.rates, item.accelerations, item.jerks):
        assert not orders[resting].any()
    assert item.rates[[4, 12]].tolist() == [0.0, 0.0]
    peak = np.pi / 2 if law == "harmonic" else 2.0
    assert item.rates[8] == pytest.approx(np.radians(90.1) / 0.4 * peak, rel=1e-14)


def test_the_first_and_last_moment_belong_to_the_rise() -> None:
    item = driven("{law: harmonic, from: 0, to: 180, start: 300, duration: 400}")
    peak = np.pi * (np.pi / 0.4) ** 2 / 2
    assert item.accelerations[[4, 12]] == pytest.approx([peak, -peak], rel=1e-14)


def test_time_and_inputs_are_printed_as_meant() -> None:
    law = "{law: constant-rate, at: 0.1, rate: 90 deg/s}"
    analysis = mk.loads(FILE.replace("LAW", law).replace("step: 50", "step: 0.1 s")).analyze()
    lines = csv_bytes(analysis.tables[0]).decode().splitlines()
    assert lines[:4] == [
        "time,O.theta,S.s,O.theta_dot,2*time",
        "100,0.1,7,1.5707963267948966,200",
        "200,9.1,7,1.5707963267948966,400",
        "300,18.1,7,1.5707963267948966,600",
    ]
    rows = csv_bytes(rows_table(analysis.result)).decode().splitlines()
    assert rows[0].startswith("row,time,O.theta,S.s,mode,status")
    assert rows[2].startswith("2,200,9.1,7,")
    assert analysis["time"].tolist() == list(range(100, 901, 100))


def test_time_stands_first_in_the_table_of_a_file_without_tables() -> None:
    text = FILE.replace("LAW", "{law: constant-rate, at: 0, rate: 1}").split("tables:")[0]
    assert mk.loads(text).tables[0].columns[0].label == "time"


def test_a_table_is_met_at_its_rows_and_smooth_between(tmp_path: Path) -> None:
    rows = [(t, 0.1 * t - 3e-7 * t**3) for t in range(0, 1001, 50)]
    (tmp_path / "law.csv").write_text("ms,deg\n" + "".join(f"{t},{x!r}\n" for t, x in rows))
    text = FILE.replace("LAW", "{law: table, file: law.csv}").replace("step: 50", "step: 25")
    (tmp_path / "m.yaml").write_text(text)
    item = mk.load(tmp_path / "m.yaml").problem.motion.inputs[0]
    assert item.written[::2].tolist() == [x for t, x in rows if 100 <= t <= 900]
    t = np.arange(100, 901, 25) / 1000
    expected = [100 * t - 300 * t**3, 100 - 900 * t**2, -1800 * t, -1800 + 0 * t]
    found = [item.values, item.rates, item.accelerations, item.jerks]
    np.testing.assert_allclose(np.degrees(found), expected, rtol=0, atol=1e-7)


BAD = [
    ("O.theta: LAW", "O.theta: {law: harmonic, from: 0, to: 9, duration: »0}", "no-duration"),
    (
        "O.theta: LAW",
        "O.theta: {law: harmonic, from: 0, to: 9, start: »900}",
        "no-duration",
        "a rise takes a positive time: 0 ms",
    ),
    (
        "O.theta: LAW",
        "O.theta: {law: polynomial, coefficients: [0, 1 deg/s, »2 deg/s, 0]}",
        "expression",
        "expected an angular acceleration, found an angular rate",
    ),
    (
        "O.theta: LAW",
        "O.theta: {law: constant-rate, at: »1 mm, rate: 1}",
        "expression",
        "expected an angle, found a length",
    ),
    (
        "O.theta: LAW",
        "O.theta: »{law: polynomial, coefficients: [0, 0, 0, 1e100 rad/s^3, 1e100 rad/s^4]}",
        "too-large",
    ),
    ("{at: 7}", "{at: 7, »rate: 1}", "held-rate", "write law: constant-rate"),
    ("{from: 100, to: 900, step: 50}", "»{from: 9, to: 1, step: 1}", "time-backwards"),
    ("step: 50}", "step: »0}", "zero-step"),
    ("step: 50}", "step: »1e-10}", "too-many-rows"),
    ("step: 50}", "step: »1 mm}", "expression", "expected a time, found a length"),
    ("900, step: 50}", '"»1/2 s", step: 1}', "expression", "expected a time, found a frequency"),
    ("900, step: 50}", '"»1/2 s", count: 3}', "expression", "expected a time, found a frequency"),
    ("900, step: 50}", "»1e300, count: 3}", "too-large"),
    ("900, step: 50}", "»100, count: 3}", "zero-step", "time stands still over 3 rows"),
    ("100, to: 900, step: 50}", "0, to: »1e-310, count: 3}", "zero-step", "a later moment"),
    ("O.theta: LAW", "O.theta: {law: table, file: »law.csv}", "csv-table", "comes from no file"),
]


@pytest.mark.parametrize("bad", BAD, ids=[f"{bad[2]} {bad[1]}" for bad in BAD])
def test_bad_laws(bad: tuple[str, ...]) -> None:
    old, new, code, *words = bad
    marked = FILE.replace(old, new).replace("LAW", "{law: constant-rate, at: 0, rate: 1}")
    before = marked[: marked.index("»")]
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(marked.replace("»", ""), "bad.yaml")
    (error,) = caught.value.diagnostics
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    assert str(error).startswith(f"bad.yaml:{line}:{column}: error: ")
    assert error.code == code
    assert all(word in str(error) for word in words), str(error)


def test_a_table_that_ends_too_early_is_refused(tmp_path: Path) -> None:
    (tmp_path / "law.csv").write_text("ms,deg\n0,0\n850,3\n")
    (tmp_path / "m.yaml").write_text(FILE.replace("LAW", "{law: table, file: law.csv}"))
    with pytest.raises(mk.InvalidFile) as caught:
        mk.load(tmp_path / "m.yaml")
    assert str(caught.value) == (
        f"{tmp_path / 'm.yaml'}:10:33: error: law.csv does not reach all moments of time: "
        "900 ms (limit 0 to 850 ms); add rows to the table, or change from and to of time"
    )
