"""What interval arithmetic proves of mechanisms' rows, against the closed forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from benchmarks.stress.judge import TURN, Found
from benchmarks.stress.numbers.double_double import DoubleDouble, radians
from benchmarks.stress.quantity import Cell, Mask, Rows, Truth
from mechkin_cli.analysis.analysis import Analysis
from mechkin_cli.verdict import Proof

NOT_ASKED = -1
CLOSED_FORM = 1e-28
"""What double-double leaves of a closed form, times the condition (of rates its square, of
accelerations and forces its cube): an enclosure may miss it by that."""


@dataclass(frozen=True)
class Proofs:
    """Codes of `Proof` (mechanisms, rows), `NOT_ASKED` elsewhere; enclosures by the cells' keys, in
    the files' units, nan where there are none."""

    codes: NDArray[np.int8]
    low: dict[str, Rows] = field(default_factory=dict)
    high: dict[str, Rows] = field(default_factory=dict)

    def columns(self, rows: slice) -> Proofs:
        """Those of some rows."""
        low = {key: value[:, rows] for key, value in self.low.items()}
        high = {key: value[:, rows] for key, value in self.high.items()}
        return Proofs(self.codes[:, rows], low, high)


def unasked(mechanisms: int, rows: int, keys: Sequence[str]) -> Proofs:
    """Nothing proven yet."""
    shape = mechanisms, rows
    low = {key: np.full(shape, np.nan) for key in keys}
    high = {key: np.full(shape, np.nan) for key in keys}
    return Proofs(np.full(shape, NOT_ASKED, np.int8), low, high)


def prove(proofs: Proofs, k: int, analysis: Analysis, cells: Sequence[Cell]) -> None:
    """Fills in what is proven of one mechanism."""
    certificate = analysis.certificate
    by_label = {proof.label: int(proof) for proof in Proof}
    proofs.codes[k] = [by_label[label] for label in certificate.status.tolist()]
    found = certificate.enclosures(list(dict.fromkeys(cell.quantity for cell in cells)))
    for cell in cells:
        low, high = found[cell.quantity]
        proofs.low[cell.key][k], proofs.high[cell.key][k] = cell.column(low), cell.column(high)


def contradicted(proofs: Proofs, found: Found, truth: Truth, written: Truth) -> Mask:
    """Rows that are proven to be where the closed form says that they are not.

    Args:
        truth: of the doubles; tells which rows there are.
        written: of the numbers that the files say, which proofs are about.
    """
    proven = proofs.codes > int(Proof.not_proven)
    wrong = proven & ~truth.exists
    condition = np.fmax(found.condition, 1.0)
    for cell in written.cells():
        slack = CLOSED_FORM * condition ** (cell.order + 1)
        wrong |= proven & truth.exists & _outside(proofs, cell, slack)
    return wrong & truth.decided & ~found.noted


def _outside(proofs: Proofs, cell: Cell, slack: Rows) -> Mask:
    """Whether the true value lies outside the enclosure."""
    low, high = DoubleDouble(proofs.low[cell.key]), DoubleDouble(proofs.high[cell.key])
    if cell.is_angle:
        low, high = radians(low.high), radians(high.high)
    first, last = low - cell.value, high - cell.value
    if cell.is_angle and not cell.is_whole:
        turns = TURN * np.rint((first / TURN).high)
        first, last = first - turns, last - turns
    slack = slack * (cell.scale + np.abs(cell.value.high))
    # comparisons with nan are false
    outside: Mask = (first.high > slack) | (last.high < -slack)
    return outside
