"""Many models at once: one structure with other values of its parameters."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.variants.design import (
        Draws as Draws,
        draws as draws,
        file_values as file_values,
        has_scipy as has_scipy,
        needs_scipy as needs_scipy,
        normal as normal,
        one_value as one_value,
        parameter_values as parameter_values,
        uniform as uniform,
        varied_design as varied_design,
        with_parameters as with_parameters,
    )
    from mechkin_cli.variants.many import vary as vary
    from mechkin_cli.variants.result import (
        Reduce as Reduce,
        Variants as Variants,
        expressions_of as expressions_of,
        read_by as read_by,
        sample_of as sample_of,
        swept_parameter as swept_parameter,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "design": "Draws draws file_values has_scipy needs_scipy normal one_value "
        "parameter_values uniform varied_design with_parameters",
        "many": "vary",
        "result": "Reduce Variants expressions_of read_by sample_of swept_parameter",
    },
)
