"""Coordinates that a response drives, of very many moments: made block by block, and the same as
those of all moments at once."""

from __future__ import annotations

import numpy as np
import pytest
from streams.rebounding import PLATFORM

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.building import motion
from mechkin_cli.building.spacing import sampled
from mechkin_cli.mechanism import SpacedMoments
from mechkin_cli.tables.csv import csv_bytes

ROWS = 9001
FILE = """format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  slide: {{mass: 1, center_of_mass: [0, 0], inertia: 0}}
  lift: {{mass: 1, center_of_mass: [0, 0], inertia: 0}}
  bob: {{mass: 1, center_of_mass: [0, -1], inertia: 0}}
joints:
  P: {{type: P, links: [ground, slide], point: [0, 0], axis: [1, 0]}}
  Q: {{type: P, links: [slide, lift], point: [0, 0], axis: [0, 1]}}
  O: {{type: R, links: [lift, bob], point: [0, 0]}}
loads: [{{type: gravity, g: [0, -9.80665]}}]
responses:
  swing:
    start: {{O.theta: 0.2}}
    driven: {{P.s: {law}, Q.s: {other}}}
    time: {time}
    {more}
tables:
  - name: t
    run: swing
    columns: [time, P.s, P.s_dot, P.s_ddot, Q.s_ddot, O.theta, O.theta_dot, P.effort]
"""
EVEN, UNEVEN = f"{{from: 0, to: 9, count: {ROWS}}}", f"{{from: 0.1, to: 9.1, count: {ROWS}}}"
# rows are a thousandth of a second apart, and every third of them or so is in the sample of moments
LAWS = {
    "sine": "{law: sine, amplitude: 0.1, frequency: 0.7}",
    "bent between rows": '{with: "0.01 m/s^2*max(time - 2.0001234 s, 0 s)^2 - '
    '0.02 m/s^2*max(time - 2.0002 s, 0 s)^2"}',
    "smooth rise": "{law: cycloidal, from: 0, to: 0.3, start: 1.003, duration: 0.497}",
    "jumps at rows": "{law: harmonic, from: 0, to: 0.3, start: 0.998, duration: 2.003}",
    "jumps between rows": "{law: harmonic, from: 0, to: 0.3, start: 0.9981, duration: 2.0033}",
    "sequence": "{law: sequence, from: 0, start: 0.5, segments: [{for: 1.001, law: harmonic, "
    "to: 0.1}, {for: 0.502, law: dwell}, {for: 2.0005, law: harmonic, to: -0.1}]}",
}


def analyzed(text: str, monkeypatch, long: int):
    monkeypatch.setattr(motion, "LONG_RUN", long)
    return mk.loads(text, "driven")


@pytest.mark.parametrize("time", [EVEN, UNEVEN], ids=["even", "uneven"])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_made_block_by_block(law: str, time: str, monkeypatch) -> None:
    """Bit for bit, with a coordinate that follows another one, in blocks of any size."""
    text = FILE.format(law=law, other='{with: "0.5*P.s"}', time=time, more="")
    expected = analyzed(text, monkeypatch, 10 * ROWS).respond("swing").tables[0]
    made = analyzed(text, monkeypatch, 100)
    response = made.design.response("swing")
    assert isinstance(response.moments, SpacedMoments)
    assert response.driven[0].values.size < ROWS / 2
    assert_same(made.respond("swing").tables[0], expected)
    for rows in (57, 1000, 4096):
        monkeypatch.setattr(tolerances, "PART_ROWS", rows)
        stream = made.stream(run="swing", rows=4096)
        assert stream.in_blocks
        assert_same([block.tables[0] for block in stream], expected)


def assert_same(tables, expected) -> None:
    tables = tables if isinstance(tables, list) else [tables]
    for number, known in enumerate(expected.columns):
        values = np.concatenate([table.columns[number].values for table in tables])
        assert values.tobytes() == known.values.tobytes(), known.label


