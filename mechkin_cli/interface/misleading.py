"""Where slopes mislead: steep ones that soon bend, as beside a dead centre."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances

if TYPE_CHECKING:
    from mechkin_cli.interface.sensitivities import Sensitivities


def misleading(s: Sensitivities) -> list[str]:
    """A sentence for each quantity with such a slope, of the one that bends soonest."""
    notes = []
    for quantity in s.quantities:
        part, row, name = min(_soonest(s, quantity, name) for name in s.parameters)
        if part < tolerances.SHORT_REACH:
            far = f"{s.reach(quantity, name)[row]:.2g} {s.unit_of(name)}".rstrip()
            place = f"{s.place[row]:.6g} {s.along_unit}".rstrip()
            notes.append(
                f"{quantity}: slopes mislead near {place}, as beside a dead centre: a tenth is "
                f"wrong for a change of {name} by {far}"
            )
    return notes


def _soonest(s: Sensitivities, quantity: str, name: str) -> tuple[float, int, str]:
    """The least reach of a slope that is not small, in parts of the parameter's scale, and its row;
    infinite where no slope is other than zero."""
    slope, reach = s[quantity, name], s.reach(quantity, name)
    sizes = np.linalg.norm(slope, axis=1) if slope.ndim > 1 else np.abs(slope)
    known = np.isfinite(sizes) & (sizes > 0.0)
    if not known.any():
        return np.inf, 0, name
    steep = known & (sizes >= np.median(sizes[known]))
    row = int(np.where(steep, reach, np.inf).argmin())
    return float(reach[row]) / s.scale_of(name), row, name
