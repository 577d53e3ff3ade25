"""The proofs of a run's rows, made when they are asked for."""

from __future__ import annotations

from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING

from mechkin_cli.proof import Proof
from mechkin_cli.solver.inputs import input_number

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.analysis.proof import Certificate
    from mechkin_cli.analysis.proof.dead_centre import DeadCentre
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Bools
    from mechkin_cli.solver.session import Session


class Proven:
    """What a result knows of the proofs of its rows."""

    session: Session
    row_states: Rows
    if TYPE_CHECKING:

        @cached_property
        def solved(self) -> Bools:
            """Rows that have a position (rows,)."""

    @cached_property
    def certificate(self) -> Certificate:
        """What is proven of the rows."""
        from mechkin_cli.analysis.proof import certify

        rows = self.row_states
        return certify(self.session, rows.states, self.solved & rows.reached, rows.ends)

    @property
    def is_certified(self) -> bool:
        """Whether proofs have been asked for."""
        return "certificate" in self.__dict__

    @property
    def proven_way(self) -> tuple[bool, int]:
        """Whether all rows are proven to lie on one branch, and how many tubes join them."""
        return bool(self.certificate.is_complete), int(self.certificate.tubes)

    @property
    def proven_dead_centres(self) -> list[dict[str, object]]:
        """What is proven of the dead centres beyond which rows are missing, as plain data in the
        file's units: bounds are None where none is proven to exist; rows count from 1."""
        return [self._dead_centre_record(found) for found in self.certificate.dead_centres]

    def _dead_centre_record(self, found: DeadCentre) -> dict[str, object]:
        from mechkin_cli.analysis.proof.enclosures import input_bounds

        session, number = self.session, found.number
        there = input_number(session.problem, session.layout, number, float(found.place[number]))
        low, high = (x if isfinite(x) else None for x in input_bounds(session, found))
        proof = Proof.not_proven if found.why else Proof.proven
        bounds = {"low": low, "high": high, "last_row": found.row + 1, "tubes": found.tubes}
        return there.record() | bounds | {"proof": proof.label}

    @property
    def proof(self) -> NDArray[np.int8]:
        """What is proven of every row, codes of `Proof` (rows,)."""
        return self.certificate.status
