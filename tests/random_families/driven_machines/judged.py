"""What all families of driven machines share: how a file begins, and what is said of a seed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import yaml

import mechkin_cli as mk

Floats = np.ndarray
UNITS = {"length": "m", "angle": "rad", "mass": "kg", "force": "N"}


def begun(*, plane: bool) -> dict[str, Any]:
    """A file without its sections."""
    head: dict[str, Any] = {"format": 1, "name": "machine", "units": UNITS}
    return head | {"plane": "xy"} if plane else head


def numbers(vector: Any) -> list[float]:
    """A vector as files have it."""
    return [float(x) for x in vector]


class Judged:
    """The rows of a seed that were compared, and what is at fault.

    Attributes:
        remark: what the seed drew.
        data: the file.
        rows: that were compared.
        worst: largest error, in parts of its limit.
    """

    def __init__(self) -> None:
        self.remark = ""
        self.data: dict[str, Any] = {}
        self.rows = 0
        self.worst = 0.0
        self.faults: list[str] = []

    @property
    def fault(self) -> str:
        """The first faults, empty where there are none."""
        return "; ".join(self.faults[:3])

    @property
    def text(self) -> str:
        """The file as text."""
        return yaml.safe_dump(self.data, sort_keys=False)

    @property
    def figures(self) -> Mapping[str, float]:
        """The largest error."""
        return {"parts of the limit": self.worst}

    def model(self, data: dict[str, Any]) -> mk.Model:
        """The model of a file, which is kept to be shown."""
        self.data = data
        return mk.load(data)

    def compare(self, name: str, found: Any, wanted: Any, size: float, limit: float) -> None:
        """Both are alike within `limit` in parts of `size`; what is not finite is not alike.

        Args:
            wanted: a value of each row, or one of all rows.
        """
        found, wanted = np.asarray(found, float), np.asarray(wanted, float)
        off = float(np.max(np.abs(found - wanted)))
        if not off <= limit * size:
            self.faults.append(f"{name} {found.ravel()[:4]} is not {wanted.ravel()[:4]}")
        elif limit * size > 0.0:
            self.worst = max(self.worst, off / (limit * size))

    def values(self, result: Any, wanted: dict[str, Any], limit: float) -> None:
        """Columns, each in parts of its largest value."""
        for name, right in wanted.items():
            size = float(np.max(np.abs(right))) or 1.0
            self.compare(name, result[name], right, size, limit)

    def is_ok(self, result: Any, other: Sequence[str] = ()) -> bool:
        """Counts the rows; whether all of them are ok, or what else they may be."""
        status = [str(word) for word in result["row.status"]]
        self.rows += len(status)
        strange = {*status} - {"ok", *other}
        if strange:
            self.faults.append(f"rows are {sorted(strange)}: {list(result.diagnostics)[:1]}"[:300])
        return not strange
