"""The motion of the inputs over the rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class DrivenInput(NamedTuple):
    """One driven coordinate: values over the rows in rad or m, and as written in the file's
    units."""

    joint: str
    coordinate: str
    values: Floats
    written: Floats
    rates: Floats
    accelerations: Floats

    @property
    def name(self) -> str:
        """The coordinate's full name, `O1.theta`."""
        return f"{self.joint}.{self.coordinate}"


class Motion(NamedTuple):
    """All inputs; a mechanism without inputs has one row."""

    inputs: tuple[DrivenInput, ...]
    rows: int

    @property
    def driven(self) -> list[tuple[str, str]]:
        """(joint, coordinate) of the inputs."""
        return [(i.joint, i.coordinate) for i in self.inputs]


@dataclass(frozen=True)
class Assembly:
    """Which assembly is meant at the first row: near some coordinates (rad, m), a mode, or
    neither."""

    near: Mapping[str, float] = field(default_factory=dict)
    mode: str | None = None
    turns: int = 1
