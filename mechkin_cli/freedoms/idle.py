"""Idle freedoms: motions of one link, or of a few as one body, that leave all others at rest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.freedoms.configurations import Configuration
from mechkin_cli.mechanism.model import Joint

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


class IdleFreedom(NamedTuple):
    """The links that move together, and how, in words."""

    links: tuple[str, ...]
    sentence: str


def idle_freedoms(
    configuration: Configuration, driven: Sequence[tuple[str, str]]
) -> tuple[IdleFreedom, ...]:
    """Freedoms that move no input and nothing but a link between two or more joints."""
    found: list[IdleFreedom] = []
    body = configuration.body
    known = np.zeros((body.count, 0))
    for names, border, motions in group_motions(configuration, driven):
        new = motions @ _split(motions - known @ (known.T @ motions))[0]
        if not new.shape[1]:
            continue
        known = np.linalg.qr(np.concatenate([known, new], axis=1))[0]
        for twist in _told(configuration.twists[names[0]] @ new).T:
            verb, how = _words(border, twist)
            verb = f"{verb} together" if len(names) > 1 else f"{verb}s"
            found.append(IdleFreedom(names, f"{' and '.join(names)} {verb} freely {how}"))
    return tuple(found)


def group_motions(
    configuration: Configuration, driven: Sequence[tuple[str, str]]
) -> Iterator[tuple[tuple[str, ...], tuple[Joint, ...], Floats]]:
    """Groups of links, few first, with the joints to others and their motions (freedoms, count) as
    one body that move no input and leave all others at rest."""
    body = configuration.body
    columns = [body.column(*each) for each in driven]
    for links, border in _groups(configuration):
        motions = _common_motions(configuration, links, border)
        names = tuple(name for name in body.links if name in links)
        yield names, tuple(border), motions @ _split(motions[columns])[1]


def _split(matrix: Floats) -> tuple[Floats, Floats]:
    """Orthonormal bases of what a matrix, with entries of the order of one, does not map to zero,
    and of what it does."""
    if not matrix.size:
        count = matrix.shape[1]
        return np.zeros((count, 0)), np.eye(count)
    _, values, right = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(values > tolerances.SAME_COMMON_MOTION))
    return right[:rank].T, right[rank:].T


def _told(twists: Floats) -> Floats:
    """Unit twists (6, count) that span the same: turns, then slides."""
    turning, sliding = _split(twists[:3] / np.linalg.norm(twists, axis=0).max())
    turns, slides = twists @ turning, twists @ sliding
    along = np.linalg.qr(slides[3:])[0]
    turns[3:] -= along @ (along.T @ turns[3:])  # no turn advances where a slide does
    basis: Floats = np.concatenate([turns, slides], axis=1)
    basis /= np.linalg.norm(basis, axis=0)
    return basis


def _groups(configuration: Configuration) -> Iterator[tuple[set[str], list[Joint]]]:
    """Groups of links between two others or more, with the joints to these; small groups first."""
    joints = configuration.body.mechanism.joints.values()
    links = configuration.body.links
    for count in range(1, min(tolerances.MOST_IDLE_LINKS, len(links) - 1) + 1):
        for chosen in combinations(links, count):
            group = set(chosen)
            border = [j for j in joints if (j.first in group) != (j.second in group)]
            inner = [j for j in joints if j.first in group and j.second in group]
            others = {end for j in border for end in (j.first, j.second)} - group
            if len(others) >= 2 and len(inner) >= count - 1:
                yield group, border


def _common_motions(configuration: Configuration, links: set[str], border: list[Joint]) -> Floats:
    """Motions (freedoms, count) of the links as one body that leave the others at rest: nothing but
    the joints around them moves."""
    body, twists = configuration.body, configuration.twists
    moving = [column for joint in border for column in body.columns[joint.name]]
    one = twists[min(links)]
    rest = [twists[n] if n not in links else twists[n] - one for n in body.links]
    matrix = np.concatenate([configuration.jacobian, *rest])[:, moving]
    _, values, right = np.linalg.svd(matrix, full_matrices=len(matrix) < len(moving))
    least = tolerances.RANK_ZERO * values.max(initial=0.0)  # welds alone have none
    found = np.zeros((body.count, len(moving) - int(np.count_nonzero(values > least))))
    found[moving] = right[len(moving) - found.shape[1] :].T
    return found


def _words(border: Sequence[Joint], twist: Floats) -> tuple[str, str]:
    """Verb, and about or along what."""
    spin, slide = twist[:3], twist[3:]
    names = ", ".join(joint.name for joint in border)
    if np.max(np.abs(spin)) < tolerances.MOBILITY_NO_TWIST:
        return "slide", f"along the axis of {names}"
    if abs(float(spin @ slide)) > tolerances.MOBILITY_NO_TWIST:
        return "move", f"along the thread of {names}"
    if all(joint.type.is_oriented for joint in border):
        return "spin", "about " + "-".join(joint.name for joint in border)
    return "turn", f"about the common axis of {names}"
