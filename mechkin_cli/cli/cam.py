"""What `mechkin cam` does: shows a cam's table and its extremes, and writes its drawings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import tables
from mechkin_cli.cli.answer import answer
from mechkin_cli.cli.messages import ExitCode, Record, put, say, stem_of
from mechkin_cli.cli.show import files_line, shown_table
from mechkin_cli.record import replace

if TYPE_CHECKING:
    from mechkin_cli.cams import Cam
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats
    from mechkin_cli.tables import TableColumn


MOST_ROWS = 40
"""Rows shown; the files have all."""


def cam(
    file: Path,
    coupling: str | None = None,
    points: int = 360,
    out: Path | None = None,
    set_: list[str] | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """The profile of a cam."""
    folder = Path("out") / stem_of(file) if out is None else out
    return answer(
        file,
        set_,
        json,
        "profile of the cam",
        ask=lambda model: model.cam(coupling, points),
        is_answered=lambda found: True,
        record_of=lambda model, found: _record(model, found, folder),
        show=lambda model, found: _show(model, found, folder, quiet),
    )


def _record(model: Model, found: Cam, folder: Path) -> Record:
    written = tables.write_files(folder, found.files())
    record: Record = {
        "name": model.name,
        "coupling": found.name,
        "units": {"angle": found.angle, "length": found.length},
        "columns": {c.label: list(map(_number, _values(c))) for c in found.table.columns},
        "greatest_pressure_angle": found.greatest_pressure_angle._asdict(),
    }
    for word in ("least_radius", "hollow_radius"):
        extreme = getattr(found, word)
        record[word] = None if extreme is None else extreme._asdict()
    for word in ("undercut", "lift_off"):
        record[word] = [list(stretch) for stretch in getattr(found, word)]
    record["files"] = [str(path) for path in written]
    record["diagnostics"] = [diagnostic.record() for diagnostic in found.diagnostics]
    return record


def _values(column: TableColumn) -> Floats:
    assert not isinstance(column.values, tables.Words)
    return column.values


def _number(value: float) -> float | None:
    return float(value) if abs(value) < float("inf") else None


def _show(model: Model, found: Cam, folder: Path, quiet: bool) -> None:
    written = tables.write_files(folder, found.files())
    rows = range(0, found.turn.size, -(-found.turn.size // MOST_ROWS))
    columns = tuple(replace(c, values=_values(c)[rows]) for c in found.shown.columns)
    put(shown_table(replace(found.table, columns=columns), len(rows)))
    if quiet:
        return
    left_out = found.turn.size - len(rows)
    if left_out:
        say(f"({left_out} of {found.turn.size} rows left out here; all are in {folder})")
    say(f"{model.name}: cam {found.name}")
    for note in found.notes():
        say(f"  {note}")
    say(files_line(folder, written, []))
