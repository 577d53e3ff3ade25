"""The proofs of a run's rows, made when they are asked for."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.analysis.proof import Certificate
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

        return certify(self.session, self.row_states.states, self.solved & self.row_states.reached)

    @property
    def is_certified(self) -> bool:
        """Whether proofs have been asked for."""
        return "certificate" in self.__dict__

    @property
    def proven_way(self) -> tuple[bool, int]:
        """Whether all rows are proven to lie on one branch, and how many tubes join them."""
        return bool(self.certificate.is_complete), int(self.certificate.tubes)

    @property
    def proof(self) -> NDArray[np.int8]:
        """What is proven of every row, codes of `Proof` (rows,)."""
        return self.certificate.status
