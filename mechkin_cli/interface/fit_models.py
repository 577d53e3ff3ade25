"""The models that a fit runs: the file's own sweep, its curve in close rows, and single inputs.

All begin with the file's first row, so that each continues the same assembly.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.runs import SWEEP

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.arrays import Floats
    from mechkin_cli.interface.model import Model
    from mechkin_cli.mechanism.motion import DrivenInput

CURVE_ROWS = 181
"""Rows of a curve between which the nearest place is sought: 2 deg of a turn, so that ten of
them tell the curve between to rounding."""

LEFT_OUT = ("tables", "responses", "view")
"""Sections that no fit reads."""


class FitModels:
    """A model under other motions.

    Args:
        model: whose dimensions are sought.

    Raises:
        UsageError: it has nothing that runs.
    """

    def __init__(self, model: Model) -> None:
        if SWEEP in model.runs and not model.problem.motion.inputs:
            raise UsageError(f"{model.name} has no sweep to fit; give it motion: with an input")
        self.model = model
        self._listed: dict[tuple[float, ...], Model] = {}

    @cached_property
    def moved(self) -> DrivenInput:
        """The input that moves."""
        motion = self.model.problem.motion
        swept = [one for one in motion.inputs if np.ptp(one.written) > 0.0]
        if motion.time is not None or len(swept) != 1:
            raise UsageError(
                "targets at inputs need a sweep in which one input moves by itself, without "
                "motion: {time: ...}; write such a motion, or targets with least:"
            )
        return swept[0]

    @property
    def ends(self) -> tuple[float, float]:
        """The range of the moving input, in the file's units, from its first row on."""
        written = self.moved.written
        far = max(written, key=lambda value: abs(value - written[0]))
        return float(written[0]), float(far)

    @cached_property
    def unit(self) -> str:
        """The unit of the moving input."""
        problem = self.model.problem
        return problem.units.label(problem.quantities()[self.moved.name].dimension)

    @cached_property
    def curve(self) -> Model:
        """The sweep's range in close rows."""
        begin, end = self.ends
        count = max(CURVE_ROWS, self.model.problem.motion.rows)
        return self._with({"from": self._text(begin), "to": self._text(end), "count": str(count)})

    @cached_property
    def curve_inputs(self) -> Floats:
        """The inputs of its rows (rows,)."""
        written: Floats = np.asarray(
            next(one for one in self.curve.problem.motion.inputs if np.ptp(one.written)).written
        )
        return written

    def listed(self, inputs: Sequence[float]) -> Model:
        """The file's first row, then rows at these inputs."""
        key = tuple(inputs)
        if key not in self._listed:
            values = [self.ends[0], *key]
            self._listed[key] = self._with({"values": [self._text(v) for v in values]})
        return self._listed[key]

    def _text(self, value: float) -> str:
        return f"{value!r} {self.unit}".strip()

    def _with(self, rows: dict[str, Any]) -> Model:
        """The same mechanism under another motion of the moving input."""
        from mechkin_cli.building.build import build
        from mechkin_cli.building.source import open_data
        from mechkin_cli.interface.model import Model
        from mechkin_cli.interface.varied import VariedModel, file_values

        document = self.model.built.read.document
        data: dict[str, Any] = {k: v for k, v in document.data.items() if k not in LEFT_OUT}
        motion: dict[str, Any] = data["motion"]
        inputs = {}
        for driven in self.model.problem.motion.inputs:
            written = motion["inputs"][driven.name]
            if driven.name == self.moved.name:
                kept = {"rate", "acceleration", "jerk"} & written.keys()
                inputs[driven.name] = rows | {key: written[key] for key in kept}
            elif "values" in written:
                inputs[driven.name] = {"at": written["values"][0]}
            else:
                inputs[driven.name] = written
        data["motion"] = motion | {"inputs": inputs}
        source = open_data(data, document.file, folder=document.folder, tables=document.tables)
        found = Model(build(source), self.model.stem)
        if isinstance(self.model, VariedModel):
            own = self.model.values
            in_file = file_values(
                np.array(list(own.values()))[:, None], self.model.problem, tuple(own)
            )
            return found.with_parameters({name: float(v[0]) for name, v in in_file.items()})
        return found
