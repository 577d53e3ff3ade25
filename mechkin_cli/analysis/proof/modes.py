"""Proofs of assembly modes: that each exists, and that no two are the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.proof.enclosures import FULL_TURN
from mechkin_cli.proof import Proof
from mechkin_cli.solver.proofs import Boxes, Enclosed, Nodes, prove_boxes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Session


class ModeProofs(NamedTuple):
    """What is proven of each mode, and whether all of those that are proven are different."""

    modes: tuple[Proof, ...]
    all_different: bool

    @property
    def sentence(self) -> str:
        """In words."""
        proven = [proof for proof in self.modes if proof is not Proof.not_proven]
        if not self.modes:
            return "there is no mode to prove"
        if not proven:
            return "no mode could be proven to exist"
        count = f"{len(proven)} of {len(self.modes)}"
        words = "proven" if all(proof is Proof.proven for proof in proven) else "proven to closure"
        text = f"{count} {words} to exist" if words == "proven" else f"{count} {words}"
        if len(proven) < 2:
            return text
        same = (
            "all of them proven to be different" if self.all_different else "some may be the same"
        )
        return f"{text}, {same}"


def prove_modes(session: Session, place: Floats, states: Floats) -> ModeProofs:
    """Proofs of assemblies (states, modes) at some inputs (inputs,) in kernel units."""
    count = states.shape[1]
    inputs = np.repeat(place[:, None], count, axis=1)
    enclosed = session.once("enclosed", lambda: Enclosed.of(session))
    boxes = prove_boxes(enclosed, Nodes.of(session, inputs, inputs, states))
    proven = np.flatnonzero(boxes.proven)
    different = all(
        _apart(session.layout, states, boxes, int(one), proven[k + 1 :]).all()
        for k, one in enumerate(proven)
    )
    found = [
        Proof.not_proven if not ok else Proof.proven if beyond == 0.0 else Proof.proven_to_closure
        for ok, beyond in zip(boxes.proven, boxes.beyond, strict=True)
    ]
    return ModeProofs(tuple(found), different)


def _apart(
    layout: Layout, states: Floats, boxes: Boxes, one: int, others: NDArray[np.intp]
) -> Bools:
    """Which other boxes have no place in common with one of them."""
    apart = np.zeros(others.size, dtype=bool)
    for carrier in layout.carriers:
        kind, row = carrier.part.type, carrier.state
        if kind.is_ball:
            turn = _increments(states[row : row + 4, one], states[row : row + 4][:, others])
            columns = slice(carrier.column, carrier.column + 3)
            reach = boxes.radius[columns, one].max() + boxes.radius[columns][:, others].max(axis=0)
            apart |= turn > 2.0 * reach + tolerances.SAME_BOX
            continue
        for number, freedom in enumerate(kind.freedoms):
            off = states[row + number, others] - states[row + number, one]
            if freedom.is_cyclic:
                off -= FULL_TURN * np.rint(off / FULL_TURN)
            column = carrier.column + number
            reach = boxes.radius[column, one] + boxes.radius[column, others]
            apart |= np.abs(off) > reach + tolerances.SAME_BOX * (1.0 + np.abs(off))
    return apart


def _increments(one: Floats, others: Floats) -> Floats:
    """Largest of the increments x that turn an orientation by (1, x / 2) to others (modes,)."""
    a, b = one, others
    w = np.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3])
    x = a[0] * b[1] - b[0] * a[1] - a[2] * b[3] + a[3] * b[2]
    y = a[0] * b[2] - b[0] * a[2] - a[3] * b[1] + a[1] * b[3]
    z = a[0] * b[3] - b[0] * a[3] - a[1] * b[2] + a[2] * b[1]
    size: Floats = 2.0 * np.maximum(np.maximum(np.abs(x), np.abs(y)), np.abs(z))
    # half a turn has no finite increments
    found: Floats = size / np.maximum(w, np.finfo(float).eps)
    return found
