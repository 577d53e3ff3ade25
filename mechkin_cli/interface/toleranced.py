"""Sensitivities and tolerances of a model."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mechkin_cli.building.build import Built
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.interface.arguments import Setting
    from mechkin_cli.interface.model import Model
    from mechkin_cli.interface.sensitivities import Sensitivities
    from mechkin_cli.interface.stack import Tolerances
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.solver.shifted import ShiftingPrecise


class Toleranced:
    """What parameters do to the quantities of a model."""

    built: Built

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        raise NotImplementedError

    @property
    def _given(self) -> Mapping[str, Quantity]:
        """Values of parameters that were set, in SI."""
        return MappingProxyType({})

    @cached_property
    def shifting(self) -> ShiftingPrecise:
        """As `Model.precise`, with parameters that can be shifted.

        Raises:
            TraceLost: a number depends on the text in a way that no tape holds.
        """
        from mechkin_cli.building.recording import shifting

        return shifting(self.built, self.problem, self._given)

    def sensitivities(
        self,
        quantities: Iterable[str],
        parameters: Iterable[str] | None = None,
        at: Setting | Iterable[Setting] | None = None,
        *,
        run: str | None = None,
        threads: int = 0,
    ) -> Sensitivities:
        """How quantities change with parameters, to first order, at every row: exact to rounding.

        The rows are closed again in double-double with the parameter a little less and a little
        more, so whatever `--errors` repeats has sensitivities: positions, rates, accelerations,
        reactions, efforts, expressions, columns. A row keeps its number: where inputs are written
        with parameters they move with them, as the file says. Other parameters that are written
        with the one that changes follow it.

        It costs a recording of the file, which the model keeps (0.1 s for the RCSR), and for each
        parameter two runs of the chosen rows in double-double; a response is run and repeated
        anew for both values, which takes seconds.

        Args:
            quantities: quantities, expressions or labels of columns.
            parameters: names; None: all.
            at: values of the input that moves (or of time) at which rows stand, numbers in the
                file's units or texts; None: all rows.
            run: a response instead of the sweep; None: the file's first run.
            threads: how many split the rows, 0 for as many as pay.

        Raises:
            UsageError: unknown names, words instead of numbers, a place without a row.
            ExpressionError: no such quantity, or dimensions that do not fit.
            InvalidFile: the mechanism cannot be solved as it is driven.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/rcsr.yaml")
            >>> s = m.sensitivities(["O4.theta"], ["P1", "alpha1"], at=170)
            >>> s["O4.theta", "P1"].round(4).tolist(), s.unit("O4.theta", "P1")
            ([39.755], 'deg/in')
        """
        from mechkin_cli.interface.sensitivities import sensitivities

        model: Model = self  # type: ignore[assignment]
        return sensitivities(model, quantities, parameters, at, run, threads)

    def tolerances(
        self,
        tolerances: Mapping[str, Setting | Sequence[Setting]],
        quantities: Iterable[str],
        at: Setting | Iterable[Setting] | None = None,
        *,
        samples: int = 1024,
        method: str = "latin",
        seed: int = 0,
        distribution: str = "uniform",
    ) -> Tolerances:
        """What tolerances of parameters do to quantities: worst cases, root sum square and shares
        to first order, and samples beside them.

        Args:
            tolerances: by name half the width of a band about the parameter's own value, or its two
                ends; numbers in the file's units or texts. Each scatters by itself: none follows
                another that it is written with.
            quantities: as those of `sensitivities`, but no vectors.
            at: as there.
            samples: how many variants are run beside.
            method: how they are drawn: "latin", "sobol" or "random", with a `seed`.
            distribution: within the bands: "uniform", or "normal" with a third of half the width
                as standard deviation, which nothing cuts off.

        Raises:
            UsageError: unknown names, invalid values, empty bands, a vector.
            ExpressionError: no such quantity, or dimensions that do not fit.
            InvalidFile: the mechanism cannot be solved as it is driven.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/rcsr.yaml")
            >>> t = m.tolerances({"P1": "0.002 in", "P2": "0.002 in"}, ["O4.theta"], samples=64)
            >>> {name: round(float(share[-1]), 2) for name, share in t.shares("O4.theta").items()}
            {'P2': 0.8, 'P1': 0.2}
        """
        from mechkin_cli.interface.stack import stack

        model: Model = self  # type: ignore[assignment]
        given = (at, samples, method, seed, distribution)
        return stack(model, tolerances, quantities, *given)
