"""A response in double-double: its rows on the motion that `response_rows` repeats."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis.errors.reasons import TABLE_LOADS, reason_of
from mechkin_cli.analysis.errors.repeated import NotRepeated, Repeated
from mechkin_cli.analysis.errors.response_rows import ResponseRows, response_rows
from mechkin_cli.expressions import Quantity
from mechkin_cli.expressions.exact_literal import exact_literal
from mechkin_cli.mechanism.model import Varying
from mechkin_cli.mechanism.quantities import response_quantities
from mechkin_cli.tape.double_doubles import DoubleDoubles, exactly

if TYPE_CHECKING:
    from mechkin_cli.analysis.response.result import ResponseResult
    from mechkin_cli.mechanism.quantities import Wanted


def repeated_response(result: ResponseResult) -> RepeatedResponse:
    """A response in double-double.

    Raises:
        NotRepeated: why it is not repeated.
    """
    return RepeatedResponse(result, response_rows(result))


class RepeatedResponse(Repeated):
    """As `Repeated`; with work, what is dissipated, and the efforts that a response gives."""

    result: ResponseResult
    wide: ResponseRows

    @property
    def rough(self) -> RepeatedResponse:
        """The same, its motion repeated less finely."""
        return RepeatedResponse(self.result, self.wide.rough)

    @property
    def lost_why(self) -> str:
        """Why rows are not repeated."""
        return self.wide.lost_why

    def quantity(self, name: str) -> Quantity:
        """As `Repeated.quantity`."""
        own = response_quantities().get(name)
        if own is not None:
            reason = reason_of(self.problem, own)
            if reason:
                raise NotRepeated(reason)
            value: Any = self.wide.exchanged[0 if own.kind == "work" else 1]
            return Quantity(value, own.dimension)
        wanted = self.problem.quantities().get(name)
        if wanted is not None and self.result.is_given(wanted):
            return Quantity(self._given_effort(wanted), wanted.dimension)  # type: ignore[arg-type]
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """As `Repeated.read`, without what needs no run."""
        own = response_quantities()
        super().read(q for q in wanted if q.name not in own and not self.result.is_given(q))

    def _given_effort(self, wanted: Wanted) -> DoubleDoubles:
        """The sum of the response's efforts along a coordinate, as its text says them."""
        total = DoubleDoubles(np.zeros(self.rows))
        for amount in self.wide.efforts_along(wanted):
            if isinstance(amount, Varying):
                law = self.problem.load_laws[amount.number]
                if law.expression is None:
                    raise NotRepeated(TABLE_LOADS)
                found = law.expression.evaluate(self.quantity, self.units, exact_literal)
                total = total + exactly(found.value)
            else:
                total = total + amount
        total[~self.wide.known] = np.nan
        return total
