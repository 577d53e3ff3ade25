"""The columns of the source's tables: which are kinematic, which are loads, how many decimals."""

from __future__ import annotations

import numpy as np
from references import exact, published

KINEMATICS = tuple(f"table_{number:02}" for number in range(3, 10))
LOADS = tuple(f"table_{number}" for number in range(15, 19))
DECIMALS = dict.fromkeys(KINEMATICS, 3) | dict.fromkeys(LOADS, 2)
ROWS = 27


def labels(names: tuple[str, ...]) -> list[tuple[str, str]]:
    """(table, label) of every column but the input's."""
    return [(name, label) for name in names for label in published(name) if label != "theta1"]


def exact_values(column: str) -> np.ndarray:
    """Seventeen digits, which reading rounds to the nearest double."""
    return np.array([float(text) for text in exact("rcsr")[column]])


def printed_units(name: str, label: str, values: np.ndarray) -> np.ndarray:
    """Printed less computed values, in units of the last printed digit."""
    printed = np.array([float(text) for text in published(name)[label]])
    return (printed - values) * 10 ** DECIMALS[name]
