"""Dimensions that do what is wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import Any

    from mechkin_cli.interface.fit_result import Fit
    from mechkin_cli.interface.model import Model


class Fitted:
    """The fits of a model."""

    def fit(
        self,
        targets: Mapping[str, Any] | Sequence[Mapping[str, Any]],
        parameters: Mapping[str, tuple[Any, Any]],
        *,
        constraints: Mapping[str, Any] | Sequence[Mapping[str, Any]] = (),
        starts: int = 4,
        generations: int = 40,
        seed: int = 0,
        progress: Callable[[int, int], None] | None = None,
    ) -> Fit:
        """The parameters whose mechanism comes nearest to what is wanted.

        The file's sweep is the range over which the mechanism has to assemble, in its mode.

        Args:
            targets: a quantity or expression (`of`; `run`: of a response) and what it should be
                (`is`, values or points)
                at inputs (`at`; a curve without it passes its points wherever it comes nearest), or
                what of it should be `least`, "peak" or "rms" over the sweep's rows; `within` is the
                deviation that counts as one, 1 of the file's unit where nothing is said.
            parameters: the least and the largest value by name, as in `with_parameters`.
            constraints: an expression (`of`) and its `min` or `max` in every row of the sweep, or
                of the response that `run` names.
            starts: local searches, the first from the model's own values, the others from the best
                of a population; 1: no population.
            generations: of differential evolution before that.
            seed: of the population; the same one gives the same answer.
            progress: told how many steps are done, and of how many.

        Returns:
            Parameters, deviations, constraints, and a model; `status` says whether all holds.

        Raises:
            UsageError: scipy is not installed (extra `fit`), an unknown name, an invalid value.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/planar_four_bar.yaml")
            >>> wanted = m.with_parameters({"a": 35, "c": 95}).analyze()["C.theta"][[4, 8, 16]]
            >>> target = {"of": "C.theta", "at": [60, 120, 240], "is": wanted.tolist()}
            >>> f = m.fit(target, {"a": (30, 50), "c": (80, 100)}, starts=1)
            >>> f.status, {name: round(value, 6) for name, value in f.parameters.items()}
            ('fitted', {'a': 35.0, 'c': 95.0})
        """
        from mechkin_cli.interface.fits import fit_of

        model: Model = self  # type: ignore[assignment]
        return fit_of(model, targets, parameters, constraints, starts, generations, seed, progress)
