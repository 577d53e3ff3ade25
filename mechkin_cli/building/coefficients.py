"""Checks `coefficients:` - rows, balls and directions that exist, names that no table has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.run_names import runs_of
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.runs import SWEEP
from mechkin_cli.tables.layout import CoefficientsLayout

if TYPE_CHECKING:
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.schema.coefficients import Coefficients
    from mechkin_cli.schema.file import MechanismFile
    from mechkin_cli.tables.layout import TableLayout


def build_coefficients(
    fields: Fields,
    file: MechanismFile,
    problem: Problem,
    tables: Sequence[TableLayout],
) -> tuple[CoefficientsLayout, ...]:
    """The layouts; what is wrong is noted in `fields`."""
    found: list[CoefficientsLayout] = []
    for number, section in enumerate(file.coefficients):
        path: Path = ("coefficients", number)
        if section.row > problem.motion.rows:
            text = f"the sweep has {problem.motion.rows} rows"
            fields.error("unknown-row", (*path, "row"), text, f"write 1 to {problem.motion.rows}")
        along = _along(fields, (*path, "along"), section, problem)
        layout = CoefficientsLayout(
            section.name, section.title or section.name, section.row, along, section.counted
        )
        taken = {one.name.casefold() for one in tables}
        taken |= {name.casefold() for other in found for name in other.names}
        for name in layout.names:
            if name.casefold() in taken:
                text = f"another table is written to {name}"
                fields.error("table-clash", (*path, "name"), text, "rename one of them")
        found.append(layout)
    if found and SWEEP not in runs_of(file):
        text = "coefficients: are told at a row of the sweep, and the file has responses alone"
        fields.error("no-sweep", ("coefficients",), text, "add motion:, or leave them out")
    if found and problem.mechanism.frictions:
        text = "coefficients: cannot be told where joints rub: friction is no linear function"
        fields.error("rubbing", ("coefficients",), text, "leave out coefficients: or the friction")
    if found and problem.hold_idle:
        text = "coefficients: cannot be told where idle freedoms are held against loads"
        fields.error("held-idle", ("coefficients",), text, "leave out coefficients: or idle: hold")
    return tuple(found)


def _along(
    fields: Fields, path: Path, section: Coefficients, problem: Problem
) -> dict[str, tuple[str, str]]:
    mechanism = problem.mechanism
    found: dict[str, tuple[str, str]] = {}
    for name, directions in section.along.items():
        joint = mechanism.joints.get(name)
        if joint is None or not joint.type.is_ball:
            balls = [one.name for one in mechanism.joints.values() if one.type.is_ball]
            hint = f"balls are {', '.join(balls)}" if balls else "the mechanism has none"
            fields.error("no-ball", (*path, name), f"{name} is no ball of the mechanism", hint)
            continue
        unknown = [one for one in directions if one not in mechanism.directions]
        for one in unknown:
            hint = nearest_hint(one, mechanism.directions) or "name it in directions:"
            place = (*path, name, directions.index(one))
            fields.error("unknown-name", place, f"there is no direction {one}", hint)
        if not unknown:
            found[name] = (directions[0], directions[1])
    return found
