"""The parameters of a model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from mechkin_cli.show import Listed, Listing

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem


class Parameters(Listed, Mapping[str, float]):
    """The parameters of a model by name: values in the file's units, in the file's order.

    Example:
        >>> from mechkin_cli import load
        >>> given = load("mechanisms/dissertation/rcsr.yaml").parameters
        >>> given["P1"], given.unit("P1")
        (0.5, 'in')
    """

    def __init__(self, problem: Problem) -> None:
        self._known, self._units = problem.parameters, problem.units

    def __getitem__(self, name: str) -> float:
        quantity = self._known[name]
        in_si = float(quantity.value)  # type: ignore[arg-type]
        return self._units.from_si(in_si, quantity.dimension)

    def __iter__(self) -> Iterator[str]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)

    def unit(self, name: str) -> str:
        """The unit of a parameter in the file's units, "" of a pure number."""
        return self._units.label(self._known[name].dimension)

    @property
    def listing(self) -> Listing:
        """Names, values and units."""
        rows = tuple((name, f"{value:.10g}", self.unit(name)) for name, value in self.items())
        head = f"{len(rows)} parameter{'' if len(rows) == 1 else 's'}"
        return Listing(head, ("parameter", "value", "unit") if rows else (), rows)
