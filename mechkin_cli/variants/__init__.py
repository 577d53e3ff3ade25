"""Many models at once: one structure with other values of its parameters."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.variants.many import (
        Reduce as Reduce,
        Variants as Variants,
        expressions_of as expressions_of,
        sample_of as sample_of,
        swept_parameter as swept_parameter,
        vary as vary,
    )
    from mechkin_cli.variants.model import (
        Base as Base,
        VariedModel as VariedModel,
        file_values as file_values,
        one_value as one_value,
        parameter_values as parameter_values,
        with_parameters as with_parameters,
    )
    from mechkin_cli.variants.responses import vary_response as vary_response
    from mechkin_cli.variants.samples import (
        Draws as Draws,
        draws as draws,
        has_scipy as has_scipy,
        needs_scipy as needs_scipy,
        normal as normal,
        uniform as uniform,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "many": ["Reduce", "Variants", "expressions_of", "sample_of", "vary", "swept_parameter"],
        "model": [
            "Base",
            "VariedModel",
            "file_values",
            "one_value",
            "parameter_values",
            "with_parameters",
        ],
        "responses": ["vary_response"],
        "samples": ["Draws", "draws", "has_scipy", "needs_scipy", "normal", "uniform"],
    },
)
