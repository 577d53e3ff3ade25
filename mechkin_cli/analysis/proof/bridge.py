"""Joins two rows that no one tube joins, by closing the mechanism at places between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.proofs import Enclosed, Nodes, prove_boxes, prove_tubes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.solver.session import Session


def bridge(enclosed: Enclosed, ends: Nodes) -> int:
    """The tubes that join two nodes; 0 where the branch is not proven to lead from one to the
    other.

    A long way is cut into parts at once. Where a tube is missing its middle is closed, and both
    halves are tried: near a dead centre the places go there by halves of what is left.
    """
    nodes = _cut(enclosed.session, ends)
    if nodes is None:
        return 0
    most = nodes.states.shape[1] + tolerances.BRIDGE_NODES
    while True:
        boxes = prove_boxes(enclosed, nodes)
        tubes = prove_tubes(enclosed, nodes, boxes)
        if tubes.joined.all():
            return tubes.number
        missing = np.flatnonzero(~tubes.joined)
        length = np.abs(np.diff(nodes.values, axis=1)).max(axis=0, initial=0.0)
        is_hopeless = (
            not boxes.proven.all()
            or nodes.states.shape[1] + missing.size > most
            or bool((length[missing] < tolerances.BRIDGE_STEP).any())
        )
        middle = None if is_hopeless else _middles(enclosed.session, nodes, missing)
        if middle is None:
            return 0
        nodes = nodes.inserted(missing, middle)


def _cut(session: Session, ends: Nodes) -> Nodes | None:
    """Two nodes and closed places between them, so that no input goes farther than `BRIDGE_PART`
    from one to the next; None where these would be more than `BRIDGE_PARTS`, or the branch ends."""
    length = float(np.abs(np.diff(ends.values, axis=1)).max(initial=0.0))
    parts = int(min(length / tolerances.BRIDGE_PART, tolerances.BRIDGE_PARTS)) + 1
    if parts == 1:
        return ends
    if parts > tolerances.BRIDGE_PARTS:
        return None
    way = np.arange(1, parts) / parts
    values = ends.values[:, :1] + way * (ends.values[:, 1:] - ends.values[:, :1])
    places = ends.between(np.zeros(parts - 1, dtype=np.intp), values, ends.states[:, :1])
    reduced = np.concatenate([ends.reduced[:, :1], places.reduced], axis=1)
    found = session.follow(reduced, ends.states[:, 0], every_row=True)
    if found.reached < parts:
        return None
    closed = session.close(places.reduced, found.guess[:, 1:])
    if not closed.good.all():
        return None
    return ends.inserted(np.zeros(parts - 1, dtype=np.intp), places._replace(states=closed.states))


def _middles(session: Session, nodes: Nodes, before: NDArray[np.intp]) -> Nodes | None:
    """The closed places half way between nodes and the next, followed from there; None where the
    branch does not lead so far."""
    values = 0.5 * (nodes.values[:, before] + nodes.values[:, before + 1])
    places = nodes.between(before, values, nodes.states[:, before])
    guess = np.empty_like(places.states)
    for k, node in enumerate(before):
        way = np.stack([nodes.reduced[:, node], places.reduced[:, k]], axis=1)
        found = session.follow(way, nodes.states[:, node], every_row=True)
        if found.reached < 2:
            return None
        guess[:, k] = found.guess[:, 1]
    closed = session.close(places.reduced, guess)
    return places._replace(states=closed.states) if closed.good.all() else None
