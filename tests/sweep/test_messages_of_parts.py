"""A long run says what it would say if it were solved at once: each message about rows comes once,
about the rows of all parts, with the worst of them."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from references import FILE_OF
from sweep.cut import cut
from sweep.turning_back import FOUR_BAR, SLIDER_CRANK

import mechkin_cli as mk
from mechkin_cli.row_notes import Found, Notes, RowNote, RowSet

CRANK = """format: 1
plane: xy
units: {length: m, angle: deg, mass: kg, force: N}
links: {crank: {mass: 2, center_of_mass: [0.5, 0], inertia: 1}}
joints: {A: {type: R, links: [ground, crank], point: [0, 0]}}
limits: {A.theta: [-90, 60]}
loads:
  - {type: force, link: crank, point: [1, 0], force: [1 N * sqrt(A.theta / 1 deg - 10), 0]}
motion: {inputs: {A.theta: {values: VALUES, rate: 1 rad/s}}}
tables: [{name: t, columns: [A.effort]}]
"""
"""A crank that its limits stop, under a load that has no value below ten degrees."""


@pytest.mark.parametrize("rows", [2, 5, 7, 31])
@pytest.mark.parametrize("seed", range(4))
def test_rows_beyond_a_limit_and_without_a_load_are_named_once(
    rows: int, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = random.Random(seed)
    values = [150.0 * math.sin(0.4 * row) + rng.uniform(-20.0, 20.0) for row in range(90)]
    text = CRANK.replace("VALUES", str(values))
    whole = mk.loads(text).analyze()
    cut(monkeypatch, rows)
    model = mk.loads(text)
    stream = model.stream()
    for _ in stream:
        pass
    told = [str(one) for one in stream.diagnostics]
    assert sorted(told) == sorted(map(str, whole.diagnostics))
    assert sorted(told) == sorted(map(str, model.analyze().diagnostics))
    for side, beyond, worst in (
        ("largest", [k for k, x in enumerate(values) if x > 60.0], max(values)),
        ("least", [k for k, x in enumerate(values) if x < -90.0], min(values)),
    ):
        (one,) = (text for text in told if f"{side} value of A.theta" in text)
        assert f"{len(beyond)} rows, first row {beyond[0] + 1}, lie beyond" in one
        assert f": {worst:.12g} deg (limit" in one
    below = [k for k, x in enumerate(values) if x < 10.0]
    (one,) = (text for text in told if "has no finite value" in text)
    assert f"in {len(below)} rows, first in row {below[0] + 1};" in one
    assert f"A.theta = {values[below[0]]:.12g} deg" in one


@pytest.mark.parametrize("rows", [3, 4, 9])
@pytest.mark.parametrize("seed", range(8))
def test_places_on_the_way_are_named_once(
    rows: int, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A slider that is driven to the end of its stroke and back, again and again."""
    rng = random.Random(seed)
    values = [0.0]
    for _ in range(rng.randint(1, 6)):
        way = sorted(rng.uniform(0.0, 0.95) for _ in range(rng.randint(1, 5)))
        values += [*way, 1.0, *reversed(way)]
    # crank 1, rod 2, drawn at a right angle: x = sqrt(3), and 3 at the end of the stroke
    end = 3.0 - 3.0**0.5
    place = {"ax": 0.0, "ay": 1.0, "x": 3.0**0.5}
    text = SLIDER_CRANK.format(values=[part * end for part in values], **place)
    whole = mk.loads(text).analyze()
    cut(monkeypatch, rows)
    found = mk.loads(text).analyze()
    assert sorted(map(str, found.diagnostics)) == sorted(map(str, whole.diagnostics))
    (note,) = (one for one in found.diagnostics if one.code == "dead-centre-touched")
    ends = [k + 1 for k, part in enumerate(values) if part == 1.0]
    shown = ", ".join(f"at row {row}" for row in ends[:4])
    more = f" and {len(ends) - 4} more" if len(ends) > 4 else ""
    assert note.message.startswith(f"{shown}{more} the inputs come to a dead centre")


@pytest.mark.parametrize("rows", [4, 10])
def test_branch_points_are_named_once(rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A parallelogram that is turned three times has six, of which four are shown."""
    values = [0.3 + 6.0 * np.pi * k / 60 for k in range(61)]
    text = FOUR_BAR.format(
        bx=float(np.cos(0.3)),
        by=float(np.sin(0.3)),
        cx=3.0 + float(np.cos(0.3)),
        cy=float(np.sin(0.3)),
        d=3.0,
        values=[value - 0.3 for value in values],
    )
    cut(monkeypatch, rows)
    found = mk.loads(f"{text}assembly: {{at_branch_points: straight}}\n").analyze()
    (note,) = (one for one in found.diagnostics if one.code == "branch-point-passed")
    places = [number.value for number in note.numbers]
    assert np.allclose(places, [np.pi * k - 0.3 for k in (1, 2, 3, 4)], atol=1e-9)
    assert note.measured is not None
    assert note.measured.endswith("and 2 more")


def words(found: Found) -> mk.Diagnostic:
    text = f"{found.rows}: {found.told:g}, {sorted(found.marks)}"
    return mk.Diagnostic("code", "warning", text)


@pytest.mark.parametrize("seed", range(200))
def test_notes_of_parts_are_those_of_all_rows(seed: int) -> None:
    rng = np.random.default_rng(seed)
    size = int(rng.integers(1, 60))
    where, bad = rng.random(size) < rng.random(), rng.integers(0, 9, size).astype(np.float64)
    marks = [(name, rng.random(size) < 0.1) for name in "ab"]
    values = rng.random(size)

    def note(rows: slice) -> RowNote:
        own = [(name, there[rows] & where[rows]) for name, there in marks]
        part = values[rows]
        return RowNote("code", "warning", "", where[rows], words, bad[rows], part.__getitem__, own)

    whole, parts = Notes(size), Notes(size)
    whole.add([note(slice(None))])
    first = 0
    while first < size:
        end = min(size, first + int(rng.integers(1, 9)))
        begin = max(0, first - int(rng.integers(0, 4)))  # rows that other parts have, too
        parts.add([note(slice(begin, end))], begin, slice(first - begin, None))
        first = end
    assert parts.found() == whole.found()
    numbers = np.flatnonzero(where)
    assert len(whole.found()) == bool(numbers.size)
    if numbers.size:
        worst = values[numbers[np.argmax(bad[numbers])]]
        assert f"{RowSet.of(numbers)}: {worst:g}, " in whole.found()[0].message


def test_other_messages_of_many_parts_are_few() -> None:
    notes = Notes(9)
    for row in range(9):
        told = mk.Diagnostic("few-digits", "warning", f"row {row}")
        notes.add([told, mk.Diagnostic("no-rate", "note", "the same")])
    found = [one.message for one in notes.found()]
    assert found == ["row 0", "the same", "row 1", "row 2", "row 3 (and 5 more such messages)"]


def test_messages_of_one_kind_about_many_places_are_told_by_a_stream_too() -> None:
    """Six legs that spin freely have a note each."""
    model = mk.load(FILE_OF["stewart"])
    spinning = [name for name in model.quantities if name.startswith("tube")]
    whole = [str(one) for one in model.analyze(spinning, tables=[]).diagnostics]
    stream = model.stream(spinning)
    for _ in stream:
        pass
    assert [str(one) for one in stream.diagnostics] == whole
    assert sum("spin" in one for one in whole) == 6
