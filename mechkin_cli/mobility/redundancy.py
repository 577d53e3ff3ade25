"""Redundant constraints: which joints carry them, as which forces and moments, and a cure.

A stress is a set of joint wrenches in equilibrium without load: a null vector of the transposed
screws of the loops. In a single loop every joint carries the same wrench, which no joint of the
loop gives way to.
"""

from __future__ import annotations

from collections.abc import Container, Iterator
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import Joint, joint_type
from mechkin_cli.mobility.configurations import Configuration
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class Redundancy(NamedTuple):
    """`number` redundant constraints that `joints` carry together, as `wrenches` (words, empty
    where they differ from joint to joint), and a `cure` (None if none of the usual ones does)."""

    number: int
    joints: tuple[str, ...]
    wrenches: str
    cure: str | None

    @property
    def sentence(self) -> str:
        """The redundancy in words."""
        who = ", ".join(self.joints)
        carry = f"the loop through {who} carries" if self.wrenches else f"the joints {who} carry"
        text = f"{carry} {self.number} redundant constraint{'s' * (self.number > 1)}"
        text += f": {self.wrenches}" if self.wrenches else ""
        return f"{text}; {self.cure}" if self.cure else text


def redundancies(
    configuration: Configuration, stresses: Floats, driven: Container[str]
) -> tuple[Redundancy, ...]:
    """The redundant constraints, one entry per group of joints that stress each other.

    A cure leaves the `driven` joints alone.
    """
    if stresses.shape[1] == 0:
        return ()
    joints = list(configuration.body.mechanism.joints.values())
    places = {joint.name: list(range(6 * k, 6 * k + 6)) for k, joint in enumerate(joints)}
    # an orthonormal basis (6 joints, count) of the wrenches that the joints carry
    cuts = stresses.reshape(-1, 6, stresses.shape[1])
    signs = configuration.body.signs
    rows = [np.add.reduce(signs[joint.name][:, None, None] * cuts) for joint in joints]
    carried = np.linalg.qr(np.concatenate(rows))[0]
    shares = carried @ carried.T
    found = []
    for group in _groups(joints, places, shares):
        every = [i for joint in group for i in places[joint.name]]
        number = round(float(np.trace(shares[np.ix_(every, every)])))
        if number:
            words = _wrenches(configuration, group, carried[places[group[0].name]], number)
            names = tuple(joint.name for joint in group)
            softer = [joint for joint in group if joint.name not in driven]
            cure = _cure(configuration, softer, number)
            found.append(Redundancy(number, names, words, cure))
    return tuple(found)


def _groups(
    joints: list[Joint], places: dict[str, list[int]], shares: Floats
) -> Iterator[list[Joint]]:
    """Joints that carry stresses, in groups that do not stress each other."""

    def touch(one: Joint, other: Joint) -> bool:
        block = shares[np.ix_(places[one.name], places[other.name])]
        return bool(np.abs(block).max() > tolerances.MOBILITY_NO_WRENCH)

    left = [joint for joint in joints if touch(joint, joint)]
    while left:
        group, grown = [left.pop(0)], True
        while grown:
            grown = False
            for joint in list(left):
                if any(touch(joint, other) for other in group):
                    group.append(joint)
                    left.remove(joint)
                    grown = True
        yield sorted(group, key=joints.index)


def _wrenches(
    configuration: Configuration, group: list[Joint], carried: Floats, number: int
) -> str:
    """The stress of a single loop in words, of what its first joint carries (6, count); empty for
    several loops."""
    links = {link for joint in group for link in (joint.first, joint.second)}
    if len(links) != len(group):
        return ""
    left, _, _ = np.linalg.svd(carried)
    return _described(left[:, :number], configuration)


