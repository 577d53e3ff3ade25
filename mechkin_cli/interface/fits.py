"""A fit from the question to the answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.fitting.measures import Measured
from mechkin_cli.fitting.search import Progress, found
from mechkin_cli.interface.arguments import a_whole_number
from mechkin_cli.interface.fit_models import FitModels
from mechkin_cli.interface.fit_request import request
from mechkin_cli.interface.fit_result import Fit
from mechkin_cli.interface.fit_slopes import FitSlopes
from mechkin_cli.interface.fit_values import FitValues

if TYPE_CHECKING:
    from mechkin_cli.interface.model import Model


def fit_of(
    model: Model,
    targets: Any,
    parameters: Any,
    constraints: Any,
    starts: int,
    generations: int,
    seed: int,
    progress: Progress | None,
) -> Fit:
    """`Model.fit`, whose arguments these are."""
    starts = a_whole_number("starts", starts, "local searches", 1)
    generations = a_whole_number("generations", generations, "generations", 0)
    seed = a_whole_number("seed", seed, "", 0)
    models = FitModels(model)
    asked = request(model.problem, targets, parameters, constraints)
    values = FitValues(models, asked)
    slopes = FitSlopes(values)
    measured = Measured(values.measure, slopes.stacked)
    own = np.array([one.own for one in asked.parameters])
    best = found(measured, (own - values.lower) / values.width, seed, starts, generations, progress)
    return Fit(values, best, measured, slopes.why)
