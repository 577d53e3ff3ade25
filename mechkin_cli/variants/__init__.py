"""Many models at once: one structure with other values of its parameters."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.variants.design import *
    from mechkin_cli.variants.many import *
    from mechkin_cli.variants.result import *
    from mechkin_cli.variants.variation import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "design": "Draws VariedDesign base_of draws file_values has_scipy needs_scipy normal "
        "one_value parameter_values uniform varied_design with_parameters",
        "many": "vary",
        "variation": "SessionVariation VariantReadout",
        "result": "Reduce Variants expressions_of read_by sample_of swept_parameter",
    },
)
