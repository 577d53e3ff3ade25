"""Programs of cells: what a column computes from a row's quantities, recorded as a tape.

The tape's inputs are numbers of the row that the page has: outputs of the kernel's run, measures of
the closure, values that are given with the file or follow from parameters alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np

from mechkin_cli.expressions import Quantity, Vector
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import Operation, Recorded, RowRecorder, Tape, Traced

Kind = Literal["slot", "measure", "given", "number"]


class Source(NamedTuple):
    """Where a number of a row comes from: a `slot` of the kernel's outputs, a `measure` (residual,
    condition, power error), a column that is `given`, or a `number` that all rows share."""

    kind: Kind
    at: int


MEASURES = ("row.residual", "row.condition", "row.power_error")

MOST_INPUTS = 20_000
"""Different numbers that the cells of one file may read."""

_UNBOUNDED = {Operation.DIVIDE, Operation.POWER, Operation.EXP, Operation.TAN, Operation.LOG}
"""What may be infinite of finite numbers: it has no value in that row, as in `expressions`."""


class CellRecorder(RowRecorder):
    """Records the cells of one file.

    Args:
        number: takes a number that is the same in all rows and hangs on parameters; its place.
    """

    def __init__(self, number: Callable[[Any], int]) -> None:
        super().__init__(MOST_INPUTS)
        self._number_of = number
        self.sources: dict[Source, int] = {}

    def of(self, kind: Kind, at: int) -> Any:
        """The number of a source."""
        return self.number(self._input(Source(kind, at)))

    def constant(self, value: Any) -> int:
        """A number that is the same in all rows; one that hangs on parameters is an input."""
        if isinstance(value, Traced):
            return self._input(Source("number", self._number_of(value)))
        return super().constant(float(value))

    def compute(self, operation: Operation, *operands: int) -> int:
        """As `RowRecorder.compute`; an infinite result becomes nan."""
        found = super().compute(operation, *operands)
        if operation not in _UNBOUNDED:
            return found
        nothing = super().compute(Operation.MULTIPLY, found, super().constant(0.0))
        return super().compute(Operation.ADD, found, nothing)

    def lifted(self, value: Any) -> int:
        """The register of a cell, or of what is the same in all rows."""
        if isinstance(value, Recorded) and value.is_row:
            return value.register  # type: ignore[attr-defined, no-any-return]
        return self.constant(value)

    def program(self, outputs: Sequence[int]) -> tuple[Tape, list[Source]]:
        """The tape of some registers, and the sources of its inputs."""
        count = max(len(self.sources), 1)
        self.inputs = self.inputs[:count]
        constants, operations, operands, numbers, _ = self.listed(outputs, [])
        tape = Tape(
            self.inputs,
            np.array(constants, dtype=np.float64),
            np.array(operations, dtype=np.uint8),
            np.array(operands, dtype=np.int32).reshape(-1, 3),
            np.array(numbers, dtype=np.int32),
            np.empty((0, 3), dtype=np.int32),
            np.empty(0, dtype=np.bool_),
            np.empty(0, dtype=np.bool_),
        )
        return tape, list(self.sources)

    def _input(self, source: Source) -> int:
        if source not in self.sources and len(self.sources) == MOST_INPUTS:
            raise ValueError(f"the cells of a file read more than {MOST_INPUTS} numbers")
        return self.sources.setdefault(source, len(self.sources))


def scalar_of(quantity: Quantity) -> Any:
    """The value of a quantity that is no vector.

    Raises:
        ValueError: it is one.
    """
    if isinstance(quantity.value, Vector):
        raise ValueError("a cell holds one number")
    return quantity.value
