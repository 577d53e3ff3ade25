"""Rows by the places at which they stand."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.expressions import ExpressionError, constant_in_file_units, lookup
from mechkin_cli.interface.arguments import a_setting
from mechkin_cli.tolerances import LAST_ROW

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.interface.analysis import Analysis
    from mechkin_cli.interface.arguments import Setting


class Along:
    """What the rows of a run stand along: time, or the first input that moves; the number of the
    row where nothing does."""

    def __init__(self, analysis: Analysis) -> None:
        self._analysis = analysis
        given = analysis.result.inputs
        moving = [name for name, values in given.items() if np.ptp(values) > 0.0]
        self.name = moving[0] if moving else "row"
        count = np.arange(1, analysis.rows + 1, dtype=np.float64)
        self.values: Floats = given[self.name] if moving else count
        self.unit = analysis.unit(self.name) if moving else ""

    def rows(self, at: Setting | Iterable[Setting] | None) -> NDArray[np.intp]:
        """Numbers of the rows at some places, from 0; None: of all.

        Raises:
            UsageError: an invalid value, or one at which there is no row.
        """
        if at is None:
            return np.arange(self.values.size)
        many = isinstance(at, Iterable) and not isinstance(at, (str, Mapping))
        places: list[Any] = list(at) if many else [at]  # type: ignore[arg-type]
        return np.array([self._row(a_setting("at", one)) for one in places], dtype=np.intp)

    def _row(self, at: Setting) -> int:
        wanted = self._value(at)
        off = np.abs(self.values - wanted)
        row = int(off.argmin())
        room = LAST_ROW * float(np.ptp(self.values))
        if off[row] > room:
            near = sorted(set(self.values[np.argsort(off, kind="stable")[:2]].tolist()))
            unit = f" {self.unit}".rstrip()
            raise UsageError(
                f"no row has {self.name} = {wanted:.12g}{unit}; the nearest stand at "
                f"{' and '.join(f'{one:.12g}' for one in near)}{unit}"
            )
        return row

    def _value(self, at: Setting) -> float:
        """A place in the file's units."""
        if self.name == "row":
            return float(at) if not isinstance(at, str) else float("nan")
        problem = self._analysis.model.problem
        known = {**problem.quantities(), **self._analysis.result.problem.quantities()}
        text = at if isinstance(at, str) else repr(at)
        try:
            return constant_in_file_units(
                text, known[self.name].dimension, problem.units, lookup(problem.parameters)
            )
        except ExpressionError as error:
            hint = f"; {error.hint}" if error.hint else ""
            raise UsageError(f"at {text[:LONGEST_NAME]}: {error.message}{hint}") from None
