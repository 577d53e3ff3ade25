"""Peaks and means of rows of which one stands at a dead centre.

A slider-crank that its slider drives to the dead centre: the crank's angle is an arc cosine, and
the integral of its rate over the slider's way is the angle travelled, which is finite although the
rate is not. The rows end where the rate is infinite; the mean ends at the row beside.
"""

from __future__ import annotations

import csv
import io

import mpmath as mp
import numpy as np
import pytest
from means import mean_over_the_way, rms_over_the_way

import mechkin_cli as mk
from mechkin_cli.tables.results import Results
from mechkin_cli.tables.writers import written_files

CRANK, ROD, RATE = 30.0, 50.0, 100.0
OMEGA = "A.theta_dot"
WORDS = ("max", "min", "peak", "mean", "rms", "range")
TEXT = """
format: 1
name: pump
plane: xy
units: {length: mm, angle: deg}
links: {crank: {}, rod: {}, block: {}}
parameters: {torque: 3 N*m}
joints:
  A: {type: R, links: [ground, crank], point: [0 mm, 0 mm]}
  B: {type: R, links: [crank, rod], point: [0 mm, 30 mm]}
  C: {type: R, links: [rod, block], point: [40 mm, 0 mm]}
  D: {type: P, links: [ground, block], point: [40 mm, 0 mm], axis: [1, 0]}
motion:
  inputs:
    D.s: {values: [ROWS], rate: 100 mm/s}
loads:
  - {type: torque, link: crank, torque: torque}
tables:
  - name: t
    summary: [max, min, peak, mean, rms, range]
    columns: [D.s, A.theta, {label: omega, value: A.theta_dot}, {label: F, value: D.effort}]
"""


def way(steps: int = 40) -> np.ndarray:
    """The slider from the drawing to the dead centre at 80 mm, in smaller and smaller steps."""
    left = np.linspace(1.0, 0.0, steps + 1) ** 3
    return 40.0 - 40.0 * left


def text_of(rows: np.ndarray) -> str:
    return TEXT.replace("ROWS", ", ".join(f"{float(row)!r} mm" for row in rows))


def angle(x: mp.mpf) -> mp.mpf:
    """Of the crank above the way of the slider, where that is at x."""
    return mp.acos((x**2 + CRANK**2 - ROD**2) / (2 * x * CRANK))


def rates(rows: np.ndarray) -> np.ndarray:
    """The crank's in rad/s (rows,), infinite at 40."""
    with mp.workdps(40):
        return np.array(
            [float(RATE * mp.diff(angle, 40 + mp.mpf(r))) if r < 40.0 else -np.inf for r in rows]
        )


def summed(text: str) -> dict[str, float]:
    """What stands below the table, in the column of the crank's rate, read from the CSV file."""
    analysis = mk.loads(text).analyze()
    files = written_files([Results("t", analysis.tables, analysis.result)], ["csv"])
    head, *lines = csv.reader(io.StringIO(files["t.summary.csv"].decode(), newline=""))
    return {line[0]: float(line[head.index("omega")]) for line in lines}


def test_the_mean_of_a_rate_is_the_angle_travelled_over_the_way() -> None:
    found = mk.loads(text_of(way())).analyze().summary(OMEGA)
    with mp.workdps(30):
        travelled = float(-angle(mp.mpf(40)))  # to zero, where the crank lies in line
    # the trapezoidal rule up to the last row beside
    assert found.mean == pytest.approx(travelled / 40.0 * RATE, rel=2e-2)
    many = mk.loads(text_of(way(400))).analyze().summary(OMEGA)
    assert many.mean == pytest.approx(travelled / 40.0 * RATE, rel=2e-3)
    # that of the square grows as the logarithm of what is left of the way
    assert many.rms > found.rms * 1.2
    assert (found.rows, found.infinite) == (41, 1)


