"""Proofs of assembly modes: that each exists, and that no two are the same."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.proofs.boxes import Boxes, Nodes, differences, enclosed_of, prove_boxes
from mechkin_cli.record import NamedTuple
from mechkin_cli.verdict import Proof

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.plan import Layout
    from mechkin_cli.session import Session
    from mechkin_cli.show import Bools, Floats


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
        exist = all(proof is Proof.proven for proof in proven)
        words = "proven to exist" if exist else "proven to closure"
        text = f"{len(proven)} of {len(self.modes)} {words}"
        if len(proven) < 2:
            return text
        different = "all of them proven to be different"
        return f"{text}, {different if self.all_different else 'some may be the same'}"


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
    proofs = (
        Proof.not_proven if not ok else Proof.proven if beyond == 0.0 else Proof.proven_to_closure
        for ok, beyond in zip(boxes.proven, boxes.beyond, strict=True)
    )
    return ModeProofs(tuple(proofs), different)


def _apart(
    layout: Layout, states: Floats, boxes: Boxes, one: int, others: NDArray[np.intp]
) -> Bools:
    """Which other boxes have no place in common with one of them."""
    off = differences(layout, states[:, one], states[:, others])
    reach = boxes.radius[:, one, None] + boxes.radius[:, others]
    for carrier in layout.carriers:
        if carrier.part.type.is_ball:
            columns = slice(carrier.column, carrier.column + 3)
            reach[columns] = 2.0 * reach[columns].max(axis=0)
    return np.asarray((off > reach + tolerances.SAME_BOX * (1.0 + off)).any(axis=0))
