"""Measures of a population of variants - residuals of targets, magnitudes, margins - and their
derivatives.

A fit runs the file's own sweep, its curve in close rows, and single inputs. All begin with the
file's first row, so that each continues the same assembly.

Derivatives are exact: sensitivities of the mechanism, by the chain rule through scales, weights and
nearest places. Nearest places are those where curves, known in equal steps, come nearest to points.
Between rows a curve is the polynomial through the ten rows around (Berrut & Trefethen 2004,
Barycentric Lagrange interpolation, section 2): with steps h its error in the middle is below h^10
times the tenth derivative divided by 4000. On it the nearest place is found by Newton steps. Eight
rows would do for the place as well, but give of the derivatives of a place only nine digits.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis import Design
from mechkin_cli.building import build, open_data
from mechkin_cli.diagnostics import MechkinError, UsageError
from mechkin_cli.fit.request import Bounds, FitConstraint, Target
from mechkin_cli.fit.search import Measures
from mechkin_cli.sensitivities import sensitivities
from mechkin_cli.tables import row_weights
from mechkin_cli.tolerances import LAST_ROW
from mechkin_cli.variants import (
    file_values,
    swept_parameter,
    vary,
    with_parameters,
)
from mechkin_cli.verdict import SWEEP, has_solution

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.analysis import Solvable
    from mechkin_cli.mechanism import DrivenInput
    from mechkin_cli.sensitivities import Sensitivities
    from mechkin_cli.show import Bools, Floats


CURVE_ROWS = 181
"""Rows of a curve between which the nearest place is sought: 2 deg of a turn, so that ten of
them give the curve between to rounding."""

LEFT_OUT = ("tables", "responses", "view")
"""Sections that no fit reads."""


class FitModels:
    """A model under other motions.

    Args:
        model: whose dimensions are sought.

    Raises:
        UsageError: it has nothing that runs.
    """

    def __init__(self, model: Solvable) -> None:
        if SWEEP in model.runs and not model.problem.motion.inputs:
            raise UsageError(f"{model.name} has no sweep to fit; give it motion: with an input")
        self.model = model
        self._listed: dict[tuple[float, ...], Solvable] = {}

    @cached_property
    def moved(self) -> DrivenInput:
        """The input that moves."""
        motion = self.model.problem.motion
        swept = [one for one in motion.inputs if np.ptp(one.written) > 0.0]
        if motion.time is not None or len(swept) != 1:
            raise UsageError(
                "targets at inputs need a sweep in which one input moves by itself; write such a "
                "motion, or time: in it, or targets with least:"
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
    def curve(self) -> Solvable:
        """The sweep's range in close rows."""
        begin, end = self.ends
        count = max(CURVE_ROWS, self.model.problem.motion.rows)
        return self._with({"from": self._text(begin), "to": self._text(end), "count": str(count)})

    @cached_property
    def curve_inputs(self) -> Floats:
        """The inputs of its rows (rows,)."""
        inputs = self.curve.problem.motion.inputs
        return np.asarray(next(one.written for one in inputs if np.ptp(one.written)))

    def listed(self, inputs: Sequence[float]) -> Solvable:
        """The file's first row, then rows at these inputs."""
        key = tuple(inputs)
        if key not in self._listed:
            values = [self.ends[0], *key]
            self._listed[key] = self._with({"values": [self._text(v) for v in values]})
        return self._listed[key]

    def _text(self, value: float) -> str:
        return f"{value!r} {self.unit}".strip()

    def _with(self, rows: dict[str, Any]) -> Solvable:
        """The same mechanism under another motion of the moving input."""
        document = self.model.built.document
        data: dict[str, Any] = {k: v for k, v in document.data.items() if k not in LEFT_OUT}
        motion: dict[str, Any] = data["motion"]
        inputs = {}
        rest = self.model.problem.motion.rest
        resting = () if rest is None else rest.inputs
        for number, driven in enumerate(self.model.problem.motion.inputs):
            if number in resting:
                continue
            written = motion["inputs"][driven.name]
            if driven.name == self.moved.name:
                orders = {"rate", "acceleration", "jerk"} & written.keys()
                inputs[driven.name] = rows | {key: written[key] for key in orders}
            elif "values" in written:
                inputs[driven.name] = {"at": written["values"][0]}
            else:
                inputs[driven.name] = written
        data["motion"] = motion | {"inputs": inputs}
        source = open_data(data, document.file, folder=document.folder, tables=document.tables)
        model = self.model.of(Design(build(*source), self.model.design.stem))
        own = self.model.design.values
        if not own:
            return model
        in_si = np.array(list(own.values()))[:, None]
        in_file = file_values(in_si, self.model.problem, tuple(own))
        return with_parameters(model, {name: float(v[0]) for name, v in in_file.items()})


