"""Rows, assembly modes and dead centres enclosed in intervals: what is proven of them."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.proofs.dead_centre import DeadCentreProof as DeadCentreProof
    from mechkin_cli.proofs.enclose import (
        Enclosure as Enclosure,
        bounds as bounds,
        enclose as enclose,
        inside_boxes as inside_boxes,
        is_angle_of_place as is_angle_of_place,
        reason_against as reason_against,
        reason_unknown as reason_unknown,
    )
    from mechkin_cli.proofs.enclosed_rows import (
        dead_centre_enclosure as dead_centre_enclosure,
        enclosures as enclosures,
        input_bounds as input_bounds,
    )
    from mechkin_cli.proofs.fold import are_one as are_one
    from mechkin_cli.proofs.modes import ModeProofs as ModeProofs, prove_modes as prove_modes
    from mechkin_cli.proofs.rows import Gap as Gap, SweepProofs as SweepProofs, certify as certify

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "dead_centre": ["DeadCentreProof"],
        "enclose": [
            "Enclosure",
            "bounds",
            "enclose",
            "inside_boxes",
            "is_angle_of_place",
            "reason_against",
            "reason_unknown",
        ],
        "enclosed_rows": ["dead_centre_enclosure", "enclosures", "input_bounds"],
        "fold": ["are_one"],
        "modes": ["ModeProofs", "prove_modes"],
        "rows": ["Gap", "SweepProofs", "certify"],
    },
)
