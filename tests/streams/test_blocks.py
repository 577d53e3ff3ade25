"""Blocks of rows are those of the whole run, bit for bit, whatever their size."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from references import FILE_OF, SWEPT
from sweep.cut import cut

import mechkin_cli as mk
from mechkin_cli.mechanism import LongRun, Span
from mechkin_cli.tables import Columns, Words


def whole_columns(analysis: mk.Analysis) -> dict[tuple[str, str], bytes]:
    return {
        (table.name, column.label): column.values.array().tobytes()
        if isinstance(column.values, Words)
        else column.numbers.tobytes()
        for table in analysis.tables
        for column in table.columns
    }


def streamed_columns(stream: mk.Stream) -> dict[tuple[str, str], bytes]:
    found: dict[tuple[str, str], list[np.ndarray]] = {}
    for block in stream:
        for table in block.tables:
            for column in table.columns:
                is_words = isinstance(column.values, Words)
                values = column.values.array() if is_words else column.numbers
                assert values.size == block.rows
                found.setdefault((table.name, column.label), []).append(values)
    return {name: np.concatenate(values).tobytes() for name, values in found.items()}


def bytes_of(tables: Sequence[Columns]) -> list[tuple[str, str, object]]:
    """Tables that have no rows of the run."""
    return [
        (table.name, column.label, tuple(column.values.array()))
        if isinstance(column.values, Words)
        else (table.name, column.label, np.asarray(column.values).tobytes())
        for table in tables
        for column in table.columns
    ]


@pytest.mark.parametrize("path", SWEPT, ids=lambda path: path.stem)
def test_blocks_of_kept_mechanisms_have_the_bytes_of_the_run(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut(monkeypatch, 8)
    model = mk.load(path)
    whole = model.analyze()
    expected = whole_columns(whole)
    for rows in (1, 7, 4096):
        for threads in (1, 2):
            stream = model.stream(rows=rows, threads=threads)
            assert streamed_columns(stream) == expected
            said = {str(one) for one in whole.result.diagnostics}
            assert {str(one) for one in stream.diagnostics} == said
            assert bytes_of(stream.coefficients) == bytes_of(whole.coefficients)


def test_a_block_is_read_like_an_analysis() -> None:
    model = mk.load(FILE_OF["rcsr"])
    whole = model.analyze(["O3.force"])
    first = 0
    for block in model.stream(["O3.force"], rows=10, tables=[]):
        rows = slice(first, first + block.rows)
        assert block.first == first
        for text in ("O4.theta", "O3.force", "norm(O3.force)", "row.status", "2*O1.effort"):
            assert np.array_equal(block[text], whole[text][rows])
            assert block.unit(text) == whole.unit(text)
        assert not block["O4.theta"].flags.writeable
        with pytest.raises(mk.ExpressionError):
            block["O4.theta + 1 in"]
        first += block.rows
    assert first == whole.rows


def test_a_stream_may_be_gone_through_again_and_left() -> None:
    stream = mk.load(FILE_OF["rcsr"]).stream(["O4.theta"], rows=5)
    first = [block["O4.theta"].tobytes() for block in stream]
    next(iter(stream))
    assert [block["O4.theta"].tobytes() for block in stream] == first
    assert stream.verdicts.rows == stream.run_rows == 27
    assert len(stream) == len(first) == 6


@pytest.mark.parametrize("rows", [0, -1, 2.5, "7"])
def test_a_block_has_a_whole_number_of_rows(rows: object) -> None:
    with pytest.raises(mk.UsageError, match="rows"):
        mk.load(FILE_OF["rcsr"]).stream(rows=rows)  # type: ignore[arg-type]


TWO_MOVE = """format: 1
plane: xy
units: {length: mm, angle: deg}
links: {bar: {}, slide: {}, arm: {}}
joints:
  A: {type: R, links: [ground, bar], point: [0, 0]}
  B: {type: P, links: [bar, slide], point: [0, 0], axis: [1, 0]}
  C: {type: R, links: [slide, arm], point: [0, 0]}
motion:
  inputs:
    A.theta: {from: -20, to: 900, count: 70000, rate: 3}
    B.s: {from: 1, to: 2, count: 70000}
    C.theta: {at: 30}
"""


def test_numbers_of_a_long_motion_are_those_of_all_its_rows() -> None:
    """Whichever parts were asked for before, and of whatever size."""
    motion = mk.loads(TWO_MOVE, "two").problem.motion
    assert isinstance(motion, LongRun)
    whole = motion.whole
    for first, last in ((0, 999), (1000, 1999), (69_000, 69_999), (5, 5), (7, 7), (0, 999)):
        part = motion.part(first, last)
        count = last + 1 - first
        assert (part.rows, part.span) == (count, Span(first, count, 70_000))
        for own, every in zip(part.inputs, whole.inputs, strict=True):
            rows = slice(first, last + 1)
            for number, (found, expected) in enumerate(zip(own[2:6], every[2:6], strict=True)):
                assert found.tobytes() == expected[rows].tobytes(), (own.name, number)
            expected = np.ascontiguousarray(every.written_orders[:, rows])
            assert own.written_orders.tobytes() == expected.tobytes(), own.name
