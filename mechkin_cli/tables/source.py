"""What tables ask of the results of an analysis: rows, inputs, verdicts and quantities by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.units import UnitSystem

FloatArray = NDArray[np.float64]
StatusArray = NDArray[np.int8]


class Source(Protocol):
    """Results of one analysis; every array has the shape (rows,)."""

    @property
    def rows(self) -> int:
        """Number of rows asked for."""
        ...

    @property
    def coordinates(self) -> Sequence[str]:
        """Scalar joint coordinates in joint order, such as `O1.theta`."""
        ...

    @property
    def inputs(self) -> Mapping[str, FloatArray]:
        """Time where there is one, and values of the driven coordinates, in file units exactly as
        written."""
        ...

    @property
    def input_rates(self) -> Mapping[str, FloatArray]:
        """Rates of the driven coordinates, in file units as written; nan in rows without a
        solution."""
        ...

    @property
    def mode(self) -> str:
        """Name of the assembly mode that the rows follow."""
        ...

    @property
    def letter(self) -> str:
        """The same by its letter, which may have to be searched for."""
        ...

    @property
    def events(self) -> Sequence[str]:
        """What happened at each row of a response, "" where nothing did; () of a sweep."""
        ...

    @property
    def status(self) -> StatusArray:
        """Codes of `mechkin_cli.status.Status`."""
        ...

    @property
    def is_certified(self) -> bool:
        """Whether proofs of the rows have been asked for."""
        ...

    @property
    def proven_way(self) -> tuple[bool, int]:
        """Whether all rows are proven to lie on one branch, and how many tubes join them."""
        ...

    @property
    def proven_dead_centres(self) -> Sequence[Mapping[str, object]]:
        """What is proven of the dead centres beyond which rows are missing, as plain data."""
        ...

    @property
    def proof(self) -> StatusArray:
        """Codes of `mechkin_cli.proof.Proof`, found now if they were not."""
        ...

    @property
    def residual(self) -> FloatArray:
        """Largest closure component of the row, dimensionless; nan where not computed."""
        ...

    @property
    def condition(self) -> FloatArray:
        """Condition of the row's closure, dimensionless; nan where not computed."""
        ...

    @property
    def power_error(self) -> FloatArray:
        """|sum of powers| / sum of |powers|, dimensionless; nan where not computed."""
        ...

    @property
    def units(self) -> UnitSystem:
        """Units of the mechanism file; tables are written in them."""
        ...

    @property
    def alternatives(self) -> Sequence[Source]:
        """The same rows with other reactions in equilibrium, where constraints are redundant."""
        ...

    @property
    def disturbed(self) -> Sequence[Source]:
        """The same rows with reactions that are off by their rounding, where constraints are
        redundant."""
        ...

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by its dotted name, in SI.

        Raises:
            UnknownName: nothing has this name.
        """
        ...
