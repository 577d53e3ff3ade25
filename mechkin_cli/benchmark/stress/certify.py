"""What interval arithmetic proves of some mechanisms' rows, against the closed forms."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.benchmark.stress.judge import ROUNDING, TURN, Found
from mechkin_cli.benchmark.stress.numbers.double_double import radians
from mechkin_cli.benchmark.stress.quantity import Mask, Quantity, Rows, Truth
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.interface import Analysis
from mechkin_cli.proof import Proof

NOT_ASKED = -1
EACH = 10
"""Every tenth mechanism of a make is proven, too: a proof takes as long as some solutions."""
SLACK = 8.0
"""Roundings times the condition by which an enclosure may miss the closed form: it is that of the
decimals of the file, the closed form that of their doubles."""


@dataclass(frozen=True)
class Proofs:
    """Codes of `Proof` (mechanisms, rows), `NOT_ASKED` elsewhere; enclosures by name, in the files'
    units, nan where there are none."""

    codes: NDArray[np.int8]
    low: dict[str, Rows] = field(default_factory=dict)
    high: dict[str, Rows] = field(default_factory=dict)

    def columns(self, rows: slice) -> Proofs:
        """Those of some rows."""
        low = {name: value[:, rows] for name, value in self.low.items()}
        high = {name: value[:, rows] for name, value in self.high.items()}
        return Proofs(self.codes[:, rows], low, high)


def unasked(mechanisms: int, rows: int, names: list[str]) -> Proofs:
    """Nothing proven yet."""
    shape = mechanisms, rows
    low = {name: np.full(shape, np.nan) for name in names}
    high = {name: np.full(shape, np.nan) for name in names}
    return Proofs(np.full(shape, NOT_ASKED, np.int8), low, high)


def prove(proofs: Proofs, k: int, analysis: Analysis) -> None:
    """Fills in what is proven of one mechanism."""
    certificate = analysis.certificate
    by_label = {proof.label: int(proof) for proof in Proof}
    proofs.codes[k] = [by_label[label] for label in certificate.status.tolist()]
    for name in proofs.low:
        # coordinates of closing joints have none
        with contextlib.suppress(UsageError):
            proofs.low[name][k], proofs.high[name][k] = certificate.enclosure(name)


def contradicted(proofs: Proofs, found: Found, truth: Truth) -> Mask:
    """Rows that are proven to be where the closed form says that they are not."""
    proven = proofs.codes > int(Proof.not_proven)
    wrong = proven & ~truth.exists
    slack = SLACK * ROUNDING * np.fmax(found.condition, 1.0)
    for quantity in truth.quantities:
        outside = _outside(proofs, quantity, slack, truth.size)
        wrong |= proven & truth.exists & outside
    return wrong & truth.decided & ~found.noted


def _outside(proofs: Proofs, quantity: Quantity, slack: Rows, size: Rows) -> Mask:
    """Whether the true value lies outside the enclosure."""
    low, high = proofs.low[quantity.name], proofs.high[quantity.name]
    right = quantity.value.number
    if quantity.kind == "length":
        below, above = (right - low).high, (right - high).high
        scale = np.maximum(size, np.abs(right.high))
    else:
        first, last = radians(low) - right, radians(high) - right
        turns = TURN * np.rint((first / TURN).high) if quantity.kind == "angle" else TURN * 0.0
        below, above = -(first - turns).high, -(last - turns).high
        scale = np.maximum(1.0, np.abs(right.high))
    # comparisons with nan are false
    outside: Mask = (below < -slack * scale) | (above > slack * scale)
    return outside
