"""Rows, assembly modes and dead centres enclosed in intervals: what is proven of them."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.proofs.certificate import Certificate as Certificate
    from mechkin_cli.proofs.dead_centre import DeadCentreProof as DeadCentreProof
    from mechkin_cli.proofs.enclosed_rows import input_bounds as input_bounds
    from mechkin_cli.proofs.modes import ModeProofs as ModeProofs, prove_modes as prove_modes
    from mechkin_cli.proofs.rows import SweepProofs as SweepProofs, certify as certify

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "certificate": ["Certificate"],
        "dead_centre": ["DeadCentreProof"],
        "enclosed_rows": ["input_bounds"],
        "modes": ["ModeProofs", "prove_modes"],
        "rows": ["SweepProofs", "certify"],
    },
)