TIME = "time"


class FitValues:
    """A request to a model, for populations of its parameters in parts of their bounds."""

    def __init__(
        self,
        models: FitModels,
        parameters: tuple[Bounds, ...],
        targets: tuple[Target, ...],
        constraints: tuple[FitConstraint, ...],
    ) -> None:
        self.models, self.parameters = models, parameters
        self.targets, self.constraints = targets, constraints
        self.lower = np.array([one.lower for one in parameters])
        self.width = np.array([one.upper for one in parameters]) - self.lower
        self.names = [one.name for one in parameters]
        timed = models.model.problem.motion.time is not None
        at = [one for one in targets if one.at is not None]
        self.at_inputs = [one for one in at if one.run == SWEEP and not timed]
        self.at_moments = [one for one in at if one.run != SWEEP or timed]
        self.anywhere = [one for one in targets if one.at is None and not one.least]
        self.least = [one for one in targets if one.least]
        swept = [SWEEP] if SWEEP in models.model.runs else []
        asked = [one.run for one in targets] + [one.run for one in constraints]
        self.runs = tuple(dict.fromkeys([*swept, *asked]))
        self.weights = {run: rms_weights(models.model, run) for run in self.runs}
        # rows in the order of the inputs, so that each is followed from its neighbour
        begin, end = models.ends if self.at_inputs else (0.0, 0.0)
        inputs = sorted({v for one in self.at_inputs for v in one.at or ()}, reverse=end < begin)
        self.listed_inputs = tuple(inputs)
        self._row = {value: number + 1 for number, value in enumerate(inputs)}

    def texts(self, run: str) -> list[str]:
        """What is read of the rows of a run."""
        read = [(one.run, one.of) for one in (*self.least, *self.at_moments)]
        read += [(one.run, one.of) for one in self.constraints]
        return [of for asked, of in read if asked == run]

    def values(self, unknowns: Floats) -> dict[str, Floats]:
        """Parameters (S,) by name, in the file's units."""
        found = self.lower[:, None] + unknowns * self.width[:, None]
        return dict(zip(self.names, found, strict=True))

    def rows_of(self, target: Target) -> list[int]:
        """The rows among the listed inputs, or at moments, at which a target stands."""
        motion = self.models.model.problem.motion
        if target.run != SWEEP:
            moments = self.models.model.problem.responses[target.run].moments
        elif motion.time is not None:
            moments = motion.time
        else:
            return [self._row[value] for value in target.at or ()]
        written = moments.written.tolist()
        return [written.index(value) for value in target.at or ()]

    def on_time(self, run: str, times: Floats) -> Bools:
        """Which rows of a response stand at their moments: that of a stop takes the place of the
        next one, and those behind it are missing."""
        moments = self.models.model.problem.responses[run].moments.written
        with np.errstate(invalid="ignore"):
            return np.asarray(np.abs(times - moments) <= LAST_ROW * np.ptp(moments))

    def measure(self, unknowns: Floats) -> Measures:
        """Of a population (unknowns, S)."""
        values, count = self.values(unknowns), unknowns.shape[1]
        residuals: list[Floats] = []
        peaks: list[Floats] = []
        margins: list[Floats] = []
        missing = np.zeros(count)
        rows: dict[str, dict[str, Floats]] = {}
        for run in self.runs:
            rows[run], lost = self._run(self.models.model, values, self.texts(run), run)
            missing = missing + lost
        for target in self.least:
            scaled = rows[target.run][target.of] / target.within
            if target.least == "peak":
                peaks.append(scaled)
            else:
                weights = self.weights[target.run]
                parts = scaled.reshape(count, len(weights), -1) * weights[:, None]
                residuals.append(parts.reshape(count, -1))
        for constraint in self.constraints:
            margins += margins_of(constraint, rows[constraint.run][constraint.of])
        for target in self.at_moments:
            values_there = rows[target.run][target.of][:, self.rows_of(target)]
            residuals.append(deviations(target, values_there))
        if self.at_inputs:
            listed = self.models.listed(self.listed_inputs)
            found, lost = self._run(listed, values, [one.of for one in self.at_inputs])
            missing = missing + lost
            for target in self.at_inputs:
                residuals.append(deviations(target, found[target.of][:, self.rows_of(target)]))
        if self.anywhere:
            found, lost = self._run(self.models.curve, values, [one.of for one in self.anywhere])
            missing = missing + lost
            for target in self.anywhere:
                _, places = nearest_places(found[target.of], target.wanted)
                residuals.append(deviations(target, places))
        return Measures(_beside(residuals, count), tuple(peaks), _beside(margins, count), missing)

    def _run(
        self, model: Solvable, values: dict[str, Floats], texts: list[str], run: str = SWEEP
    ) -> tuple[dict[str, Floats], Floats]:
        """Expressions over the rows, and the part of rows or values that are missing (S,)."""
        asked = list(dict.fromkeys(texts)) or [model.problem.motion.inputs[0].name]
        if run == SWEEP:
            variants = vary(model, values, asked)
            lost = ~has_solution(variants.codes)
        else:
            variants = vary(model, values, list(dict.fromkeys((*asked, TIME))), run=run)
            lost = ~has_solution(variants.codes) | ~self.on_time(run, variants[TIME])
        found = {}
        for text in asked:
            value = variants[text]
            empty = ~np.isfinite(value)
            lost = lost | (empty.any(axis=2) if value.ndim == 3 else empty)
            found[text] = np.where(empty, 0.0, value)
        return found, np.asarray(lost.mean(axis=1))


