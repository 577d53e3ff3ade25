"""A case in several writings: the same rows, rates, efforts and statuses."""

from __future__ import annotations

from copy import deepcopy
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from random_families.no_wrong_row.case import Case, text_of
from random_families.no_wrong_row.transforms import WRITINGS

import mechkin_cli as mk

Array = NDArray[np.float64]
EXACTNESS = 1e-9
"""Of positions, rates and efforts, in parts of the largest of their kind in the row, times the
condition; accelerations and efforts also in parts of squared rates."""
RATES = ("", "_dot", "_ddot")
GRAVITY = "loads:\n  - {type: gravity, g: [2, -3, -9]}\n"


class Rows(NamedTuple):
    """Statuses, conditions, and values (columns, rows) by kind."""

    status: list[str]
    condition: Array
    values: dict[str, Array]


def differences(case: Case) -> dict[str, str]:
    """By writing, the first difference from the case as drawn."""
    drawing = case.drawing
    drawing.heavy = {link for link in drawing.links if link.startswith("link_")}
    columns = list(drawing.columns)
    as_drawn = rows_of(case, deepcopy(drawing), [c.name for c in columns])
    found = {}
    for name, write in WRITINGS.items():
        other = deepcopy(drawing)
        write(other)
        names = [c.name for c in other.columns[: len(columns)]]
        words = difference(case, as_drawn, rows_of(case, other, names), [c.name for c in columns])
        if words:
            found[name] = words
    return found


def text_in(case: Case, drawing: object) -> str:
    travel = case.travel
    if travel.text.startswith("{from"):
        moving = travel.text.rstrip("}") + ", rate: 30, acceleration: 7}"
        travel = travel.__class__(travel.rows, travel.highest, travel.lowest, moving, travel.head)
    return text_of(drawing, travel, "", GRAVITY, shuffled=False)  # type: ignore[arg-type]


def rows_of(case: Case, drawing: object, names: list[str]) -> Rows:
    quantities = [n for n in names if n.rpartition(".")[2] not in ("x", "y", "z")]
    asked = [n + rate for n in quantities for rate in RATES] + ["A.effort"]
    result = mk.loads(text_in(case, drawing)).analyze([*asked, "row.condition"], tables=[])
    values = {
        f"coordinate{rate}": np.array([result[n + rate] for n in quantities]) for rate in RATES
    }
    values["effort"] = np.array([result["A.effort"]])
    return Rows(result["row.status"].tolist(), np.asarray(result["row.condition"]), values)


def difference(case: Case, one: Rows, two: Rows, names: list[str]) -> str:
    for k, (a, b) in enumerate(zip(one.status, two.status, strict=True)):
        if a != b:
            return f"row {k} at {case.travel.rows[k]:.9g} deg: {b} for {a}"
    with np.errstate(invalid="ignore"):
        condition = np.fmax(1.0, np.fmax(one.condition, two.condition))
        # accelerations are sums of squared rates over singular values
        rates = np.nanmax(np.abs(one.values["coordinate_dot"]), axis=0, initial=0.0)
        bends = rates**2
        for kind, want in one.values.items():
            have = two.values[kind]
            largest = np.nanmax(np.abs(want), axis=0, initial=1.0)
            if kind in ("coordinate_ddot", "effort"):
                largest = np.fmax(largest, bends)
            if (np.isnan(want) != np.isnan(have)).any():
                return f"{kind}: cells are empty in one of them"
            wrong = np.abs(have - want) > EXACTNESS * condition * largest
            for column, row in np.argwhere(wrong)[:1]:
                name = names[column] if kind != "effort" else "A"
                return (
                    f"{name} {kind}, row {row} at {case.travel.rows[row]:.9g} deg, condition "
                    f"{condition[row]:.2g}: {have[column, row]:.12g} for {want[column, row]:.12g}"
                )
    return ""
