"""Idle freedoms: motions of one link, or of a few as one body, that leave all others at rest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.configurations import Configuration
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
    taken: list[tuple[set[str], Floats]] = []
    columns = [configuration.body.column(*each) for each in driven]
    for links, border in _groups(configuration):
        if any(known <= links for known, _ in taken):
            continue
        motions = _common_motions(configuration, links, border)
        if motions.shape[1] != 1:
            continue
        twist = configuration.twists[min(links)] @ motions[:, 0]
        rates = motions[:, 0] / np.sqrt(twist @ twist)
        twist = twist / np.sqrt(twist @ twist)
        if not np.abs(rates[columns]).max(initial=0.0) > tolerances.RANK_ZERO:
            names = tuple(n for n in configuration.body.links if n in links)
            verb, how = _words(border, twist)
            verb = f"{verb} together" if len(names) > 1 else f"{verb}s"
            sentence = f"{' and '.join(names)} {verb} freely {how}"
            found.append(IdleFreedom(names, sentence))
            taken.append((links, twist))
    return tuple(found)


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
    least = tolerances.RANK_ZERO * values[0]
    found = np.zeros((body.count, len(moving) - int(np.count_nonzero(values > least))))
    found[moving] = right[len(moving) - found.shape[1] :].T
    return found


def _words(border: list[Joint], twist: Floats) -> tuple[str, str]:
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
