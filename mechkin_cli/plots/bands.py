"""Bands of tolerance over the rows of a run, and beside them what each parameter contributes.

What is drawn is the deviation from the nominal value, since a swing of 100 degrees would hide a
band of a tenth.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.plots.curves import empty_figure, figure_bytes
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mechkin_cli.show import Bools, Floats

    Ends = tuple[Floats, Floats]


class Band(NamedTuple):
    """What tolerances do to a quantity; its numbers are deviations from the nominal value (rows,).

    Attributes:
        label: of the quantity.
        unit: its unit.
        worst: least and largest, all parameters at their worst.
        root_sum_square: the same by the root of the sum of the squares.
        sampled: the ends of the middle part of the samples.
        shares: of the square of the scatter, by parameter, the largest first.
        place: where the shares hold, in words.
        inaccurate: rows whose first-order estimate is off (rows,).
    """

    label: str
    unit: str
    worst: Ends
    root_sum_square: Ends
    sampled: Ends
    shares: dict[str, float]
    place: str
    inaccurate: Bools


class Bands(NamedTuple):
    """Bands of some quantities over the same rows: what these stand along, in words, and where."""

    title: str
    along: str
    places: Floats
    bands: tuple[Band, ...]
    sampled_part: float

    def image(self, ending: str) -> bytes:
        """A file with the picture: "svg", "png" or "pdf".

        Raises:
            UsageError: matplotlib is not there.
        """
        return figure_bytes(lambda: _figure(self), ending)


_HEIGHT, _ABOVE = 2.6, 0.7
_WORST, _SAMPLED, _ROOT, _OFF = "#c8d7ea", "#6f9bd1", "#0a3069", "#a40e26"
MOST_BARS = 8
"""Parameters that have a bar; the rest share one."""


def _figure(picture: Bands) -> Figure:
    count = len(picture.bands)
    figure = empty_figure(_ABOVE + _HEIGHT * count)
    panels = figure.subplots(count, 2, squeeze=False, width_ratios=(3, 1.3))
    for (left, right), band in zip(panels, picture.bands, strict=True):
        _over_rows(left, picture, band)
        _bars(right, band)
    panels[-1, 0].set_xlabel(picture.along)
    panels[-1, 1].set_xlabel("share of the squared scatter [%]")
    panels[0, 0].legend(loc="best", ncols=2)
    figure.suptitle(picture.title, fontsize="medium")
    return figure


def _over_rows(axes: Axes, picture: Bands, band: Band) -> None:
    places = picture.places
    if places.size == 1:
        # one row is no curve: its band stands as wide as the panel
        width = 0.5 * max(abs(float(places[0])), 1.0)
        places = places[0] + np.array([-width, width])
    wide: Any = [np.resize(one, places.size) for one in (*band.worst, *band.sampled)]
    part = f"{100.0 * picture.sampled_part:g} % of the samples"
    axes.fill_between(places, wide[0], wide[1], color=_WORST, label="worst case", linewidth=0)
    axes.fill_between(places, wide[2], wide[3], color=_SAMPLED, label=part, linewidth=0)
    for end, label in zip(band.root_sum_square, ("root sum square", None), strict=True):
        axes.plot(places, np.resize(end, places.size), "--", color=_ROOT, linewidth=1, label=label)
    if band.inaccurate.any():
        at = picture.places[band.inaccurate]
        label = "first order is off"
        axes.plot(at, np.zeros(at.size), "x", color=_OFF, markersize=4, label=label)
    axes.set_ylabel(f"{band.label}\noff nominal{f' [{band.unit}]' if band.unit else ''}")


def _bars(axes: Axes, band: Band) -> None:
    names, parts = _listed(band.shares)
    places = np.arange(len(names))
    axes.barh(places, parts, color=_SAMPLED, height=0.6)
    axes.set_yticks(places, names)
    axes.invert_yaxis()
    axes.set_xlim(0.0, 100.0)
    axes.grid(visible=False, axis="y")
    axes.set_title(f"at {band.place}", fontsize="small")


def _listed(shares: dict[str, float]) -> tuple[Sequence[str], Sequence[float]]:
    """Names and shares in percent, the last bar for all that have none."""
    pairs = [(name, 100.0 * share) for name, share in shares.items() if np.isfinite(share)]
    if len(pairs) > MOST_BARS:
        rest = pairs[MOST_BARS - 1 :]
        pairs = pairs[: MOST_BARS - 1]
        pairs.append((f"{len(rest)} others", sum(part for _, part in rest)))
    return [name for name, _ in pairs], [part for _, part in pairs]
