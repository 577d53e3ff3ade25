"""Proofs of assembly modes: that each exists, and that no two are the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.proof.distance import balls, differences
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
    off = differences(layout, states[:, one], states[:, others])
    reach = boxes.radius[:, one, None] + boxes.radius[:, others]
    for columns in balls(layout):
        reach[columns] = 2.0 * reach[columns].max(axis=0)
    return np.asarray((off > reach + tolerances.SAME_BOX * (1.0 + off)).any(axis=0))
