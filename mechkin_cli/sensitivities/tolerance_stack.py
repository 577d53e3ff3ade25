"""Tolerances of parameters and what they do to quantities: stacks to first order, and samples.

With slopes g and bands [l, u] about the parameters' own values, the worst cases are the sums of the
smaller and of the larger of g l and g u; the root sum square is that of g (u - l)/2. Independent
parameters of standard deviations s scatter a quantity by the root of the sum of (g s)^2, of which
each makes its share.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.arguments import Setting, a_setting, a_whole_number, refusal, shown
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.record import NamedTuple
from mechkin_cli.sensitivities.first_order import Sensitivities, chosen_parameters, sensitivities
from mechkin_cli.sensitivities.stack_tables import files_of, picture_of, record_of
from mechkin_cli.show import Bools, Floats, Listed, Listing
from mechkin_cli.variants import (
    draws,
    has_scipy,
    normal,
    one_value,
    uniform,
    vary,
    with_parameters,
)

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray

    from mechkin_cli.analysis import Solvable
    from mechkin_cli.arguments import Setting
    from mechkin_cli.plots import Bands
    from mechkin_cli.show import Bools, Floats


METHODS = ("latin", "sobol", "random")
DEVIATIONS = {"uniform": sqrt(3.0), "normal": 3.0}
"""Half a band in standard deviations, by the distribution within it."""


class Band(NamedTuple):
    """Least and largest deviation of a parameter from its own value, in the file's units."""

    least: float
    most: float

    @property
    def half(self) -> float:
        """Half its width."""
        return 0.5 * (self.most - self.least)

    @property
    def middle(self) -> float:
        """Its middle."""
        return 0.5 * (self.most + self.least)


class Sampled(NamedTuple):
    """Of the samples of one quantity, row by row (rows,), in its unit.

    Attributes:
        mean, deviation: mean and standard deviation of those that have a value.
        mean_error, deviation_error: standard errors of both, as of independent samples; those of a
            Latin hypercube or a Sobol sequence are off by less where the quantity is nearly linear.
        lost: how many samples have no finite value in the row, where there is one, or an infinite
            one, for the parameters' own values.
    """

    mean: Floats
    deviation: Floats
    mean_error: Floats
    deviation_error: Floats
    lost: NDArray[np.intp]


