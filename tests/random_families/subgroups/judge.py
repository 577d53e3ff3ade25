"""The verdict on one random linkage of a subgroup: it is proven, holds what a closed form says at
40 digits, and is not proven where one number of its text is off."""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from oracle.numerics import mpmath_context as mp
from random_families.subgroups.linkage import FAMILIES, TILTS, Linkage, Tilt

import mechkin_cli as mk

ROWS = 5
OFF = ("+1e-6", "-1e-9", "+1e-12", "-1e-15", "+1e-30")


@dataclass(frozen=True)
class Outcome:
    """What one seed came to."""

    text: str
    fault: str = ""
    remark: str = ""
    figures: dict[str, float] = field(default_factory=dict)


def written(linkage: Linkage, tilt: Tilt, off: str = "", at: str = "") -> str:
    """The mechanism file; `off` is added to a number of the point, in a spherical loop, or of the
    axis of joint `at`, that takes it out of its subgroup."""
    links = sorted({link for joint in linkage.joints.values() for link in joint.links})
    lines = [
        "format: 1",
        "name: a linkage",
        "units: {length: m, angle: deg}",
        tilt.parameters.strip(),
    ]
    lines += [f"links: {{{', '.join(f'{link}: {{}}' for link in links if link != 'ground')}}}"]
    lines.append("joints:")
    spherical = linkage.meets
    for name, joint in linkage.joints.items():
        # the first component leaves some normals, the last one some planes
        number = 2 if joint.kind == "P" else 0
        point = tilt.written(joint.point, off if spherical and name == at else "", unit="1 m")
        axis = tilt.written(joint.axis, "" if spherical or name != at else off, number)
        ends = ", ".join(joint.links)
        lines.append(
            f"  {name}: {{type: {joint.kind}, links: [{ends}], point: {point}, axis: {axis}}}"
        )
    rows = f"{{from: 0, to: {float(linkage.step) * (ROWS - 1)}, step: {linkage.step}}}"
    lines += ["motion:", "  inputs:", f"    {linkage.input}: {rows}"]
    return "\n".join(line for line in lines if line) + "\n"


def run_one(seed: int) -> Outcome:
    """The linkage of a seed as it is, and with a number off."""
    rng = random.Random(f"subgroups {seed}")
    name = list(FAMILIES)[seed % len(FAMILIES)]
    linkage, tilt = FAMILIES[name](rng), rng.choice(TILTS)(rng)
    text = written(linkage, tilt)
    found = judged(linkage, text)
    if found.fault or not linkage.exact:
        return Outcome(text, found.fault, f"{name} {found.remark}", found.figures)
    wrong = written(linkage, tilt, rng.choice(OFF), rng.choice(list(linkage.joints)))
    try:
        status = mk.loads(wrong).certify().status
    except mk.MechkinError:
        return Outcome(text, "", f"{name} {found.remark}", found.figures)
    if (status == "proven").any():
        return Outcome(wrong, "proven with a number off")
    return Outcome(text, "", f"{name} {found.remark}", found.figures)


def judged(linkage: Linkage, text: str) -> Outcome:
    """Whether all rows are proven and hold what they should."""
    proofs = mk.loads(text).certify()
    low, high = proofs.enclosure(linkage.output)
    analysis, width = proofs.analysis, 0.0
    rows = np.flatnonzero(analysis.result.solved)
    for row in rows:
        if proofs.status[row] != "proven":
            return Outcome(text, f"row {row + 1} is {proofs.status[row]}")
        with mp.workdps(40):
            theta = mp.mpf(linkage.step) * int(row)
            true = linkage.reference(theta, partial(_double, analysis, int(row)))
            low_off, high_off = true - mp.mpf(float(low[row])), mp.mpf(float(high[row])) - true
        if not (low_off >= 0 and high_off >= 0):
            return Outcome(text, f"row {row + 1} does not hold {mp.nstr(true, 20)}")
        width = max(width, float(high[row] - low[row]))
    return Outcome(text, "", "proven" if rows.size else "not assembled", {"width": width})


def _double(analysis: Any, row: int, name: str) -> float:
    return float(analysis[name][row])
