"""Rows, assembly modes and dead centres enclosed in intervals: what is proven of them."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.proofs.boxes import *
    from mechkin_cli.proofs.dead_centre import *
    from mechkin_cli.proofs.enclose import *
    from mechkin_cli.proofs.rows import *

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
