"""A mechanism exported to MJCF and imported again, beside itself, in SI."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

import mechkin_cli as mk
from mechkin_cli.bridges import ExportOptions, exported, imported_robot
from mechkin_cli.expressions import ExpressionError
from mechkin_cli.mechanism import is_angle
from mechkin_cli.units import conversion, parse_unit

MECHANISMS = Path(__file__).parents[2] / "mechanisms"


def again(model: mk.Model, row: int) -> tuple[mk.Model, list[str]]:
    """The model imported from its export in a row, with that row's motion; and what was left
    out."""
    found = exported(model, "mjcf", ExportOptions(rows=(row + 1,)))
    (content,) = found.files.values()
    back = imported_robot(content.decode(), "model.xml")
    text = back.text
    for one in model.problem.motion.inputs:
        name = re.escape(re.sub(r"[^A-Za-z0-9_.]", "_", one.name))
        unit = "rad" if is_angle(one.coordinate) else "m"
        rates = (float(one.rates[row]), float(one.accelerations[row]))
        motion = f"rate: {rates[0]!r} {unit}/s, acceleration: {rates[1]!r} {unit}/s^2"
        text, count = re.subn(rf"(    {name}: {{at: [^}}]*)}}", rf"\1, {motion}}}", text)
        assert count == 1, (one.name, text)
    notes = [str(note) for note in (*found.notes, *back.notes) if note.code == "left-out"]
    return mk.loads(text), notes


def differences(model: mk.Model, row: int) -> dict[str, float]:
    """By how much quantities that both have differ in a row, relative to their largest component or
    to the mechanism's size, speed and so on."""
    back, left_out = again(model, row)
    ours, theirs = model.analyze(), back.analyze()
    mechanism = model.problem.mechanism
    names = []
    for coordinate in mechanism.coordinates:
        names += [coordinate, f"{coordinate}_dot", f"{coordinate}_ddot"]
    for point in mechanism.points:
        names += [f"{point}.{word}" for word in ("position", "velocity", "acceleration")]
    if not any("forces" in note or "friction" in note for note in left_out):
        names += [f"{'.'.join(pair)}.effort" for pair in model.problem.acting]
        names += [f"{pair[0]}.effort" for pair in model.problem.acting]
        names += [f"norm({joint}.force)" for joint in mechanism.joints]
    found: dict[str, float] = {}
    for name in names:
        try:
            values = [np.atleast_1d(run[name][k]) for run, k in ((ours, row), (theirs, 0))]
            factors = [unit_of(run, name) for run in (ours, theirs)]
        except (ExpressionError, mk.MechkinError):
            continue
        one, other = (value * factor for value, factor in zip(values, factors, strict=True))
        if np.isnan(one).any():
            continue
        if mechanism.plane and name.endswith("force)") and np.isnan(other).any():
            continue  # in space the reactions of a plane loop are not unique
        if one.size == 2:  # in a plane
            assert other[2] == 0.0
            other = other[:2]
        if name in mechanism.coordinates and is_angle(name.rpartition(".")[2]):
            # whole turns are counted from the first row on
            other = other + 2.0 * np.pi * np.round((one - other) / (2.0 * np.pi))
        found[name] = float(np.max(np.abs(one - other))) / max(1.0, float(np.max(np.abs(one))))
    return found


def unit_of(run: mk.Analysis, name: str) -> float:
    """The SI value of a quantity's unit."""
    text = run.unit(name)
    return float(conversion(parse_unit(text).factor).apply(1.0)) if text else 1.0
