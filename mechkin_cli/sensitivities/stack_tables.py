"""A stack of tolerances as tables, as plain data, and as a picture."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.plots import Band, Bands
from mechkin_cli.record import replace
from mechkin_cli.tables import (
    Columns,
    TableColumn,
    column_of_numbers,
    csv_bytes,
    markdown_bytes,
    words_of,
)

if TYPE_CHECKING:
    from mechkin_cli.sensitivities.first_order import Sensitivities
    from mechkin_cli.show import Bools, Floats


class _Stack(Protocol):
    """What tables and pictures read of `Tolerances`, whose docstrings say what it is."""

    slopes: Sensitivities
    bands: dict[str, Any]
    samples: int

    def nominal(self, quantity: str) -> Floats: ...
    def worst(self, quantity: str) -> tuple[Floats, Floats]: ...
    def root_sum_square(self, quantity: str) -> tuple[Floats, Floats]: ...
    def scatter(self, quantity: str) -> Floats: ...
    def shares(self, quantity: str) -> dict[str, Floats]: ...
    def sampled(self, quantity: str) -> Any: ...
    def quantile(self, quantity: str, part: float) -> Floats: ...
    def left_out(self, quantity: str) -> Floats: ...
    def inaccurate(self, quantity: str) -> Bools: ...
    def widest(self, quantity: str) -> int: ...
    def place_of(self, row: int) -> str: ...


SAMPLED_PART = 0.95
"""Middle part of the samples that tables and pictures give the ends of."""

NAME = "tolerances"
"""What files of a stack are called."""


def sampled_ends(t: _Stack, quantity: str) -> tuple[Floats, Floats]:
    """The values between which `SAMPLED_PART` of the samples lie, with as many below as above."""
    outside = 0.5 * (1.0 - SAMPLED_PART)
    return t.quantile(quantity, outside), t.quantile(quantity, 1.0 - outside)


def numbers_of(t: _Stack, quantity: str) -> dict[str, Floats]:
    """Columns of a quantity in its unit (rows,), by label."""
    (least, largest), root = t.worst(quantity), t.root_sum_square(quantity)
    sampled, ends = t.sampled(quantity), sampled_ends(t, quantity)
    outside = 50.0 * (1.0 - SAMPLED_PART)
    return {
        quantity: t.nominal(quantity),
        f"{quantity} least": least,
        f"{quantity} largest": largest,
        f"{quantity} RSS least": root[0],
        f"{quantity} RSS largest": root[1],
        f"{quantity} scatter": t.scatter(quantity),
        f"{quantity} sampled mean": sampled.mean,
        f"{quantity} sampled scatter": sampled.deviation,
        f"{quantity} sampled {outside:g} %": ends[0],
        f"{quantity} sampled {100.0 - outside:g} %": ends[1],
    }


def rows_table(t: _Stack, quantities: Sequence[str] = (), short: bool = False) -> Columns:
    """A line for each row: the place, and all numbers of some quantities, or of all.

    Args:
        short: labels do not name the quantity, which the title does.
    """
    slopes = t.slopes
    columns = [column_of_numbers(slopes.along, slopes.along_unit, slopes.place)]
    for quantity in quantities or slopes.quantities:
        unit, own = slopes.unit_of(quantity), len(columns)
        for label, values in numbers_of(t, quantity).items():
            columns.append(column_of_numbers(label, unit, values))
        lost = t.sampled(quantity).lost.astype(np.float64)
        columns.append(column_of_numbers(f"{quantity} samples lost", "", lost, 0))
        for name, share in t.shares(quantity).items():
            columns.append(column_of_numbers(f"{quantity} share of {name}", "", share))
        words = ["inaccurate" if one else "ok" for one in t.inaccurate(quantity).tolist()]
        columns.append(TableColumn(f"{quantity} first order", "", words_of(words)))
        if short:
            columns[own + 1 :] = [
                replace(column, label=column.label.removeprefix(quantity).strip())
                for column in columns[own + 1 :]
            ]
    title = quantities[0] if short else f"Tolerances of {slopes.model.name}"
    return Columns(NAME, title, tuple(columns), of_rows=False)


def extremes_table(t: _Stack) -> Columns:
    """A line for each quantity, where it scatters most."""
    quantities, rows = t.slopes.quantities, [t.widest(q) for q in t.slopes.quantities]
    pairs = list(zip(quantities, rows, strict=True))
    columns = [
        TableColumn("quantity", "", words_of(list(quantities))),
        TableColumn("unit", "", words_of([t.slopes.unit_of(q) for q in quantities])),
        TableColumn("at", "", words_of([t.place_of(row) for row in rows])),
    ]
    numbers = [[float(values[row]) for values in numbers_of(t, q).values()] for q, row in pairs]
    labels = [label.removeprefix(quantities[0]).strip() for label in numbers_of(t, quantities[0])]
    for label, values in zip(labels, zip(*numbers, strict=True), strict=True):
        columns.append(column_of_numbers(label or "nominal", "", list(values)))
    return Columns("extremes", "Where each quantity scatters most", tuple(columns), of_rows=False)


def contributions_table(t: _Stack) -> Columns:
    """A line for each quantity and parameter, where the quantity scatters most: the slope, how far
    the worst ends of the band move the quantity, and the share of its squared scatter."""
    slopes, units = t.slopes, t.slopes.unit_of
    words: dict[str, list[str]] = {"quantity": [], "at": [], "parameter": [], "unit": []}
    cells: dict[str, list[float]] = {"from": [], "to": [], "slope": [], "moves by": [], "share": []}
    for quantity in slopes.quantities:
        row = t.widest(quantity)
        for name, share in t.shares(quantity).items():
            band, slope = t.bands[name], float(slopes[quantity, name][row])
            unit = f" [{units(name)}]" if units(name) else ""
            texts = (quantity, t.place_of(row), f"{name}{unit}", slopes.unit(quantity, name))
            numbers = (band.least, band.most, slope, abs(slope) * band.half, 100.0 * share[row])
            for column, text in zip(words.values(), texts, strict=True):
                column.append(text)
            for values, number in zip(cells.values(), numbers, strict=True):
                values.append(float(number))
    columns = (
        TableColumn("quantity", "", words_of(words["quantity"])),
        TableColumn("at", "", words_of(words["at"])),
        TableColumn("parameter", "", words_of(words["parameter"])),
        column_of_numbers("from", "", cells["from"]),
        column_of_numbers("to", "", cells["to"]),
        column_of_numbers("slope", "", cells["slope"]),
        TableColumn("of slope", "", words_of(words["unit"])),
        column_of_numbers("moves by", "", cells["moves by"]),
        column_of_numbers("share", "%", cells["share"], 1),
    )
    return Columns("contributions", "What each tolerance contributes", columns, of_rows=False)


def files_of(t: _Stack, formats: Collection[str]) -> dict[str, bytes]:
    """Files by name, in some of the formats `csv` and `md`: of CSV the rows and the contributions,
    of Markdown a page with both."""
    source = t.slopes.results
    files: dict[str, bytes] = {}
    if "csv" in formats:
        files[f"{NAME}.csv"] = csv_bytes(rows_table(t))
        files[f"{NAME}_shares.csv"] = csv_bytes(contributions_table(t))
    if "md" in formats:
        pages = [contributions_table(t)]
        pages += [rows_table(t, (quantity,), short=True) for quantity in t.slopes.quantities]
        files[f"{NAME}.md"] = b"\n".join(markdown_bytes(page, source) for page in pages)
    return files


def record_of(t: _Stack) -> dict[str, Any]:
    """Plain data: bands, rows, and of each quantity what `rows_table` has."""
    slopes = t.slopes
    quantities = {}
    for quantity in slopes.quantities:
        (least, largest), root = t.worst(quantity), t.root_sum_square(quantity)
        sampled, ends = t.sampled(quantity), sampled_ends(t, quantity)
        quantities[quantity] = {
            "unit": slopes.unit_of(quantity),
            "nominal": _plain(t.nominal(quantity)),
            "worst": [_plain(least), _plain(largest)],
            "root_sum_square": [_plain(root[0]), _plain(root[1])],
            "scatter": _plain(t.scatter(quantity)),
            "shares": {name: _plain(share) for name, share in t.shares(quantity).items()},
            "sampled": {
                "mean": _plain(sampled.mean),
                "scatter": _plain(sampled.deviation),
                "part": SAMPLED_PART,
                "ends": [_plain(ends[0]), _plain(ends[1])],
                "lost": sampled.lost.tolist(),
            },
            "left_out": _plain(t.left_out(quantity)),
            "inaccurate": t.inaccurate(quantity).tolist(),
        }
    return {
        "name": slopes.model.name,
        "tolerances": {
            name: {"unit": slopes.unit_of(name), "least": band.least, "largest": band.most}
            for name, band in t.bands.items()
        },
        "samples": t.samples,
        "along": slopes.along,
        "unit": slopes.along_unit,
        "places": _plain(slopes.place),
        "quantities": quantities,
    }


def _plain(values: Floats) -> list[float | None]:
    return [float(one) if np.isfinite(one) else None for one in values]


def picture_of(t: _Stack) -> Bands:
    """The bands of all quantities over the rows, with the shares where each scatters most."""
    slopes = t.slopes

    def band(quantity: str) -> Band:
        nominal, row = t.nominal(quantity), t.widest(quantity)

        def off(ends: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
            with np.errstate(invalid="ignore"):
                return ends[0] - nominal, ends[1] - nominal

        return Band(
            quantity,
            slopes.unit_of(quantity),
            off(t.worst(quantity)),
            off(t.root_sum_square(quantity)),
            off(sampled_ends(t, quantity)),
            {name: float(share[row]) for name, share in t.shares(quantity).items()},
            t.place_of(row),
            t.inaccurate(quantity),
        )

    along = f"{slopes.along} [{slopes.along_unit}]" if slopes.along_unit else slopes.along
    bands = tuple(map(band, slopes.quantities))
    return Bands(f"Tolerances of {slopes.model.name}", along, slopes.place, bands, SAMPLED_PART)
