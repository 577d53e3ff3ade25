"""Poses that are told by three turns: where the middle one is a quarter turn, the others go about
one axis, and their rates are lost (gimbal lock)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel.functions import cos
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Bools
    from mechkin_cli.mechanism.model import Joint

_TROUBLE = (Status.branch_lost, Status.near_singular, Status.rank_unclear)


def middle_turn(joint: Joint) -> str | None:
    """The name of the turn between two others, None of a joint that has none."""
    for freedom, step in enumerate(joint.type.steps):
        if step.between:
            names = (n for n, number in joint.type.freedom_of.items() if number == freedom)
            return f"{joint.name}.{next(names)}"
    return None


def locked_in(result: Result, rows: Bools) -> str | None:
    """The middle turn of a pose that is a quarter turn in some of the rows."""
    for joint in result.problem.mechanism.joints.values():
        name = middle_turn(joint)
        if name is None:
            continue
        result.read([result.problem.quantities()[name]])
        angles = np.asarray(result.quantity(name).value)[rows & result.row_states.reached]
        if (np.abs(np.asarray(cos(angles))) < tolerances.POSE_LOCKED).any():
            return name
    return None


def locked_pose_notes(result: Result) -> list[Diagnostic]:
    """Says of poses whose turns are not given that rows may be lost through them alone."""
    if result.sound or not np.isin(result.status, [int(status) for status in _TROUBLE]).any():
        return []
    driven = {f"{joint}.{coordinate}" for joint, coordinate in result.problem.driven}
    found = []
    for joint in result.problem.mechanism.joints.values():
        name = middle_turn(joint)
        if name is None or name in driven:
            continue
        text = (
            f"where {name} is a quarter turn the turns before and after it go about one axis: "
            f"rows may be lost or singular there by how {joint.name} tells its pose alone"
        )
        hint = f"remove {joint.name} and read points and directions, or drive its turns"
        found.append(Diagnostic("locked-pose", "note", text, hint=hint))
    return found