def deviations(target: Target, values: Floats) -> Floats:
    """Residuals (S, points * width) of values (S, points) or (S, points, width)."""
    values = values.reshape(len(values), len(target.wanted), target.width)
    return np.asarray(((values - target.wanted) / target.within).reshape(len(values), -1))


def margins_of(constraint: FitConstraint, values: Floats) -> list[Floats]:
    """Margins (S, rows) of each of its bounds, in parts of the bound."""
    return [sign * (values - bound) / (abs(bound) or 1.0) for bound, sign in constraint.bounds]


def rms_weights(model: Solvable, run: str) -> Floats:
    """Roots of the weights of the rows in a mean over what the run goes along (rows,)."""
    if run != SWEEP:
        at = model.problem.responses[run].moments.written
    elif (swept := swept_parameter(model.problem)) is not None:
        at = swept[1]
    else:
        at = np.zeros(model.problem.motion.rows)
    weights = row_weights(np.asarray(at, dtype=np.float64))
    return np.asarray(np.sqrt(weights / weights.sum()))


def _beside(parts: list[Floats], count: int) -> Floats:
    return np.concatenate(parts, axis=1) if parts else np.zeros((count, 0))


class FitSlopes:
    """The derivatives of `FitValues.measure`.

    Attributes:
        why: expressions of which the last `stacked` has no exact derivative, and why: verdicts of
            sensitivities, or the reason for which there are none.
    """

    def __init__(self, values: FitValues) -> None:
        self._values = values
        self.why: dict[str, str] = {}

    def stacked(self, unknowns: Floats) -> Floats:
        """Derivatives of `Measures.stacked` (all, unknowns) at (unknowns,), nan where a sensitivity
        has another verdict than `ok` or one of a row that is solved."""
        values = self._values
        models = values.models
        self.why = {}
        named = {name: float(one[0]) for name, one in values.values(unknowns[:, None]).items()}
        rows = {
            run: self._slopes(models.model, named, values.texts(run), run) for run in values.runs
        }
        parts = []
        for one in (target for target in values.least if target.least == "rms"):
            slopes, weights = rows[one.run][one.of] / one.within, values.weights[one.run]
            parts.append(slopes.reshape(len(slopes), len(weights), -1) * weights[:, None])
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
        for constraint in values.constraints:
            for bound, sign in constraint.bounds:
                slopes = rows[constraint.run][constraint.of]
                parts.append(sign * slopes / (abs(bound) or 1.0))
        stacked = np.concatenate([part.reshape(len(unknowns), -1) for part in parts], axis=1)
        return np.asarray((stacked * values.width[:, None]).T)

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
        """Notes the parameters to which a quantity has no sensitivity."""
        notes = []
        for name in self._values.names:
            without = ~np.isfinite(found[text, name]).reshape(len(found.rows), -1).all(axis=1)
            if without.any():
                words, counts = np.unique(found.verdict(text, name)[without], return_counts=True)
                verdicts = ", ".join(f"{n} rows {w}" for w, n in zip(words, counts, strict=True))
                notes.append(f"{name}: {found.why(text, name) or verdicts}")
        if notes:
            self.why[text] = "; ".join(notes)


NODES = 10
"""Rows of a polynomial."""

HALF = 0.5 * (NODES - 1)
POWERS = np.arange(NODES)
TO_COEFFICIENTS = np.linalg.inv(((POWERS - HALF) / HALF)[:, None] ** POWERS)
"""From the values at the rows to a polynomial in z in [-1, 1]."""

STEPS = 30
"""Newton steps, each at most a row."""