class Tolerances(Listed):
    """What tolerances do to quantities, row by row (rows,), in the file's units.

    Attributes:
        bands: of the parameters, by name.
        slopes: the `Sensitivities` to them.
        samples: how many were drawn.
    """

    def __init__(
        self,
        slopes: Sensitivities,
        bands: Mapping[str, Band],
        own: Mapping[str, float],
        samples: int,
        method: Any,
        seed: int,
        distribution: str,
    ) -> None:
        self.slopes, self.bands, self.samples = slopes, dict(bands), samples
        self._own, self._sigmas = own, DEVIATIONS[distribution]
        self._method, self._seed, self._distribution = method, seed, distribution
        for quantity in slopes.quantities:
            if slopes.value(quantity).ndim > 1:
                raise UsageError(
                    f"{quantity} is a vector, not one number; write norm({quantity}) or a component"
                )

    def nominal(self, quantity: str) -> Floats:
        """The quantity for the parameters' own values."""
        return self.slopes.value(quantity)

    def worst(self, quantity: str) -> tuple[Floats, Floats]:
        """The least and the largest value to first order, all parameters at their worst."""
        slopes, value = self._slopes(quantity), self.nominal(quantity)
        least = np.stack([g * b.least for g, b in slopes])
        most = np.stack([g * b.most for g, b in slopes])
        low, high = (end(least, most).sum(axis=0) for end in (np.minimum, np.maximum))
        return value + low, value + high

    def root_sum_square(self, quantity: str) -> tuple[Floats, Floats]:
        """The same by the root of the sum of the squares, about the middle of the bands."""
        slopes = self._slopes(quantity)
        middle = sum(g * b.middle for g, b in slopes)
        half = np.sqrt(sum((g * b.half) ** 2 for g, b in slopes))
        value = self.nominal(quantity) + middle
        return value - half, value + half

    def scatter(self, quantity: str) -> Floats:
        """The standard deviation to first order."""
        parts = [(g * b.half) ** 2 for g, b in self._slopes(quantity)]
        return np.asarray(np.sqrt(np.sum(parts, axis=0)) / self._sigmas)

    def shares(self, quantity: str) -> dict[str, Floats]:
        """What part of the square of the scatter each parameter makes (0 to 1), by name; the
        parameters in falling order of their share where the scatter is largest."""
        parts = [(g * b.half) ** 2 for g, b in self._slopes(quantity)]
        total = np.sum(parts, axis=0)
        with np.errstate(invalid="ignore"):
            shares = {n: part / total for n, part in zip(self.bands, parts, strict=True)}
        row = self.widest(quantity)
        order = sorted(shares, key=lambda name: -float(np.nan_to_num(shares[name][row])))
        return {name: shares[name] for name in order}

    def left_out(self, quantity: str) -> Floats:
        """What the slopes leave out: half the curvatures times the squared ends of the bands, added
        up, in parts of half the width between the worst cases."""
        second = [
            0.5 * np.abs(self.slopes.curvature(quantity, n)) * max(abs(b.least), abs(b.most)) ** 2
            for n, b in self.bands.items()
        ]
        low, high = self.worst(quantity)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(np.sum(second, axis=0) / (0.5 * (high - low)))

    def inaccurate(self, quantity: str) -> Bools:
        """Rows whose first-order estimate is not to be trusted: more than a tenth is left out, a
        sample or an end of a band has no position, or there is no slope."""
        part = self.left_out(quantity)
        missing = ~np.isfinite(self.scatter(quantity))
        lost = (self.sampled(quantity).lost > 0) | (self.lost_ends(quantity) > 0)
        return np.asarray(missing | (part > tolerances.LINEAR) | lost)

    def sampled(self, quantity: str) -> Sampled:
        """Mean and standard deviation of the samples, with their own standard errors."""
        values = self.drawn(quantity)
        known = np.isfinite(values)
        count = known.sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = np.where(known, values, 0.0).sum(axis=0) / count
            squares = np.where(known, values - mean, 0.0) ** 2
            square = squares.sum(axis=0) / np.maximum(count - 1, 0)
            # a product: numpy's fourth power is the machine's own
            fourth = (squares * squares).sum(axis=0) / count
            deviation = np.sqrt(square)
            error = np.sqrt(np.maximum(fourth - square**2, 0.0) / count) / (2.0 * deviation)
            of_mean = deviation / np.sqrt(count)
        lost = np.where(np.isnan(self.nominal(quantity)), 0, self.samples - count)
        return Sampled(mean, deviation, of_mean, error, lost)

    def quantile(self, quantity: str, part: float) -> Floats:
        """The value below which a part of the samples lies, of those that have one.

        Raises:
            UsageError: `part` is not from 0 to 1.
        """
        if not 0.0 <= part <= 1.0:
            raise UsageError(f"part: expected a number from 0 to 1, not {shown(part)}")
        values = self.drawn(quantity)
        quantiles = np.full(values.shape[1], np.nan)
        some = np.isfinite(values).any(axis=0)
        quantiles[some] = np.nanquantile(values[:, some], part, axis=0)
        return quantiles

    def drawn(self, quantity: str) -> Floats:
        """The quantity of every sample (samples, rows)."""
        return self._runs(quantity)[: self.samples]

    def lost_ends(self, quantity: str) -> NDArray[np.intp]:
        """At how many ends of the bands, one parameter at a time, there is no finite value (rows,),
        counted as the samples that are `lost`."""
        lost: NDArray[np.intp] = (~np.isfinite(self._runs(quantity)[self.samples :])).sum(axis=0)
        return np.where(np.isnan(self.nominal(quantity)), 0, lost)

    def widest(self, quantity: str) -> int:
        """The row in which the quantity scatters most, from 0."""
        return int(np.nan_to_num(self.scatter(quantity), nan=-1.0).argmax())

    def place_of(self, row: int) -> str:
        """Where a row stands, in words: `170 deg`."""
        return f"{self.slopes.place[row]:.6g} {self.slopes.along_unit}".rstrip()

    def files(self, formats: Collection[str] = ("csv", "md")) -> dict[str, bytes]:
        """What `mechkin tolerances` writes, by name of file: the rows, and what each tolerance
        contributes."""
        return files_of(self, formats)

    def record(self) -> dict[str, Any]:
        """All of it as plain data, numbers that there are none of as None."""
        return record_of(self)

    def picture(self) -> Bands:
        """The bands over the rows and the contributions, as a picture; `image("svg")` draws it."""
        return picture_of(self)

    def to_pandas(self) -> pandas.DataFrame:
        """A line for each row: the place, then of each quantity its columns: `O4.theta`, `least`,
        `largest`, `scatter`, `sampled mean`, `sampled scatter`, `share of P1`, `inaccurate`;
        `attrs["units"]` has their units.

        Raises:
            UsageError: pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas needs pandas: pip install 'mechkin[pandas]'") from None
        columns: dict[str, Any] = {self.slopes.along: self.slopes.place}
        units = {self.slopes.along: self.slopes.along_unit}
        for quantity in self.slopes.quantities:
            (least, largest), sampled = self.worst(quantity), self.sampled(quantity)
            own = {
                quantity: self.nominal(quantity),
                f"{quantity} least": least,
                f"{quantity} largest": largest,
                f"{quantity} scatter": self.scatter(quantity),
                f"{quantity} sampled mean": sampled.mean,
                f"{quantity} sampled scatter": sampled.deviation,
            }
            units |= dict.fromkeys(own, self.slopes.unit_of(quantity))
            shares = {f"{quantity} share of {n}": v for n, v in self.shares(quantity).items()}
            columns |= own | shares | {f"{quantity} inaccurate": self.inaccurate(quantity)}
        frame = pandas.DataFrame(columns)
        frame.attrs["units"] = units
        return frame

    @property
    def listing(self) -> Listing:
        """Each quantity where it scatters most, and who makes it."""
        rows, notes = [], []
        for quantity in self.slopes.quantities:
            row = self.widest(quantity)
            low, high = self.worst(quantity)
            sampled, scatter = self.sampled(quantity), self.scatter(quantity)
            place = self.place_of(row)
            cells = (self.nominal(quantity)[row], low[row], high[row], scatter[row])
            numbers = tuple(f"{one:.6g}" for one in cells)
            error = f"{sampled.deviation[row]:.4g} +- {sampled.deviation_error[row]:.1g}"
            rows.append((quantity, self.slopes.unit_of(quantity), place, *numbers, error))
            notes += self._notes(quantity, row, place)
        head = f"Tolerances of {self.slopes.model.name}: {self.samples} samples"
        labels = ("quantity", "unit", "at", "nominal", "least", "largest", "scatter", "sampled")
        return Listing(head, labels, tuple(rows), tuple(notes))

    def _notes(self, quantity: str, row: int, place: str) -> list[str]:
        notes = []
        for name, share in list(self.shares(quantity).items())[:1]:
            if np.isfinite(share[row]):
                part = f"{100.0 * share[row]:.0f} %"
                notes.append(f"{name} makes {part} of the scatter of {quantity} at {place}")
        rows_off = self.inaccurate(quantity)
        count = int(rows_off.sum())
        if count:
            infinite = np.isinf(self.nominal(quantity))
            lost = self.sampled(quantity).lost + self.lost_ends(quantity) > 0
            rows = int((lost & ~infinite).sum())
            why = f", {rows} of them have no position somewhere in the bands" if rows else ""
            if infinite.any():
                at = f"{self.slopes.place[int(infinite.argmax())]:.6g} {self.slopes.along_unit}"
                why += f", it is infinite at the dead centre at {at.rstrip()}"
            parts = self.left_out(quantity)[rows_off]
            parts = parts[np.isfinite(parts)]
            by = f" by up to {100.0 * parts.max():.2g} % of half the band" if parts.size else ""
            notes.append(
                f"{quantity}: the first-order estimate is off{by} in {count} of "
                f"{self.slopes.rows.size} rows{why}"
            )
        return notes

    def _slopes(self, quantity: str) -> list[tuple[Floats, Band]]:
        return [(self.slopes[quantity, name], band) for name, band in self.bands.items()]

    def _runs(self, quantity: str) -> Floats:
        return np.asarray(self._varied[self.slopes.texts[quantity]][:, self.slopes.rows])

    @cached_property
    def _varied(self) -> Any:
        """All samples, then the ends of the bands, one parameter at a time."""
        points = draws(self._method, self.samples, len(self.bands), self._seed)(0, self.samples)
        ends = 2 * len(self.bands)
        values: dict[str, Floats] = {}
        for number, (name, band) in enumerate(self.bands.items()):
            own = self._own[name]
            if self._distribution == "uniform":
                sampled = uniform(points[:, number], own + band.least, own + band.most)
            else:
                deviation = band.half / self._sigmas
                sampled = normal(points[:, number], own + band.middle, deviation)
            rest = np.full(ends, own)
            rest[2 * number : 2 * number + 2] = own + band.least, own + band.most
            values[name] = np.concatenate([sampled, rest])
        asked = list(dict.fromkeys(self.slopes.texts.values()))
        return vary(self.slopes.model, values, asked)


def stack(
    model: Solvable,
    given: Mapping[str, Setting | Sequence[Setting]],
    quantities: Iterable[str],
    at: Setting | Iterable[Setting] | None,
    samples: int,
    method: str,
    seed: int,
    distribution: str,
) -> Tolerances:
    """`Model.tolerances`; arguments and errors are its."""
    if not isinstance(given, Mapping) or not given:
        raise refusal("tolerances", 'a mapping such as {"P1": "0.01 in"}', given)
    names = chosen_parameters(model, list(given))
    if method not in METHODS:
        raise UsageError(f"method is one of {', '.join(METHODS)}, not {method}")
    if distribution not in DEVIATIONS:
        raise UsageError(f"distribution is one of {', '.join(DEVIATIONS)}, not {distribution}")
    if (method != "random" or distribution == "normal") and not has_scipy():
        raise UsageError(
            "latin, sobol and normal distributions are drawn with scipy, which is not here: "
            "pip install 'mechkin[studies]', or draw uniformly with the method random"
        )
    samples = a_whole_number("samples", samples, "draws", tolerances.FEWEST_SAMPLES)
    seed = a_whole_number("seed", seed, "", 0)
    bands = {name: _band(model, name, given[name]) for name in names}
    known, units = model.problem.parameters, model.problem.units
    own = {n: float(units.from_si(float(known[n].value), known[n].dimension)) for n in names}  # type: ignore[arg-type]
    # set one by one: what has a tolerance of its own follows no other
    slopes = sensitivities(with_parameters(model, own), quantities, names, at)
    numbers = samples * model.problem.motion.rows * len(slopes.texts)
    if numbers > tolerances.MOST_SAMPLED:
        raise UsageError(
            f"samples: {samples} of them hold {numbers} numbers (limit {tolerances.MOST_SAMPLED}); "
            "take fewer, or a study, which keeps them in files"
        )
    return Tolerances(slopes, bands, own, samples, method, seed, distribution)


def _band(model: Solvable, name: str, given: Setting | Sequence[Setting]) -> Band:
    """Half a width, or both ends."""
    known, units = model.problem.parameters[name], model.problem.units

    def number(value: Setting) -> float:
        in_si = one_value(name, a_setting(name, value), known.dimension, units)
        return float(units.from_si(in_si, known.dimension))

    if isinstance(given, (list, tuple)):
        if len(given) != 2:
            raise UsageError(f"{name}: a tolerance is one number, or two: least and most")
        band = Band(*map(number, given))
    else:
        half = number(given)  # type: ignore[arg-type]
        band = Band(-half, half)
    if not band.least < band.most:
        raise UsageError(
            f"{name}: the tolerance from {band.least + 0.0:.6g} to {band.most + 0.0:.6g} has no "
            "width; write half a band above zero, or both ends, the smaller one first"
        )
    return band
