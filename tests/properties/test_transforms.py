"""The same mechanism written otherwise: answers change exactly as they should.

Both sides are computed in double precision and the drawing is rounded once more, so errors may be
twice those against the oracle.
"""

from __future__ import annotations

import re

import numpy as np
import pytest
from oracle import (
    in_other_units,
    mirrored,
    moved,
    mp,
    renamed,
    reordered,
    rotation_matrix,
    scaled,
    swapped_links,
)
from properties.answers import Values, answers, at_row, errors, kind, within
from properties.cases import CASES, case, original

TWICE = 2.0
SOME = CASES[::2]
FEW = CASES[::4]
MIRRORED = re.compile(r"\.(theta|y(_dot|_ddot|_dddot|\.effort|$))")
"""Coordinates and efforts that change sign in a mirror."""


def check(which: str, found: Values, wanted: Values) -> None:
    """At the row where the condition is known."""
    its = case(which)
    found, wanted = at_row(found, its.row), at_row(wanted, its.row)
    assert within(errors(found, wanted, its.size, its.condition), TWICE)


def is_place(name: str) -> bool:
    return name.endswith((".position", ".point"))


def is_moment(name: str) -> bool:
    return name.endswith(("moment", "moment_about_origin"))


def rotates(name: str) -> bool:
    """Whether mirroring treats it as an axial vector."""
    return name.endswith((".omega", ".alpha")) or is_moment(name)


def weight(which: str) -> np.ndarray:
    """The force of gravity on all links."""
    mechanism = case(which).mechanism
    mass = float(sum(link.mass for link in mechanism.links.values()))
    fields = [load.vector for load in mechanism.loads if load.type == "gravity"]
    return mass * np.array([[float(x) for x in field] for field in fields] or [[0.0] * 3]).sum(0)


@pytest.mark.parametrize("which", SOME)
def test_moved_and_turned(which):
    turn, shift = rotation_matrix(3, -1, 2, 1), [mp.mpf(2), mp.mpf(-1), mp.mpf("0.5")]
    found = answers(moved(case(which).text, turn, shift))
    matrix = np.array([[float(x) for x in row] for row in turn])
    offset = np.array([float(x) for x in shift])
    before = original(which)
    wanted = {n: v @ matrix.T if v.ndim == 2 else v for n, v in before.items()}
    for name in wanted:
        if is_place(name):
            wanted[name] = wanted[name] + offset
        elif name == "row.potential_energy":
            wanted[name] = wanted[name] - offset @ matrix @ weight(which)
        elif name.endswith(("moment_about_origin", "shaking_moment", "inertia_moment")):
            force = name.replace("moment_about_origin", "force").replace("moment", "force")
            wanted[name] = wanted[name] + np.cross(offset, wanted[force])
    check(which, found, wanted)


@pytest.mark.parametrize("which", SOME)
def test_mirrored(which):
    found = answers(mirrored(case(which).text))
    polar = np.array([-1.0, 1.0, 1.0])
    wanted = {}
    for name, value in original(which).items():
        if value.ndim == 2:
            wanted[name] = value * (-polar if rotates(name) else polar)
        else:
            wanted[name] = -value if MIRRORED.search(name) else value
    check(which, found, wanted)


@pytest.mark.parametrize("which", FEW)
def test_scaled(which):
    factor = 1.75
    found = answers(scaled(case(which).text, str(factor)))
    for name, value in found.items():
        its = kind(name)
        found[name] = value / factor ** (its.lengths + (its.order is None))
    check(which, found, original(which))


@pytest.mark.parametrize("which", SOME)
@pytest.mark.parametrize(
    ("units", "metre", "newton", "second"),
    [
        ({"length": "mm", "angle": "rad", "mass": "t", "force": "N"}, 1000.0, 1.0, 1.0),
        (
            {"length": "in", "angle": "turn", "mass": "lbm", "force": "lbf", "time": "min"},
            1 / 0.0254,
            1 / 4.4482216152605,
            1 / 60,
        ),
    ],
)
def test_in_other_units(which, units, metre, newton, second):
    """What one SI unit is in file units; angular rates stay in rad/s."""
    found = answers(in_other_units(case(which).text, units))
    for name in found:
        its = kind(name)
        factor = metre**its.lengths
        if its.order is None:
            factor *= newton
        elif its.lengths:
            factor /= second**its.order
        found[name] = found[name] / factor
    check(which, found, original(which))


@pytest.mark.parametrize("which", SOME)
def test_renamed(which):
    mechanism = case(which).mechanism
    old = (*mechanism.joints, *mechanism.links, *mechanism.points)
    names = {name: f"z_{name}" for name in old}
    found = answers(renamed(case(which).text, names))
    for name, value in original(which).items():
        owner, _, rest = name.partition(".")
        assert np.array_equal(found[f"{names.get(owner, owner)}.{rest}"], value)


@pytest.mark.parametrize("which", SOME)
def test_reordered(which):
    check(which, answers(reordered(case(which).text, seed=len(which))), original(which))


def swappable(which: str) -> list[str]:
    """A sphere stays with its link; an E counts in the axes of its first link; no driven U."""
    mechanism = case(which).mechanism
    driven = {name.split(".")[0] for name in mechanism.inputs}
    return [
        name
        for name, joint in mechanism.joints.items()
        if joint.type in "RPCHSW" or (joint.type == "U" and name not in driven)
    ]


def swapped(values: Values, joint: str) -> Values:
    """What is left to compare; point and moment belong to the other link afterwards."""
    wanted = {}
    for name, value in values.items():
        owner, _, rest = name.partition(".")
        if owner != joint or rest == "axis":
            wanted[name] = value
        elif rest.startswith(("theta1", "theta2")):
            other = {"1": "2", "2": "1"}[rest[5]]
            wanted[f"{joint}.theta{other}{rest[6:]}"] = -value
        elif rest not in ("point", "moment", "total_moment"):
            wanted[name] = -value
    return wanted


@pytest.mark.parametrize("which", FEW)
def test_swapped_links(which):
    """Every joint in turn."""
    for joint in swappable(which):
        found = answers(swapped_links(case(which).text, joint))
        check(which, found, swapped(original(which), joint))