def nearest_places(curves: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Of curves (S, rows, width) the nearest places to points (points, width).

    Returns their rows, in parts (S, points), and where they are (S, points, width).
    """
    first, z, places, _ = _nearest(curves, points)
    return first + HALF + HALF * z, places


def nearest_slopes(curve: Floats, slopes: Floats, points: Floats) -> Floats:
    """Derivatives of the nearest places of one curve (rows, width), whose own derivatives with
    some unknowns are `slopes` (unknowns, rows, width): (unknowns, points, width).

    The place itself moves along the curve so that what is left stays perpendicular to it: with
    c(z, u) the curve and r = c - point, r . c_z = 0 gives z_u = -(c_zu . r + c_u . c_z) /
    (c_z . c_z + r . c_zz), and c_u + c_z z_u is the derivative. At an end of the curve it stays.
    """
    first, z, places, at_end = (part[0] for part in _nearest(curve[None], points))
    around = curve[first[:, None] + POWERS]
    moved = slopes[:, first[:, None] + POWERS]
    coefficients = np.einsum("pn,knw->kpw", TO_COEFFICIENTS, around)
    c_u, c_zu = (
        np.einsum("kn,uknw->ukw", _powers(z, order) @ TO_COEFFICIENTS, moved) for order in (0, 1)
    )
    c_z, c_zz = (np.einsum("kp,kpw->kw", _powers(z, order), coefficients) for order in (1, 2))
    away = places - points
    curved = (c_z * c_z + away * c_zz).sum(axis=1)
    down = (c_zu * away + c_u * c_z).sum(axis=2)
    stays = at_end | (curved == 0.0)
    z_u = np.where(stays, 0.0, -down / np.where(stays, 1.0, curved))
    return np.asarray(c_u + c_z * z_u[:, :, None])


CurvePlaces = tuple["NDArray[np.intp]", "Floats", "Floats", "Bools"]
"""Of curves (S) the nearest places to points: the first rows of their polynomials and z there
(S, points), the places (S, points, width), and whether they are ends of the curve."""


def _nearest(curves: Floats, points: Floats) -> CurvePlaces:
    distances = np.square(curves[:, :, None, :] - points).sum(axis=3)
    rows = distances.argmin(axis=1)
    last = curves.shape[1] - 1
    nearest = _from(curves, points, rows)
    # a closed curve has its ends at one place, and the nearest may lie on the other side of it
    at_end = (rows == 0) | (rows == last)
    if at_end.any():
        other = _from(curves, points, np.where(rows == 0, last, np.where(rows == last, 0, rows)))
        there, here = (np.square(p[2] - points).sum(axis=2) for p in (other, nearest))
        nearer = at_end & (there < here)
        first, z, ends = (np.where(nearer, other[k], nearest[k]) for k in (0, 1, 3))
        nearest = first, z, np.where(nearer[..., None], other[2], nearest[2]), ends
    return nearest


def _powers(z: Floats, order: int) -> Floats:
    """Derivatives of an order of the powers of z, of as many as a polynomial has."""
    factors = np.ones(NODES)
    for step in range(order):
        factors = factors * (POWERS - step)
    return np.asarray(factors * z[..., None] ** np.maximum(POWERS - order, 0))


def _from(curves: Floats, points: Floats, rows: NDArray[np.intp]) -> CurvePlaces:
    """The nearest place within a row of given ones (S, points)."""
    last = curves.shape[1] - 1
    first = np.clip(rows - NODES // 2 + 1, 0, last - NODES + 1)
    of = np.arange(len(curves))[:, None, None]
    around = curves[of, first[:, :, None] + POWERS]
    coefficients = np.einsum("pn,sknw->skpw", TO_COEFFICIENTS, around)
    slopes = coefficients[:, :, 1:] * POWERS[1:, None]
    bends = slopes[:, :, 1:] * POWERS[1:-1, None]

    def at(polynomial: Floats, z: Any) -> Floats:
        powers = z[..., None] ** np.arange(polynomial.shape[2])
        return np.asarray(np.einsum("skp,skpw->skw", powers, polynomial))

    middle = rows - first
    low = (np.maximum(middle - 1, 0) - HALF) / HALF
    high = (np.minimum(middle + 1, NODES - 1) - HALF) / HALF
    z: Floats = np.asarray((middle - HALF) / HALF)
    for _ in range(STEPS):
        away, slope, bend = at(coefficients, z) - points, at(slopes, z), at(bends, z)
        down = (away * slope).sum(axis=2)
        flat = (slope * slope).sum(axis=2)
        curved = flat + (away * bend).sum(axis=2)
        steep = np.where(curved > 0.1 * flat, curved, flat)
        z = np.clip(z - down / np.where(steep > 0.0, steep, 1.0), low, high)
    row = first + HALF + HALF * z
    return first, z, at(coefficients, z), (row <= 0.0) | (row >= last)
