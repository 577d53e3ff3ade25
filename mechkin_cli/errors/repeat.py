"""Which repetition a run has."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.errors.rows import Repeated

if TYPE_CHECKING:
    from mechkin_cli.sweep import Result


def repetition(result: Result) -> Repeated:
    """A run in double-double.

    Raises:
        NotRepeated: why it is not repeated.
    """
    from mechkin_cli.response import ResponseResult

    if isinstance(result, ResponseResult):
        from mechkin_cli.errors.response import repeated_response

        return repeated_response(result)
    from mechkin_cli.errors.rows import wide_run

    return Repeated(result, wide_run(result))
