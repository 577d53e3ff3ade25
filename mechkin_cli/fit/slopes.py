"""Exact derivatives of what a fit is measured by: sensitivities of the mechanism, by the chain
rule through scales, weights and nearest places.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import MechkinError
from mechkin_cli.fit.nearest import nearest_slopes
from mechkin_cli.sensitivities import sensitivities
from mechkin_cli.variants import vary, with_parameters
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.analysis import Solvable
    from mechkin_cli.fit.measure import FitValues
    from mechkin_cli.fit.request import Target
    from mechkin_cli.sensitivities import Sensitivities
    from mechkin_cli.show import Floats


class FitSlopes:
    """The derivatives of `FitValues.measure`.

    Attributes:
        why: what the last `stacked` has no exact derivative of, and why: verdicts of sensitivities
            or the reason for which there are none, by expression.
    """

    def __init__(self, values: FitValues) -> None:
        self._values = values
        self.why: dict[str, str] = {}

    def stacked(self, unknowns: Floats) -> Floats:
        """Derivatives of `Measures.stacked` (all, unknowns) at (unknowns,), nan where a sensitivity
        has another verdict than `ok` or one of a row that is solved."""
        values = self._values
        models, request = values.models, values.request
        self.why = {}
        named = {name: float(one[0]) for name, one in values.values(unknowns[:, None]).items()}
        rows = {
            run: self._slopes(models.model, named, values.texts(run), run) for run in values.runs
        }
        parts = [
            _weighted(rows[one.run][one.of] / one.within, values.weights[one.run])
            for one in values.least
            if one.least == "rms"
        ]
        for one in values.at_moments:
            parts.append(rows[one.run][one.of][:, values.rows_of(one)] / one.within)
        if values.at_inputs:
            listed = models.listed(values.listed_inputs)
            found = self._slopes(listed, named, [one.of for one in values.at_inputs])
            for target in values.at_inputs:
                parts.append(found[target.of][:, values.rows_of(target)] / target.within)
        if values.anywhere:
            parts += self._anywhere(named, values.anywhere)
        peaks = [one for one in values.least if one.least == "peak"]
        parts += [rows[one.run][one.of] / one.within for one in peaks]
        for constraint in request.constraints:
            for bound, sign in constraint.bounds:
                slopes = rows[constraint.run][constraint.of]
                parts.append(sign * slopes / (abs(bound) or 1.0))
        stacked = np.concatenate([part.reshape(len(unknowns), -1) for part in parts], axis=1)
        found_all: Floats = (stacked * values.width[:, None]).T
        return found_all

    def _anywhere(self, named: dict[str, float], targets: Sequence[Target]) -> list[Floats]:
        """Of nearest places, each (parameters, points, width)."""
        texts = [one.of for one in targets]
        curve = self._values.models.curve
        run = vary(curve, {name: np.array([value]) for name, value in named.items()}, texts)
        slopes = self._slopes(curve, named, texts)
        return [
            nearest_slopes(np.nan_to_num(run[one.of][0]), slopes[one.of], one.wanted) / one.within
            for one in targets
        ]

    def _slopes(
        self, model: Solvable, named: dict[str, float], texts: list[str], run: str = SWEEP
    ) -> dict[str, Floats]:
        """Of expressions over the rows of a run, (parameters, rows) or (parameters, rows, width),
        in the file's units."""
        texts = list(dict.fromkeys(texts))
        if not texts:
            return {}
        names = self._values.names
        try:
            varied = with_parameters(model, named)
            found = sensitivities(varied, texts, names, run=run)
        except MechkinError as error:
            self.why |= dict.fromkeys(texts, str(error))
            single = {name: np.array([value]) for name, value in named.items()}
            shapes = vary(model, single, texts, run=run)
            return {t: np.full((len(names), *shapes[t].shape[1:]), np.nan) for t in texts}
        for text in texts:
            self._note(found, text)
        return {text: np.stack([found[text, name] for name in names]) for text in texts}

    def _note(self, found: Sensitivities, text: str) -> None:
        """Say what a quantity has no sensitivity for."""
        notes = []
        for name in self._values.names:
            without = ~np.isfinite(found[text, name]).reshape(len(found.rows), -1).all(axis=1)
            if without.any():
                words, counts = np.unique(found.verdict(text, name)[without], return_counts=True)
                told = ", ".join(f"{n} rows {w}" for w, n in zip(words, counts, strict=True))
                notes.append(f"{name}: {found.why(text, name) or told}")
        if notes:
            self.why[text] = "; ".join(notes)


def _weighted(slopes: Floats, weights: Floats) -> Floats:
    """Rows (parameters, rows, ...) times the weights (rows,) of a mean over the way."""
    found: Floats = slopes.reshape(len(slopes), len(weights), -1) * weights[:, None]
    return found
