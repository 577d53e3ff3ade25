"""The measure of errors: largest differences in parts of a quantity's largest value."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from benchmark.exact import ExactSpecimen


@dataclass(frozen=True)
class Errors:
    """Largest errors in parts of their quantity's largest value; None where there is nothing."""

    position: float | None
    velocity: float | None
    acceleration: float | None
    loads: float | None


def errors(specimen: ExactSpecimen, found: Mapping[str, Any], exact: Mapping[str, Any]) -> Errors:
    """Errors of the quantities that were found."""
    groups = (*specimen.motion, [name for name in specimen.loads if name not in specimen.zeros])
    return Errors(*(_largest(found, exact, names) for names in groups))


def _largest(
    found: Mapping[str, Any], exact: Mapping[str, Any], names: Iterable[str]
) -> float | None:
    present = [name for name in names if name in found]
    if not present:
        return None
    return max(relative_error(found[name], exact[name]) for name in present)


def relative_error(found: Any, exact: Any) -> float:
    """Largest difference in parts of the largest value; angles are not wrapped."""
    return float(np.max(np.abs(found - exact)) / np.max(np.abs(exact)))
