"""Proofs of assembly modes: that each exists, and that no two are the same."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.proofs.boxes import Boxes, Nodes, enclosed_of, prove_boxes
from mechkin_cli.record import NamedTuple
from mechkin_cli.verdict import Proof

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.plan import Layout
    from mechkin_cli.session import Session
    from mechkin_cli.show import Bools, Floats


# How far places of a mechanism are from each other, unknown by unknown.

FULL_TURN = 2.0 * np.pi


def balls(layout: Layout) -> list[slice]:
    """The columns of each orientation."""
    return [
        slice(carrier.column, carrier.column + 3)
        for carrier in layout.carriers
        if carrier.part.type.is_ball
    ]


def differences(layout: Layout, one: Floats, others: Floats) -> Floats:
    """Sizes of the ways from a place (states,) to others (columns, places), in rad and lengths of
    the kernel: angles up to whole turns; of an orientation the largest of the increments x that
    turn it by (1, x / 2), in all three columns."""
    found = np.zeros((sum(len(c.part.type.freedoms) for c in layout.carriers), others.shape[1]))
    for carrier in layout.carriers:
        kind, row, column = carrier.part.type, carrier.state, carrier.column
        if kind.is_ball:
            turn = _increments(one[row : row + 4], others[row : row + 4])
            found[column : column + 3] = turn
            continue
        for number, freedom in enumerate(kind.freedoms):
            off = others[row + number] - one[row + number]
            if freedom.is_cyclic:
                off -= FULL_TURN * np.rint(off / FULL_TURN)
            found[column + number] = np.abs(off)
    return found


def _increments(a: Floats, b: Floats) -> Floats:
    """Largest of the increments that turn an orientation to others (places,)."""
    w = np.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3])
    x = a[0] * b[1] - b[0] * a[1] - a[2] * b[3] + a[3] * b[2]
    y = a[0] * b[2] - b[0] * a[2] - a[3] * b[1] + a[1] * b[3]
    z = a[0] * b[3] - b[0] * a[3] - a[1] * b[2] + a[2] * b[1]
    size: Floats = 2.0 * np.maximum(np.maximum(np.abs(x), np.abs(y)), np.abs(z))
    # half a turn has no finite increments
    found: Floats = size / np.maximum(w, np.finfo(float).eps)
    return found


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
    enclosed = enclosed_of(session)
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
    off = differences(layout, states[:, one], states[:, others])
    reach = boxes.radius[:, one, None] + boxes.radius[:, others]
    for columns in balls(layout):
        reach[columns] = 2.0 * reach[columns].max(axis=0)
    return np.asarray((off > reach + tolerances.SAME_BOX * (1.0 + off)).any(axis=0))