def _described(wrenches: Floats, configuration: Configuration) -> str:
    """A space of wrenches (6, count; moment first, scaled, about the centre) as forces and
    moments."""
    left, values, right = np.linalg.svd(wrenches[3:])
    forces = int(np.count_nonzero(values > tolerances.MOBILITY_NO_WRENCH))
    moments = (wrenches @ right[forces:].T)[:3]
    parts = []
    if moments.shape[1]:
        parts.append(_directions("moment", "about", np.linalg.svd(moments)[0], moments.shape[1]))
    if forces == 1 and not moments.shape[1]:
        parts.append(_line(wrenches[:, 0]))
    elif forces:
        place = "" if moments.shape[1] else _point(wrenches, configuration)
        parts.append(_directions("force", "along", left, forces) + place)
    return ", ".join(parts)


def _directions(noun: str, word: str, basis: Floats, count: int) -> str:
    """A space of directions: the first `count` columns of an orthonormal basis."""
    if count == 3:
        return f"{noun}s {word} all axes"
    if count == 1:
        return f"{noun} {word} {_axis(basis[:, 0])}"
    normal = basis[:, 2]
    named = [
        name
        for name, part in zip("xyz", normal, strict=True)
        if abs(part) < tolerances.MOBILITY_NO_WRENCH
    ]
    if len(named) == 2:
        return f"{noun}s {word} {' and '.join(named)}"
    return f"{noun}s {word} axes square to {_axis(normal)}"


def _line(wrench: Floats) -> str:
    """A single wrench by its axis and pitch (moment / force)."""
    moment, force = wrench[:3], wrench[3:]
    square = float(force @ force)
    pitch = float(force @ moment) / square
    axis = f"along {_axis(force / np.sqrt(square))}"
    if abs(pitch) < tolerances.MOBILITY_NO_WRENCH:
        return f"force {axis}"
    return f"force {axis} together with a moment about it"


def _point(wrenches: Floats, configuration: Configuration) -> str:
    """Through which point all the forces go, or that they go through none."""
    # p x force as a matrix on p
    rows = np.array(
        [row for x, y, z in wrenches[3:].T for row in ((0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0))]
    )
    moments = wrenches[:3].T.ravel()
    point = np.linalg.lstsq(rows, moments, rcond=None)[0]
    if np.abs(rows @ point - moments).max() > tolerances.MOBILITY_NO_WRENCH:
        return ", each with a moment of its own"
    near = [
        joint.name
        for joint in configuration.body.mechanism.joints.values()
        if np.abs(configuration.point(joint) - point).max() < tolerances.MOBILITY_NO_WRENCH
    ]
    return f" through {near[0]}" if near else " through one point"


def _axis(direction: Floats) -> str:
    for name, part in zip("xyz", direction, strict=True):
        if abs(part) > 1.0 - tolerances.MOBILITY_NO_WRENCH:
            return name
    sign = 1.0 if direction[np.argmax(np.abs(direction))] > 0.0 else -1.0
    parts = np.where(np.abs(direction) > tolerances.MOBILITY_NO_WRENCH, sign * direction, 0.0)
    return "(" + ", ".join(f"{part:.4g}" for part in parts) + ")"


def _cure(configuration: Configuration, group: list[Joint], number: int) -> str | None:
    """The fewest softer joints that take away all redundancy and free no motion."""
    options = [(joint, letter) for joint in group for letter in joint.type.softer]
    rank = _rank(configuration.jacobian)
    for count in range(1, tolerances.MOST_CHANGES + 1):
        for changes in combinations(options, count):
            freed = sum(
                joint_type(letter).freedoms - joint.type.freedoms for joint, letter in changes
            )
            if freed != number or len({joint.name for joint, _ in changes}) < count:
                continue
            softer = [configuration.wider(joint, letter) for joint, letter in changes]
            if _rank(np.concatenate([configuration.jacobian, *softer], axis=1)) == rank + number:
                words = (f"{joint.name} as {letter}" for joint, letter in changes)
                return f"none is left with {' and '.join(words)}"
    return None


def _rank(matrix: Floats) -> int:
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.count_nonzero(values > tolerances.RANK_ZERO * values.max(initial=0.0)))
