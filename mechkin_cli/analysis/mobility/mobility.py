"""Mobility: Kutzbach's count against the true freedom by rank, and what makes them differ.

With n links (ground too), j joints and freedoms f, the count is 6 (n - 1 - j) + sum f: all freedoms
less six for every loop. The true mobility is sum f less the rank of the loops' screws, taken at
several configurations that finite steps along the motion reach: what moves to first order only does
not move. Their difference is the number of redundant constraints.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.configurations import (
    Body,
    Configuration,
    along_motion,
    assembled,
    home,
)
from mechkin_cli.analysis.mobility.first_row import first_row
from mechkin_cli.analysis.mobility.idle import IdleFreedom, idle_freedoms
from mechkin_cli.analysis.mobility.inputs import input_notes
from mechkin_cli.analysis.mobility.redundancy import Redundancy, redundancies
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.random_starts import RandomStarts

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


class Rank(NamedTuple):
    """Rank of the loops' closing: `motions` (freedoms, count) are what it allows, `stresses`
    (6 cuts, redundant) the wrenches at the cuts that hold each other; `gap` is the ratio of
    singular values at the rank."""

    motions: Floats
    stresses: Floats
    gap: float

    @property
    def clear(self) -> bool:
        """Whether the gap decides the rank."""
        return self.gap >= tolerances.RANK_GAP


@dataclass(frozen=True)
class Mobility:
    """What can move.

    `count` is Kutzbach's; `mobility` the true one, None where it cannot be told (no assembly, or
    rank unclear); `first_order` the freedom at the first configuration, larger than `mobility`
    where part of it exists to first order only. `loops` counts independent loops, `inputs` the
    driven coordinates; `fixed` are the coordinates that never move.
    """

    name: str
    count: int
    loops: int
    inputs: tuple[str, ...]
    mobility: int | None
    first_order: int | None
    configurations: int
    idle: tuple[IdleFreedom, ...]
    redundant: tuple[Redundancy, ...]
    fixed: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]

    @property
    def useful(self) -> int | None:
        """Freedoms beside the idle ones."""
        return None if self.mobility is None else self.mobility - len(self.idle)

    @property
    def verdict(self) -> str:
        """What count and truth say together, in one sentence."""
        if self.mobility is None:
            return f"mobility unclear; the count says {self.count}"
        return f"{_moves(self)}; {_compared(self)}"


def _moves(found: Mobility) -> str:
    if not found.mobility:
        text = "nothing can move"
        return f"{text} but to first order" if found.first_order else text
    freedom = "one freedom" if found.mobility == 1 else f"{found.mobility} freedoms"
    idle = f", {len(found.idle)} of them idle" if found.idle else ""
    return f"{freedom}{idle}"


def _compared(found: Mobility) -> str:
    if found.mobility == found.count:
        return "as Kutzbach's count says"
    extra = (found.mobility or 0) - found.count
    if not found.mobility:
        return f"Kutzbach's count is {found.count}"
    constraints = "one constraint is" if extra == 1 else f"{extra} constraints are"
    return (
        f"Kutzbach's count is {found.count}: {constraints} redundant, so it moves only while the "
        "dimensions are exact"
    )


def find_mobility(problem: Problem, session: Session | None = None) -> Mobility:
    """The mobility of a mechanism; its inputs count as free. `session` of the problem, where it can
    be solved as it is driven, gives the first row's assembly."""
    mechanism = problem.mechanism
    body = Body(mechanism)
    start = (session and first_row(session, body)) or assembled(body)
    if start is None:
        return _unknown(problem, [_not_assembled(body)])
    first = rank_of(start)
    reached = _configurations(start, first)
    ranks = [rank_of(configuration) for configuration in reached]
    general = min(range(len(ranks)), key=lambda i: ranks[i].motions.shape[1])
    rank, configuration = ranks[general], reached[general]
    unclear = [r for r in [first, *ranks] if not r.clear]
    if unclear:
        return _unknown(problem, [_rank_unclear(unclear)])
    finite = len(reached) > 1 or first.motions.shape[1] == 0
    motions = rank.motions if finite else rank.motions[:, :0]
    driven = problem.motion.driven
    idle = idle_freedoms(configuration, driven) if finite else ()
    return Mobility(
        name=mechanism.name,
        count=kutzbach(mechanism),
        loops=loops(mechanism),
        inputs=tuple(item.name for item in problem.motion.inputs),
        mobility=motions.shape[1],
        first_order=first.motions.shape[1],
        configurations=len(reached),
        idle=idle,
        redundant=redundancies(configuration, rank.stresses, {name for name, _ in driven}),
        fixed=_fixed(reached, ranks, finite),
        diagnostics=tuple(input_notes(problem, configuration, motions, len(idle))),
    )


