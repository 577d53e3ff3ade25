"""Streamed responses with impacts and rests: the bytes of the whole run, and closed forms."""

from __future__ import annotations

import os
from math import asin, cos, pi, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq
from streams.rebounding import BALL, PLATFORM, SPRUNG, TEXTS, timed
from streams.test_responses import cells, run, small_blocks

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.response import resting, stretches
from mechkin_cli.tables import Columns, rows_table

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

BLOCKS = range(1, 21) if TIMES > 1 else (1, 2, 3, 4, 5, 7, 10, 13, 20)
"""Rows of a block."""


@pytest.mark.parametrize("rows", BLOCKS)
@pytest.mark.parametrize("name", TEXTS)
def test_blocks_have_the_bytes_of_the_run(
    name: str, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = mk.loads(TEXTS[name])
    whole = model.respond("r")
    tables = [*whole.tables, rows_table(whole.result, "r")]
    small_blocks(monkeypatch, rows)
    stream = model.stream(run="r", rows=3)
    assert stream.in_blocks == (rows < model.design.response("r").rows)
    found: dict[tuple[str, str], list] = {(t.name, c.label): [] for t in tables for c in t.columns}
    for block in stream:
        for column in block.tables[0].columns:
            found["t", column.label] += cells(column)
    for part, _ in stream.parts():
        first = part.analysis.result.row_states.span.first
        for column in rows_table(part.analysis.result, "r").columns:
            number = column.label == "row"
            numbered = column.with_values(column.numbers + first) if number else column
            found["r.rows", column.label] += cells(numbered)
    assert found == {(t.name, c.label): cells(c) for t in tables for c in t.columns}
    assert stream.run_rows == whole.rows == stream.verdicts.rows
    assert stream.verdicts.complete == whole.complete
    assert list(map(str, stream.diagnostics)) == list(map(str, whole.diagnostics))
    assert whole.impacts is not None
    assert stream.impacts is not None
    assert [(c.label, cells(c)) for c in stream.impacts.columns] == [
        (c.label, cells(c)) for c in whole.impacts.columns
    ]


@pytest.mark.parametrize("rows", [1, 3, 10])
@pytest.mark.parametrize("name", TEXTS)
def test_no_answer_depends_on_how_far_is_looked_ahead(
    name: str, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither within a stretch, nor within a rest until a limit pulls."""
    whole = mk.loads(TEXTS[name]).respond("r")
    monkeypatch.setattr(stretches, "STRETCH_ROWS", rows)
    monkeypatch.setattr(resting, "WINDOW", rows)
    found = mk.loads(TEXTS[name]).respond("r")
    for column, expected in zip(found.tables[0].columns, whole.tables[0].columns, strict=True):
        assert cells(column) == cells(expected), column.label


def numbers_of(table: Columns) -> dict[str, np.ndarray]:
    """The columns of a table but for its words."""
    return {one.label: one.numbers for one in table.columns if one.label != "event"}


@pytest.mark.parametrize("name", ["an impact at a row", "a rest from a row on"])
def test_an_impact_at_a_row_is_one(name: str) -> None:
    """The texts above have what their names say."""
    whole = mk.loads(TEXTS[name]).respond("r")
    assert whole.impacts is not None
    assert whole.impacts.columns[0].numbers[0] in whole["time"]


@pytest.mark.parametrize(("rows", "block"), [(9001, 4096), (100_001, None)])
def test_a_streamed_ball_has_the_closed_form(
    rows: int, block: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Heights and rates of each flight, when impacts are, and what they give."""
    e, height, g = 0.9, 2.0, 10.0
    if block:
        small_blocks(monkeypatch, block)
    text = timed(BALL.replace("restitution: 0.5", f"restitution: {e}"), 15, rows)
    stream = mk.loads(text).stream(["S.s", "S.s_dot", "S.effort"], run="r", tables=[], rows=1000)
    assert stream.in_blocks
    found = {name: np.concatenate([b[name] for b in stream]) for name in ("S.s", "S.s_dot")}
    effort = np.concatenate([b["S.effort"] for b in stream])
    time = np.arange(rows) * (15.0 / (rows - 1))
    rate = sqrt(2.0 * g * height)
    at = [rate / g]
    rates = [rate * e]
    while len(at) < 90:
        at.append(at[-1] + 2.0 * rates[-1] / g)
        rates.append(rates[-1] * e)
    flight = np.searchsorted(at, time, side="right")
    # near an impact a row may be on its other side
    away = np.abs(time[:, None] - np.array(at)).min(axis=1) > 1e-10
    away &= time < at[-1]
    since = np.where(flight > 0, time - np.array([0.0, *at])[flight], time)
    up = np.array([0.0, *rates])[flight]
    begun = np.where(flight > 0, 0.0, height)
    falls = begun + up * since - 0.5 * g * since**2
    np.testing.assert_allclose(found["S.s"][away], falls[away], atol=1e-10)
    np.testing.assert_allclose(found["S.s_dot"][away], (up - g * since)[away], atol=1e-9)
    over = at[0] * (1.0 + 2.0 * e / (1.0 - e))
    rests = time > over
    assert rests.sum() > rows // 10
    np.testing.assert_allclose(found["S.s"][rests], 0.0, atol=1e-11)
    np.testing.assert_allclose(effort[rests], 20.0, rtol=1e-13)
    assert not effort[time < at[-1]].any()
    assert stream.impacts is not None
    columns = numbers_of(stream.impacts)
    # where an impact is found is uncertain by rounding, and so is when by that over the rate
    np.testing.assert_allclose(columns["time"][:60], at[:60], rtol=1e-12)
    np.testing.assert_allclose(columns["time"][:90], at, atol=1e-10)
    given = 2.0 * np.array(rates) * (1.0 + 1.0 / e)
    np.testing.assert_allclose(columns["S.s.impulse"][:40], given[:40], rtol=1e-9)
    np.testing.assert_allclose(columns["S.s.impulse"][:90], given, atol=1e-9)


class Thrown:
    """What rests on a platform y = 0.1 m sin(4 pi t/s) and is thrown off where y'' = -g: flights
    and rests in turn."""

    def __init__(self, to: float) -> None:
        self.w, self.a, self.g = 4.0 * pi, 0.1, 10.0
        lets_go = asin(self.g / (self.a * self.w**2)) / self.w
        period, time = 2.0 * pi / self.w, 0.0
        self.flights: list[tuple[float, float]] = []
        while time < to:
            turn = int((time - lets_go) / period + 1.0) if time > lets_go else 0
            begin = lets_go + turn * period
            end = brentq(
                lambda t, b=begin: self.above(t, b), begin + 0.05, begin + 0.45, xtol=1e-15
            )
            # it lands where the platform carries it
            assert -self.a * self.w**2 * sin(self.w * end) > -self.g
            self.flights.append((begin, end))
            time = end

    def above(self, time: float, begin: float) -> float:
        """How far it is above the platform."""
        since, place = time - begin, self.a * sin(self.w * begin)
        rate = self.a * self.w * cos(self.w * begin)
        own = place + rate * since - 0.5 * self.g * since**2
        return own - self.a * sin(self.w * time)


def test_a_streamed_platform_throws_off_turn_after_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    small_blocks(monkeypatch, 4096)
    rows, to = 12_001, 6.0
    names = ["S.s", "S.effort"]
    stream = mk.loads(timed(PLATFORM, to, rows)).stream(names, run="r", tables=[], rows=1000)
    assert stream.in_blocks
    blocks = [{name: block[name] for name in names} for block in stream]
    found = {name: np.concatenate([block[name] for block in blocks]) for name in names}
    reference = Thrown(to)
    assert len(reference.flights) > 8
    time = np.arange(rows) * (to / (rows - 1))
    expected = np.zeros(rows)
    pushed = 2.0 * (10.0 - 0.1 * reference.w**2 * np.sin(reference.w * time))
    near = np.zeros(rows, dtype=np.bool_)
    for begin, end in reference.flights:
        flies = (time > begin) & (time < end)
        expected[flies] = [reference.above(t, begin) for t in time[flies]]
        pushed[flies] = 0.0
        near |= (np.abs(time - begin) < 1e-6) | (np.abs(time - end) < 1e-9)
    np.testing.assert_allclose(found["S.s"], expected, atol=1e-9)
    np.testing.assert_allclose(found["S.effort"][~near], pushed[~near], atol=1e-8)
    assert stream.impacts is not None
    lands = [end for _, end in reference.flights if end < to]
    np.testing.assert_allclose(stream.impacts.columns[0].numbers[1:], lands, rtol=1e-9)


def test_impacts_at_which_something_rubs_have_their_table() -> None:
    whole = mk.loads(TEXTS["friction"]).respond("r")
    assert whole.impacts is not None
    found = numbers_of(whole.impacts)
    # what falls by 2 m comes with sqrt(40) m/s, and the guide of the carriage bears the blow
    first = 2.0 * 1.4 * sqrt(40.0)
    assert found["Y.s.impulse"][0] == pytest.approx(first, rel=1e-11)
    assert found["X.impulse.y"][0] == pytest.approx(first, rel=1e-11)


def test_too_many_impacts_end_a_stream(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tolerances, "MOST_IMPACTS", 3)
    model = mk.loads(TEXTS["a ball that comes to rest"])
    whole = model.respond("r")
    assert any("with its 3 impacts" in d.message for d in whole.diagnostics)
    small_blocks(monkeypatch, 7)
    stream = model.stream(["S.s"], run="r", rows=4)
    values = np.concatenate([block["S.s"] for block in stream])
    assert values.tobytes() == whole["S.s"].tobytes()
    assert list(map(str, stream.diagnostics)) == list(map(str, whole.diagnostics))


def test_what_rests_on_a_spring_keeps_its_energy() -> None:
    """A heavy platform throws off what rests on it, and loses what that loses."""
    whole = mk.loads(timed(SPRUNG, 3, 91)).respond("r")
    assert whole.impacts is not None
    assert len(whole.impacts.columns[0].numbers) > 5
    assert np.nanmax(whole["row.energy_error"]) < 1e-9


def test_the_command_writes_what_it_does_of_a_whole_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "f.yaml"
    path.write_text(timed(BALL, 3, 2 * tolerances.LONG_RUN))
    for name, formats in (("streamed", "csv"), ("whole", "csv,md")):
        run(monkeypatch, str(path), "--format", formats, "--out", str(tmp_path / name))
    for file in ("t.csv", "r.rows.csv", "r.impacts.csv"):
        streamed = (tmp_path / "streamed" / file).read_bytes()
        assert streamed == (tmp_path / "whole" / file).read_bytes()
