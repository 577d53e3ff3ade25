"""The same mechanism written otherwise: enclosures of the same numbers overlap, and are of like
width."""

from __future__ import annotations

import re

import numpy as np
import pytest
from oracle import in_other_units, moved, mp, renamed, reordered, rotation_matrix
from oracle.document import Document, to_text
from properties.cases import case
from properties.test_enclosures import enclosures

from mechkin_cli.proofs.enclose import Enclosure

SOME = ("loop 1", "loop 6", "structure 0")
ALIKE = 1e4
"""Between the largest radii of one kind: other trees, frames and origins round otherwise."""

Found = dict[str, Enclosure]


def found_in(source: str | Document) -> Found:
    return enclosures(source if isinstance(source, str) else to_text(source))[1]


def check(one: Found, other: Found) -> None:
    """Of quantities of one name, with rows in one order."""
    assert one.keys() <= other.keys()
    widest = [0.0, 0.0]
    for name, a in one.items():
        b = other[name]
        off = (a.high - b.high) + (a.low - b.low)
        if name.endswith((".theta", ".theta1", ".theta2")):
            off -= 2 * np.pi * np.rint(off / (2 * np.pi))
            off[np.abs(off) < 1e-15] = 0.0  # turns are rounded
        known = np.isfinite(a.radius)
        assert (known == np.isfinite(b.radius)).all(), name
        reach = (a.radius + b.radius) * (1.0 + 1e-9)
        assert (np.abs(off) <= reach)[known].all(), name
        size = np.abs(a.high).max(initial=1e-300)
        for k, each in enumerate((a, b)):
            widest[k] = max(widest[k], float(each.radius[known].max(initial=0.0)) / size)
    assert 1 / ALIKE < widest[0] / widest[1] < ALIKE


def scalars(found: Found) -> Found:
    """What neither turns nor moves with the drawing."""
    energy = "row.potential_energy"
    return {name: one for name, one in found.items() if len(one.high) == 1 and name != energy}


@pytest.mark.parametrize("which", SOME)
def test_renamed(which: str) -> None:
    mechanism = case(which).mechanism
    names = {name: f"z_{name}" for name in (*mechanism.joints, *mechanism.links, *mechanism.points)}
    other = found_in(renamed(case(which).text, names))
    back = {new: old for old, new in names.items()}
    parts = {name: name.partition(".") for name in other}
    by_old = {f"{back.get(owner, owner)}.{rest}": other[n] for n, (owner, _, rest) in parts.items()}
    check(found_in(case(which).text), by_old)


@pytest.mark.parametrize("which", SOME)
def test_reordered(which: str) -> None:
    check(found_in(case(which).text), found_in(reordered(case(which).text, 3)))


@pytest.mark.parametrize("which", SOME)
def test_in_other_units(which: str) -> None:
    units = {"length": "mm", "angle": "rad", "mass": "t", "force": "N"}
    check(found_in(case(which).text), found_in(in_other_units(case(which).text, units)))


@pytest.mark.parametrize("which", SOME)
def test_turned(which: str) -> None:
    turn, shift = rotation_matrix(3, -1, 2, 1), [mp.mpf(2), mp.mpf(-1), mp.mpf("0.5")]
    turned = scalars(found_in(moved(case(which).text, turn, shift)))
    check(scalars(found_in(case(which).text)), turned)


@pytest.mark.parametrize("which", SOME)
def test_backwards(which: str) -> None:
    """Rows in reverse; what drives them has the same rates."""
    text = case(which).text
    other = re.sub(r"from: (\S+ \w+), to: (\S+ \w+), ", r"from: \2, to: \1, ", text)
    assert other != text
    back = {n: Enclosure(*(part[:, ::-1] for part in one)) for n, one in found_in(other).items()}
    check(found_in(text), back)


@pytest.mark.parametrize("which", SOME)
def test_with_what_nothing_needs(which: str) -> None:
    """A pendulum of its own, driven at rest, and a loop of it."""
    text = case(which).text
    other = text.replace("links:\n", "links:\n  Q1: {}\n  Q2: {}\n  Q3: {}\n", 1)
    corners = ("[0, 0, 0]", "[1, 0, 0]", "[3, 2, 0]", "[4, 0, 0]")
    links = ("ground, Q1", "Q1, Q2", "Q2, Q3", "Q3, ground")
    joints = "".join(
        f"  QJ{k}: {{type: R, links: [{pair}], point: {at}, axis: [0, 0, 1]}}\n"
        for k, (pair, at) in enumerate(zip(links, corners, strict=True))
    )
    other = other.replace("joints:\n", f"joints:\n{joints}", 1)
    other = other.replace("  inputs:\n", "  inputs:\n    QJ0.theta: {at: 0}\n", 1)
    check(found_in(text), found_in(other))