def kutzbach(mechanism: Mechanism) -> int:
    """6 (n - 1 - j) + sum f."""
    freedom = sum(joint.type.freedoms for joint in mechanism.joints.values())
    return freedom - 6 * loops(mechanism)


def loops(mechanism: Mechanism) -> int:
    """Number of independent loops."""
    return mechanism.loops


def rank_of(configuration: Configuration) -> Rank:
    """Rank, motions and stresses by singular values with the gap rule."""
    matrix = configuration.jacobian
    rows, columns = matrix.shape
    if rows == 0 or columns == 0:
        return Rank(np.eye(columns), np.eye(rows), np.inf)
    left, values, right = np.linalg.svd(matrix)
    least = tolerances.RANK_ROUNDING * values[0]
    values = np.maximum(values, least)
    rank = int(np.count_nonzero(values > tolerances.RANK_ZERO * values[0]))
    below = values[rank] if rank < len(values) else least
    return Rank(right[rank:].T, left[:, rank:], float(values[rank - 1] / below))


def _configurations(start: Configuration, first: Rank) -> list[Configuration]:
    """The start and configurations that finite motions reach one after the other."""
    random, reached, rank = RandomStarts(), [start], first
    for _ in range(tolerances.MOBILITY_CONFIGURATIONS):
        there = along_motion(reached[-1], rank.motions, random)
        if there is None:
            break
        reached.append(there)
        rank = rank_of(there)
    return reached


def _fixed(reached: list[Configuration], ranks: list[Rank], finite: bool) -> tuple[str, ...]:
    """Coordinates that no motion at any configuration changes."""
    names = []
    for joint in reached[0].body.mechanism.joints.values():
        largest = np.zeros(joint.type.freedoms)
        for configuration, rank in zip(reached, ranks, strict=True):
            if finite and rank.motions.size:
                rates = np.abs(rank.motions[configuration.body.columns[joint.name]])
                largest = np.maximum(largest, rates.max(axis=1))
        for name, freedom in joint.type.freedom_of.items():
            if largest[freedom] < tolerances.RANK_ZERO:
                names.append(f"{joint.name}.{name}")
    return tuple(names)


def _unknown(problem: Problem, diagnostics: list[Diagnostic]) -> Mobility:
    mechanism = problem.mechanism
    return Mobility(
        name=mechanism.name,
        count=kutzbach(mechanism),
        loops=loops(mechanism),
        inputs=tuple(item.name for item in problem.motion.inputs),
        mobility=None,
        first_order=None,
        configurations=0,
        idle=(),
        redundant=(),
        fixed=(),
        diagnostics=tuple(diagnostics),
    )


def _not_assembled(body: Body) -> Diagnostic:
    return Diagnostic(
        "not-assembled",
        "error",
        f"{body.mechanism.name} could not be assembled, so only the count is known",
        measured=f"from the drawing the loops close to {home(body).closed().miss:.2g} of the size",
        limit=f"{tolerances.MOBILITY_CLOSED:g}",
        hint="check the dimensions; those of an overconstrained loop must be exact "
        "(write expressions)",
    )


def _rank_unclear(unclear: list[Rank]) -> Diagnostic:
    return Diagnostic(
        "rank-unclear",
        "error",
        "the rank of the constraints cannot be told",
        measured=f"a gap of {min(rank.gap for rank in unclear):.3g} between singular values",
        limit=f"{tolerances.RANK_GAP:g}",
        hint="write exact dimensions (expressions), or another position of the inputs",
    )
