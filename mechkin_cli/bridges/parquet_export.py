"""Parquet: a run as one frame, for pandas, polars and DuckDB.

A line for each row: its number, its verdict, all coordinates, rates and efforts, the columns of the
file's tables, and the pose of each link (a shift, and a unit quaternion with the scalar first). The
unit of a column is in its metadata, as in tables of `--format parquet`; a missing number is null.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from mechkin_cli.bridges.parts import Exported, listed
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.mechanism import GROUND_NAME, is_written
from mechkin_cli.tables import (
    Columns,
    TableColumn,
    Words,
    column_of_numbers,
    heading_of,
    metadata_of,
    parquet_bytes,
    pyarrow_for,
    row_words,
)
from mechkin_cli.units import LENGTH
from mechkin_cli.view import continuous, link_poses

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.bridges.parts import ExportOptions
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats

POSE: Final = ("x", "y", "z", "q0", "q1", "q2", "q3")
"""What a link's columns are called behind its name."""


def export(model: Model, options: ExportOptions) -> Exported:
    """A run, or one of them for each run of the file, as Parquet; some of its rows, or all.

    Raises:
        UsageError: pyarrow is not there, or the run does not have a row that is named.
    """
    pyarrow_for("Parquet")  # before anything is computed
    files, notes = {}, []
    for analysis in model.analyses(options.run, options.mode):
        rows = _rows(analysis, options.rows)
        columns: dict[str, TableColumn] = {}
        twice = []
        for column in _columns(analysis):
            known = columns.setdefault(column.label, column)
            if known is not column and not _same(known, column):
                twice.append(column.label)
        frame = Columns(analysis.run, "", tuple(one.part(rows) for one in columns.values()))
        heading = heading_of(frame, ["row"])
        files[f"{model.stem}.{analysis.run}.parquet"] = parquet_bytes(
            heading.columns, frame.columns, metadata_of(heading)
        )
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


def _columns(analysis: Analysis) -> Iterator[TableColumn]:
    result = analysis.result
    yield TableColumn("row", "", np.arange(1.0, analysis.rows + 1))
    yield TableColumn("row.status", "", row_words("row.status", result))
    if "time" in result.inputs:
        yield column_of_numbers("time", analysis.unit("time"), analysis["time"])
    for name in _names(analysis):
        yield column_of_numbers(name, analysis.unit(name), analysis[name])
    for table in analysis.tables:
        if table.of_rows:
            yield from table.columns
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


def _poses(analysis: Analysis) -> Iterator[TableColumn]:
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
            yield column_of_numbers(f"{link}.pose.{word}", unit, np.asarray(values))


def _turned(poses: Floats, vector: Floats) -> Floats:
    """R v of each pose."""
    v = poses[:, 4:]
    across = np.cross(v, vector)
    found: Floats = vector + 2.0 * (poses[:, 3:4] * across + np.cross(v, across))
    return found


def _same(one: TableColumn, other: TableColumn) -> bool:
    if one.unit != other.unit or isinstance(one.values, Words) != isinstance(other.values, Words):
        return False
    if isinstance(one.values, Words):
        return np.array_equal(one.values.array(), other.values.array())  # type: ignore[union-attr]
    return np.array_equal(one.numbers, other.numbers, equal_nan=True)