def test_stopped(monkeypatch) -> None:
    """A stop's own moment is a row, in which laws are evaluated, too."""
    more = "stop: [{value: O.theta, at: -0.15}]"
    text = FILE.format(law=LAWS["jumps at rows"], other='{with: "0.5*P.s"}', time=EVEN, more=more)
    expected = analyzed(text, monkeypatch, 10 * ROWS).respond("swing").tables[0]
    reached = len(expected.columns[0].values)
    assert 100 < reached < ROWS
    for rows in (100, reached - 1, reached):
        monkeypatch.setattr(tolerances, "PART_ROWS", rows)
        blocks = analyzed(text, monkeypatch, 100).stream(run="swing", rows=rows)
        assert_same([block.tables[0] for block in blocks], expected)


@pytest.mark.parametrize("rows", [64, 500, 4096])
def test_impacts_on_what_is_driven(rows: int, monkeypatch) -> None:
    """A mass rests on a shaken platform and leaves it, again and again; some blocks have nothing
    but the moment of an impact behind their rows."""
    text = PLATFORM.replace("TIME", f"{{from: 0, to: 2, count: {ROWS}}}")
    held = analyzed(text, monkeypatch, 10 * ROWS).respond("r")
    made = analyzed(text, monkeypatch, 100)
    monkeypatch.setattr(tolerances, "PART_ROWS", rows)
    stream = made.stream(run="r", rows=rows)
    found = [block.tables[0] for block in stream]
    numbers = [k for k, c in enumerate(held.tables[0].columns) if isinstance(c.values, np.ndarray)]
    assert len(numbers) > 6
    for number in numbers:
        values = np.concatenate([table.columns[number].values for table in found])
        assert values.tobytes() == held.tables[0].columns[number].values.tobytes()
    assert csv_bytes(stream.impacts) == csv_bytes(held.impacts)
    assert held.impacts.columns[0].rows > 4


def test_laws_that_are_not_defined_in_some_row(monkeypatch) -> None:
    """Between the moments of the sample: said where the rows are taken, with the row's moment."""
    row = next(k for k in range(4000, ROWS) if k not in sampled(ROWS))
    law = f'{{with: "0.1 m*sqrt(abs(time/(1 s) - {row / 1000}) - 0.0004)"}}'
    text = FILE.format(law=law, other='{with: "0.5*P.s"}', time=EVEN, more="")
    said = f"P.s has no finite value in row {row + 1}"
    with pytest.raises(mk.InvalidFile, match=said):
        analyzed(text, monkeypatch, 10 * ROWS)
    made = analyzed(text, monkeypatch, 100)
    with pytest.raises(mk.InvalidFile, match=said):
        made.respond("swing")
    monkeypatch.setattr(tolerances, "PART_ROWS", 1000)
    with pytest.raises(mk.InvalidFile, match=said):
        for _ in made.stream(run="swing", rows=1000):
            pass


@pytest.mark.parametrize(("first", "last"), [(0.0, 9.0), (-3.1, 7.3), (1e6, 1e6 + 0.01)])
def test_moments_next_to_others(first: float, last: float) -> None:
    """Those of very many as those that are found among all."""
    text = FILE.format(
        law=LAWS["sine"],
        other="{at: 0}",
        time=f"{{from: {first}, to: {last}, count: 70000}}",
        more="",
    )
    moments = mk.loads(text, "driven").design.response("swing").moments
    assert isinstance(moments, SpacedMoments)
    every = moments.written
    generator = np.random.default_rng(3)
    times = np.concatenate(
        [every[::997], np.nextafter(every[::991], np.inf), np.nextafter(every[1::991], -np.inf)]
    )
    times = np.concatenate([times, generator.uniform(first, last, 5000)])
    below, above = moments.beside(times)
    place = np.clip(np.searchsorted(every, times), 1, every.size - 1)
    inner = (times > every[0]) & (times < every[-1])
    assert (below[inner] == every[place - 1][inner]).all()
    assert (above[inner] == every[place][inner]).all()
    assert above[0] == every[0]
