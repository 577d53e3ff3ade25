"""Motions written as functions and integrated by the kernel, without a mechanism."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.tape.recorder import Recorder, Traced, register
from mechkin_cli.tape.tape import compiled

AUTOMATIC, EXPLICIT, IMPLICIT = range(3)


class End(IntEnum):
    DONE = 0
    STOPPED = 1
    STUCK = 2
    STEP_LIMIT = 3
    HELD = 4


NOT_FINITE, OUT_OF_REACH = 255, 253
Switch = tuple[bool, bool, bool]
KINK, BORDER = (True, False, False), (True, True, False)
EVENT, STOP = (False, False, False), (False, False, True)


@dataclass(frozen=True)
class Answer:
    """`states` (rows, components, lanes); a report for each lane; (lane, switch, rising, time,
    state) of the events; how many rows were interpolated."""

    states: np.ndarray
    reports: list[dict[str, Any]]
    events: list[tuple[int, int, bool, float, list[float]]]
    inside: int


@dataclass(frozen=True)
class System:
    """x'' = f, w' = g: `rates(t, x, v, w, side, p)` gives (f, g, switches, fault)."""

    rates: Callable[..., tuple[Sequence[Any], Sequence[Any], Sequence[Any], Any]]
    freedoms: int
    quadratures: int = 0
    switches: tuple[Switch, ...] = ()
    parameters: int = 0

    def tape(self) -> _kernel.Tape:
        n, q, s, p = self.freedoms, self.quadratures, len(self.switches), self.parameters
        count = 1 + 2 * n + q + s + p
        recorder = Recorder([f"i{k}" for k in range(count)], [0.5 + 0.01 * k for k in range(count)])
        numbers = [Traced(recorder, k) for k in range(count)]
        cuts = np.cumsum([1, n, n, q, s])
        parts = [numbers[a:b] for a, b in zip([0, *cuts], [*cuts, count], strict=True)]
        f, g, switches, fault = self.rates(parts[0][0], *parts[1:])
        outputs = [register(recorder, value) for value in (*f, *g, *switches, fault)]
        return compiled(recorder.tape(outputs, guarded=False))

    def integrate(
        self,
        state: Sequence[Any],
        rows: Sequence[float],
        *,
        parameters: Sequence[Any] = (),
        start: float | None = None,
        scales: Sequence[float] = (1.0,),
        bounce: float = 1.0,
        reach: float = np.inf,
        tolerance: float = 1e-10,
        fixed_step: float = 0.0,
        least_step: float = 1e-13,
        most_steps: int = 100000,
        dense_rows: int = 3,
        method: int = AUTOMATIC,
    ) -> Answer:
        """`state` (x, v, w) and `parameters`: a number, or one for each lane, per component."""
        rows = np.array(rows, dtype=float)
        columns = np.broadcast_arrays(
            *(np.atleast_1d(np.float64(c)) for c in (*state, *parameters))
        )
        table = np.array(columns)
        lanes = table.shape[1]
        size = 2 * self.freedoms + self.quadratures
        answer = _kernel.integrate_tape(
            self.tape(),
            self.freedoms,
            self.quadratures,
            list(self.switches),
            np.full(lanes, rows[0] if start is None else start),
            np.ascontiguousarray(table[:size]),
            np.ascontiguousarray(table[size:]),
            rows,
            list(scales),
            bounce,
            reach,
            tolerance,
            fixed_step,
            least_step,
            most_steps,
            dense_rows,
            method,
        )
        return Answer(*answer)
