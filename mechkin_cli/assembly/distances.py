"""How far assemblies are from what the file names and from the drawing."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly.home import is_cyclic, probe_of, wrapped
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import Problem, dimension_of, is_angle
from mechkin_cli.record import dataclass, field
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


def far_notes(session: Session, inputs: Floats, state: Floats) -> list[Diagnostic]:
    """A warning where an assembly (states,) lies far from what `near` names."""
    problem = session.problem
    coordinates, _ = probe_of(session).read(inputs, state[:, None])
    places = {name: float(coordinates[name][0]) for name in problem.assembly.near}
    far = []
    for name, target in problem.assembly.near.items():
        if abs(_miss(problem, name, places[name], target)) > tolerances.NEAR_FAR:
            dimension = dimension_of(name.rpartition(".")[2])
            value = float(problem.units.from_si(places[name], dimension))
            far.append(Number(name, value, problem.units.label(dimension)))
    if not far:
        return []
    return [
        Diagnostic(
            "nearest-far",
            "warning",
            "no assembly was found near what near names",
            measured=f"the nearest has {', '.join(f'{n.name} = {n.value:.6g}' for n in far)}",
            limit=f"{tolerances.NEAR_FAR:g} rad or sizes",
            hint="see mechkin modes for the assemblies at the first row",
            numbers=tuple(far),
        )
    ]


def _miss(problem: Problem, name: str, value: float, target: float) -> float:
    """How far a coordinate is off: angles the shorter way round, slides in sizes."""
    miss = value - target
    if is_cyclic(problem.mechanism, name):
        return wrapped(miss)
    if is_angle(name.rpartition(".")[2]):
        return miss
    return miss / problem.mechanism.box_diagonal()


def distances_of(
    session: Session, inputs: Floats, states: Floats
) -> tuple[list[float], list[float]]:
    """Of assemblies (states, number) from what `near` names, and from the drawing."""
    coordinates, points = probe_of(session).read(inputs, states)
    return distances_near(session.problem, coordinates), distances_home(session, points)


def in_order(distances: list[float], home: list[float]) -> list[int]:
    """Numbers of assemblies, the nearest first; among those as near but for rounding, the nearest
    to the drawing."""
    least = min(distances, default=0.0)
    equal = [i for i, d in enumerate(distances) if d <= least + tolerances.SAME_MODE]
    rest = [i for i in range(len(distances)) if i not in equal]
    rest.sort(key=lambda i: distances[i])
    return [*sorted(equal, key=lambda i: home[i]), *rest]


def is_unclear(best: float, second: float) -> bool:
    """Whether a runner-up is about as near as the nearest."""
    return second < max(tolerances.NEAR_RUNNER_UP * best, best + tolerances.SAME_MODE)


def distances_near(problem: Problem, coordinates: Mapping[str, Floats]) -> list[float]:
    """Of every assembly from what `near` names."""
    distances = []
    for i in range(len(next(iter(coordinates.values())))):
        total = 0.0
        for name, target in problem.assembly.near.items():
            miss = _miss(problem, name, float(coordinates[name][i]), target)
            total += miss * miss
        distances.append(sqrt(total))
    return distances


def distances_home(session: Session, points: Floats) -> list[float]:
    """Root mean square over the moving links' joint points, in parts of the size."""
    home = np.array([at.vector for at in probe_of(session).points])[:, :, None]
    miss = (points - home) / session.problem.mechanism.box_diagonal()
    total = np.zeros(points.shape[2])
    for x, y, z in miss:
        total = total + (x * x + y * y + z * z)
    return [sqrt(float(squares) / len(home)) for squares in total]


def unclear(both: str, distances: tuple[float, float]) -> Diagnostic:
    """A warning that two assemblies are about as near."""
    return Diagnostic(
        "nearest-unclear",
        "warning",
        f"{both} are about equally near",
        measured=f"distances {distances[0]:.4g} and {distances[1]:.4g}",
        limit=f"ratio {tolerances.NEAR_RUNNER_UP}",
        hint="give more coordinates under assembly: near",
        numbers=tuple(Number("distance", distance) for distance in distances),
    )


@dataclass(frozen=True)
class AssemblyStart:
    """States at a row (the first, or the one nearest to an assembled home) and the mode's name,
    where it is known (else `near` or `home`); `how` it was found, in words. Without states `status`
    is the reason why there are none, and `stuck` whether the inputs did not move from the drawing
    at all. `off` is the distance from what `near` names and `condition` that of the assembly, as
    far as the choice has needed them."""

    state: Floats | None
    mode: str
    how: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    status: Status = Status.not_assembled
    row: int = 0
    stuck: bool = False
    off: float = inf
    condition: float | None = None
