"""A response or a balance as a problem of its own: its first moment, and what it reads."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.mechanism.motion import MotionInputs
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.response import AnyBalance, Harmonics, ResponseProblem, first_motion
from mechkin_cli.record import replace

if TYPE_CHECKING:
    from collections.abc import Iterable


def response_problem(
    problem: Problem, response: ResponseProblem, motion: MotionInputs | None = None
) -> Problem:
    """The problem at the first moment of a response, with its loads, laws and quantities.

    Its motion, or the `motion` that is given, has one row, in which the start's coordinates are
    inputs; a solver graph of its `driven` is that of the assembly at the start.
    """
    return replace(
        problem,
        mechanism=response.mechanism,
        motion=first_motion(response, problem.units) if motion is None else motion,
        assembly=response.assembly,
        load_laws=response.load_laws,
        held=response.held,
        follow=None,
        response=response,
    )


def read_by(balances: Iterable[AnyBalance], problem: Problem) -> list[str]:
    """Names of the quantities that balances read at once."""
    found: list[str] = []
    for balance in balances:
        if isinstance(balance, Harmonics):
            known = problem.quantities()
            for _, expression in balance.of:
                names = sorted(expression.names)
                found += [n if n in known else n.rpartition(".")[0] for n in names]
        else:
            found += [f"{joint}.{coordinate}.effort" for joint, coordinate in problem.acting]
    return [name for name in dict.fromkeys(found) if name in problem.quantities()]
