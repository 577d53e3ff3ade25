"""Parquet: a run as one frame, for pandas, polars and DuckDB.

A line for each row: its number, its verdict, all coordinates, rates and efforts, the columns of the
file's tables, and the pose of each link (a shift, and a unit quaternion with the scalar first). The
unit of a column is in its metadata, as in the results of a study; a missing number is null.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mechkin_cli.bridges.parts import Exported, listed
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.mechanism import GROUND_NAME, is_written
from mechkin_cli.studies import Format, Heading, format_of
from mechkin_cli.tables import Words
from mechkin_cli.units import LENGTH
from mechkin_cli.verdict import Status
from mechkin_cli.view import continuous, link_poses

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.bridges.parts import ExportOptions
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats

POSE: Final = ("x", "y", "z", "q0", "q1", "q2", "q3")
"""What a link's columns are called behind its name."""

Column = tuple[str, str, Any]
"""Label, unit, and numbers (rows,) or texts."""


def export(model: Model, options: ExportOptions) -> Exported:
    """A run, or one of them for each run of the file, as Parquet; some of its rows, or all.

    Raises:
        UsageError: pyarrow is not there, or the run does not have a row that is named.
    """
    kind = format_of("parquet")
    files, notes = {}, []
    for analysis in model.analyses(options.run, options.mode):
        rows = _rows(analysis, options.rows)
        columns: dict[str, tuple[str, Any]] = {}
        twice = []
        for label, unit, values in _columns(analysis):
            known = columns.setdefault(label, (unit, values))
            if known[1] is not values and not _same(known, (unit, values)):
                twice.append(label)
        files[f"{model.stem}.{analysis.run}.parquet"] = _frame(kind, columns, rows)
        if twice:
            notes.append(
                Diagnostic(
                    "left-out",
                    "warning",
                    f"several tables have a column {listed(dict.fromkeys(twice))}; the frame has "
                    "that of the first",
                    hint="give the columns labels of their own",
                )
            )
    return Exported(files, tuple(notes))


def _rows(analysis: Analysis, asked: tuple[int, ...]) -> list[int]:
    for row in asked:
        if row > analysis.rows:
            raise UsageError(
                f"--row {row}: the run {analysis.run} has {analysis.rows} rows; name one of them"
            )
    return [row - 1 for row in asked] or list(range(analysis.rows))


def _columns(analysis: Analysis) -> Iterator[Column]:
    result = analysis.result
    yield "row", "", np.arange(1, analysis.rows + 1, dtype=np.int64)
    words = [Status(int(code)).label for code in result.status]
    yield "row.status", "", words
    if "time" in result.inputs:
        yield "time", analysis.unit("time"), analysis["time"]
    for name in _names(analysis):
        yield name, analysis.unit(name), analysis[name]
    for table in analysis.tables:
        if table.of_rows:
            for column in table.columns:
                is_words = isinstance(column.values, Words)
                values = column.values.texts(range(column.rows)) if is_words else column.numbers  # type: ignore[union-attr]
                yield column.label, column.unit, values
    yield from _poses(analysis)


def _names(analysis: Analysis) -> Iterator[str]:
    """Coordinates with their rates, and the efforts of inputs."""
    mechanism = analysis.result.problem.mechanism
    known = analysis.result.problem.quantities()
    for name, joint in mechanism.joints.items():
        if is_written(name):
            for coordinate in joint.coordinates:
                yield from (one for one in (coordinate, f"{coordinate}_dot") if one in known)
            if f"{name}.effort" in known:
                yield f"{name}.effort"


def _poses(analysis: Analysis) -> Iterator[Column]:
    """Where the drawing of each link is: x = R x0 + shift of what is drawn at x0."""
    result = analysis.result
    mechanism = result.problem.mechanism
    links = [n for n in mechanism.links if is_written(n) and n != GROUND_NAME]
    poses = np.full((analysis.rows, len(links), 7), np.nan)
    solved = result.solved
    if solved.any():
        poses[solved] = continuous(link_poses(result, links)[solved])
    datum = np.array(mechanism.datum)
    for number, link in enumerate(links):
        pose = poses[:, number].copy()
        pose[:, :3] -= _turned(pose, datum)
        for k, word in enumerate(POSE):
            unit = result.units.label(LENGTH) if k < 3 else ""
            values = result.units.from_si(pose[:, k], LENGTH) if k < 3 else pose[:, k]
            yield f"{link}.pose.{word}", unit, np.asarray(values)


def _turned(poses: Floats, vector: Floats) -> Floats:
    """R v of each pose."""
    v = poses[:, 4:]
    across = np.cross(v, vector)
    found: Floats = vector + 2.0 * (poses[:, 3:4] * across + np.cross(v, across))
    return found


def _same(one: tuple[str, Any], other: tuple[str, Any]) -> bool:
    if one[0] != other[0] or isinstance(one[1], list) != isinstance(other[1], list):
        return False
    if isinstance(one[1], list):
        return bool(one[1] == other[1])
    return bool(np.array_equal(one[1], other[1], equal_nan=True))


def _frame(kind: Format, columns: dict[str, tuple[str, Any]], rows: list[int]) -> bytes:
    headings, records = [], {}
    for label, (unit, values) in columns.items():
        if isinstance(values, list):
            word, chosen = "text", np.array([values[row] for row in rows], dtype=object)
        else:
            chosen = np.asarray(values)[rows]
            word = "whole" if chosen.dtype == np.int64 else "number"
        headings.append(Heading(label, unit, word))
        records[label] = chosen
    return kind.piece(headings, records)
