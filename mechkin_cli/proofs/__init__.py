"""Rows, assembly modes and dead centres enclosed in intervals: what is proven of them."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.proofs.boxes import ModeProofs as ModeProofs, prove_modes as prove_modes
    from mechkin_cli.proofs.dead_centre import (
        DeadCentreProof as DeadCentreProof,
        are_one as are_one,
    )
    from mechkin_cli.proofs.enclose import Enclosure as Enclosure
    from mechkin_cli.proofs.rows import (
        Gap as Gap,
        SweepProofs as SweepProofs,
        bounds as bounds,
        certify as certify,
        dead_centre_enclosure as dead_centre_enclosure,
        enclosures as enclosures,
        input_bounds as input_bounds,
        inside_boxes as inside_boxes,
        is_angle_of_place as is_angle_of_place,
        position_bounds as position_bounds,
        reason_against as reason_against,
        reason_unknown as reason_unknown,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "boxes": "ModeProofs prove_modes",
        "dead_centre": "DeadCentreProof are_one",
        "enclose": "Enclosure",
        "rows": "Gap SweepProofs bounds certify dead_centre_enclosure enclosures input_bounds "
        "inside_boxes is_angle_of_place position_bounds reason_against reason_unknown",
    },
)
