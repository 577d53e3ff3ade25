"""Places of a motion as the kernel takes them: all that a run is told beside what it is to find."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.solver.codes import Demand

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.inputs import KernelInputs
    from mechkin_cli.solver.session import Session


class Places(NamedTuple):
    """Arguments of `Session.run` by their names there, the last axis of each over places."""

    inputs: Floats
    guess: Floats
    rates: Floats | None
    accelerations: Floats | None
    jerks: Floats | None
    turned: Floats
    whole: Floats
    full: Floats
    time: Floats | None
    ties: Floats | None

    @classmethod
    def of(
        cls, own: Session, rows: Rows, inputs: KernelInputs, demand: Demand, ties: Floats | None
    ) -> Places:
        """The rows of a run of the session `own` on their states, with rates of `inputs` as far as
        they are demanded."""
        moments = own.problem.motion.time
        return cls(
            inputs=inputs.reduced,
            guess=rows.states,
            rates=inputs.rates if demand & Demand.VELOCITY else None,
            accelerations=inputs.accelerations if demand & Demand.ACCELERATION else None,
            jerks=inputs.jerks if demand & Demand.JERK else None,
            turned=rows.turns,
            whole=own.inputs.whole,
            full=own.inputs.values,
            time=None if moments is None else moments.values,
            ties=ties if demand & Demand.FORCES else None,
        )

    def at(self, numbers: NDArray[np.intp] | Sequence[int]) -> Places:
        """Some of the places, in this order."""
        parts: Any = (None if part is None else part[..., numbers] for part in self)
        return Places(*parts)

    @property
    def arguments(self) -> dict[str, Any]:
        """As `Session.run` takes them."""
        return self._asdict()
