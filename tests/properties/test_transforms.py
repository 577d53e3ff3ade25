"""The same mechanism written otherwise: answers change exactly as they should.

Both sides are computed in double precision and the drawing is rounded once more, so errors may be
twice those against the oracle.
"""

from __future__ import annotations

from functools import cache

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
    swapped_links,
)
from properties.answers import Values, answers, at_row, errors, kind, within
from properties.loops import SEEDS, loop

TWICE = 2.0
SOME = SEEDS[::2]
FEW = SEEDS[::4]


@cache
def original(seed: int) -> Values:
    return answers(loop(seed).text)


def check(seed: int, found: Values, wanted: Values) -> None:
    """At the row where the condition is known."""
    case = loop(seed)
    found, wanted = at_row(found, case.row), at_row(wanted, case.row)
    assert within(errors(found, wanted, case.size, case.condition), TWICE)


def is_place(name: str) -> bool:
    return name.endswith((".position", ".point"))


def is_moment(name: str) -> bool:
    return name.endswith(("moment", "moment_about_origin"))


def rotates(name: str) -> bool:
    """Whether mirroring treats it as an axial vector, or a scalar about an axis."""
    return name.endswith((".omega", ".alpha")) or is_moment(name)


@pytest.mark.parametrize("seed", SOME)
def test_moved_and_turned(seed):
    turn, shift = rotation_matrix(3, -1, 2, 1), [mp.mpf(2), mp.mpf(-1), mp.mpf("0.5")]
    found = answers(moved(loop(seed).text, turn, shift))
    matrix = np.array([[float(x) for x in row] for row in turn])
    offset = np.array([float(x) for x in shift])
    before = original(seed)
    wanted = {n: v @ matrix.T if v.ndim == 2 else v for n, v in before.items()}
    for name in wanted:
        if is_place(name):
            wanted[name] = wanted[name] + offset
        elif name.endswith(("moment_about_origin", "shaking_moment", "inertia_moment")):
            force = name.replace("moment_about_origin", "force").replace("moment", "force")
            wanted[name] = wanted[name] + np.cross(offset, wanted[force])
    check(seed, found, wanted)


@pytest.mark.parametrize("seed", SOME)
def test_mirrored(seed):
    found = answers(mirrored(loop(seed).text))
    polar = np.array([-1.0, 1.0, 1.0])
    wanted = {}
    for name, value in original(seed).items():
        if value.ndim == 2:
            wanted[name] = value * (-polar if rotates(name) else polar)
        else:
            wanted[name] = -value if ".theta" in name else value
    check(seed, found, wanted)


@pytest.mark.parametrize("seed", SOME)
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
def test_in_other_units(seed, units, metre, newton, second):
    """What one SI unit is in file units; angular rates stay in rad/s."""
    case = loop(seed)
    found = answers(in_other_units(case.text, units))
    wanted = {}
    for name, value in original(seed).items():
        its = kind(name)
        factor = metre**its.lengths
        if its.order is None:
            factor *= newton
        elif its.lengths:
            factor /= second**its.order
        wanted[name] = value
        found[name] = found[name] / factor
    check(seed, found, wanted)


@pytest.mark.parametrize("seed", SOME)
def test_renamed(seed):
    mechanism = loop(seed).mechanism
    old = (*mechanism.joints, *mechanism.links, *mechanism.points)
    names = {name: f"z_{name}" for name in old}
    found = answers(renamed(loop(seed).text, names))
    for name, value in original(seed).items():
        owner, _, rest = name.partition(".")
        assert np.array_equal(found[f"{names.get(owner, owner)}.{rest}"], value)


@pytest.mark.parametrize("seed", SOME)
def test_reordered(seed):
    check(seed, answers(reordered(loop(seed).text, seed=seed)), original(seed))


@pytest.mark.parametrize("seed", FEW)
def test_swapped_links(seed):
    """Every joint in turn; its point and moment then belong to the other link."""
    for joint in loop(seed).mechanism.joints:
        own = [f"{joint}.{c}" for c in ("theta", "s", "force", "moment_about_origin")]
        wanted = {}
        for name, value in original(seed).items():
            if name not in (f"{joint}.point", f"{joint}.moment"):
                wanted[name] = -value if name.startswith(tuple(own)) else value
        check(seed, answers(swapped_links(loop(seed).text, joint)), wanted)
