"""A session's constants in double-double with a parameter shifted by a little.

What a session's constants are computed by is recorded once; each shift is a replay of that tape by
the kernel in double-double, whose rounding, 1e-32, is far below what a shift changes.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.exact import double_double
from mechkin_cli.session.double_double import Precise
from mechkin_cli.tape import compiled, double_doubles, register, replay_precise

if TYPE_CHECKING:
    from mechkin_cli.kernel import _kernel
    from mechkin_cli.mechanism import Attached, ExactMotion, Problem, Wanted
    from mechkin_cli.session.double_double import InDoubles, PreciseInputs
    from mechkin_cli.show import Floats
    from mechkin_cli.tape import ExactTape, ShiftingRecorder


Shifts = Mapping[int, Fraction]


class ShiftingPrecise(Precise):
    """As `Precise`; each parameter is its text's value and a shift, zero unless it is `shifted`.

    Args:
        leaves: of the recorder, by the names of the parameters that they shift.
        others: as those of `Precise`.
    """

    recorder: ShiftingRecorder

    def __init__(
        self,
        recorder: ShiftingRecorder,
        problem: Problem,
        motion: ExactMotion,
        base: Problem,
        leaves: Mapping[str, int],
    ) -> None:
        super().__init__(recorder, problem, motion, base)
        self.leaves = leaves
        self._turned: dict[tuple[str, Fraction], bool] = {}
        self._tapes: dict[Hashable, tuple[InDoubles, ExactTape, _kernel.Tape | None]] = {}

    def is_turned(self, name: str, amount: Fraction) -> bool:
        """Whether anything that the building decides is decided otherwise for this shift of a
        parameter in SI, or its negative; then no shift tells what the file says there.

        Raises:
            NotEnclosed: something is not defined there.
        """
        if (name, amount) not in self._turned:
            self._turned[name, amount] = self.recorder.turns(self.leaves[name], amount)
        return self._turned[name, amount]

    def shifted(self, name: str | None, amount: Fraction) -> Shifted:
        """The same numbers with a parameter larger by an amount in SI; None: with none."""
        return Shifted(self, {} if name is None else {self.leaves[name]: amount})

    def replayed(
        self,
        key: Hashable,
        session: InDoubles,
        numbers: Callable[[], Iterable[Any]],
        shifts: Shifts,
    ) -> Floats:
        """Some numbers of a session, told apart by a key, with shifts: (numbers, 2)."""
        if (key, id(session)) not in self._tapes:
            registers = [register(self.recorder, number) for number in numbers()]
            tape = self.recorder.exact_tape(registers)
            native = compiled(tape.tape) if tape.given else None
            self._tapes[key, id(session)] = (session, tape, native)
        _, tape, native = self._tapes[key, id(session)]
        if native is None:
            return double_doubles(tape)  # no number that is rounded, so none that is shifted
        values = tape.values.copy()
        for leaf, amount in shifts.items():
            if leaf in tape.given:
                values[tape.given.index(leaf)] = double_double(amount)
        return np.ascontiguousarray(replay_precise(native, values[:, :, None])[0][0])


class Shifted(Precise):
    """The numbers of a `ShiftingPrecise` with some leaves shifted; layouts and tapes are its own
    no more than once."""

    recorder: ShiftingRecorder

    def __init__(self, own: ShiftingPrecise, shifts: Shifts) -> None:
        super().__init__(own.recorder, own.problem, own.motion, own.base)
        self._layouts = own._layouts
        self.own, self.shifts = own, shifts

    def constants(self, session: InDoubles) -> Floats:
        """As `Precise.constants`."""
        return self.own.replayed("plan", session, lambda: self._constants(session), self.shifts)

    def outputs(
        self, session: InDoubles, wanted: Iterable[Wanted], points: Iterable[Attached] = ()
    ) -> Floats:
        """As `Precise.outputs`."""
        wanted, points = tuple(wanted), tuple(points)
        key = (tuple(quantity.name for quantity in wanted), points)
        return self.own.replayed(
            key, session, lambda: self._outputs(session, wanted, points), self.shifts
        )

    def inputs(self, session: InDoubles) -> PreciseInputs:
        """As `Precise.inputs`."""
        with self.recorder.shifted(self.shifts):
            return super().inputs(session)

    @cached_property
    def parameters(self) -> Mapping[str, Floats]:
        """As `Precise.parameters`."""
        with self.recorder.shifted(self.shifts):
            return self._parameters()