def test_means_end_at_the_last_finite_row_and_peaks_are_infinite_at_their_place() -> None:
    rows = way()
    expected = rates(rows)
    found = mk.loads(text_of(rows)).analyze().summary(OMEGA)
    assert found.mean == pytest.approx(mean_over_the_way(expected, rows), rel=1e-8)
    assert found.rms == pytest.approx(rms_over_the_way(expected, rows), rel=1e-8)
    assert found.min == (-np.inf, 40.0)
    assert found.peak == (np.inf, 40.0)
    assert found.range == np.inf
    slowest = int(np.argmax(expected))
    assert found.max == pytest.approx((expected[slowest], rows[slowest]), rel=1e-9)
    # as if the row were not asked for
    before = mk.loads(text_of(rows[:-1])).analyze().summary(OMEGA)
    assert (before.mean, before.rms) == (found.mean, found.rms)


def test_one_definition_below_tables_in_variants_and_in_studies() -> None:
    text = text_of(way())
    model = mk.loads(text)
    alone, below = model.analyze().summary(OMEGA), summed(text)
    varied = model.vary({"torque": [1, 3]}, [OMEGA], reduce=WORDS)[OMEGA]
    keep = [{"of": OMEGA, "as": [*WORDS, "place_of_peak", "place_of_min"]}]
    study = model.study({"vary": {"torque": [1, 3]}, "keep": keep})
    for number, word in enumerate(WORDS):
        own = getattr(alone, word)
        value = own.value if isinstance(own, tuple) else own
        assert below[word] == value
        assert varied[:, number].tolist() == [value] * 2
        assert study[f"{word}({OMEGA})"].tolist() == [value] * 2
    assert study[f"place_of_peak({OMEGA})"].tolist() == [alone.peak.place] * 2
    assert study[f"place_of_min({OMEGA})"].tolist() == [below["min at"]] * 2
    assert below["rows"] == 41


def test_reversed_in_inches_with_rows_twice_and_renamed() -> None:
    rows = way()
    text = text_of(rows)
    own = summed(text)
    back = summed(text_of(rows[::-1]))
    twice = summed(text_of(np.repeat(rows, 2)))
    renamed = summed(text.replace("A.", "pivot.").replace("A:", "pivot:"))
    inches = summed(text.replace("length: mm", "length: in"))
    for word in ("mean", "rms"):
        for other in (twice, renamed, inches):
            assert other[word] == pytest.approx(own[word], rel=1e-9)
        # seen from the dead centre the row there is left, and the rate is the other way round
        assert back[word] == pytest.approx(own[word], rel=1e-9)
    assert back["peak"] == twice["peak"] == renamed["peak"] == inches["peak"] == np.inf
    assert back["peak at"] == twice["peak at"] == 40.0
    assert inches["peak at"] == pytest.approx(40.0 / 25.4, rel=1e-15)
    assert twice["rows"] == 82


def test_notes_say_what_does_not_count() -> None:
    analysis = mk.loads(text_of(way())).analyze()
    told = "1 of 41 rows is infinite in omega, F and does not count for mean and rms"
    (table,) = analysis.tables
    assert told in table.summary.notes
    assert (
        f"- {told}"
        in written_files([Results("t", analysis.tables, analysis.result)], ["md"])["t.md"].decode()
    )
    only = text_of(way()).replace("[max, min, peak, mean, rms, range]", "[max, rms]")
    assert told.replace("mean and ", "") in mk.loads(only).analyze().tables[0].summary.notes
    peaks = text_of(way()).replace("[max, min, peak, mean, rms, range]", "[peak]")
    assert not [n for n in mk.loads(peaks).analyze().tables[0].summary.notes if "infinite" in n]


def test_where_no_stretch_is_left_the_finite_row_is_the_mean() -> None:
    found = mk.loads(text_of(np.array([0.0, 40.0]))).analyze()
    assert found[OMEGA][1] == -np.inf
    assert found.summary(OMEGA).mean == found[OMEGA][0]
