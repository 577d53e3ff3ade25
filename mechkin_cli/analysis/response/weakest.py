"""Which freedom has no inertia: the independent coordinates that move along the motion with the
least kinetic energy, for a message."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.solver.codes import Demand

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.session import Session

_TAKES_PART = 0.3
"""A coordinate is named if it moves by so much of the one that moves most; lengths in parts of the
size."""


def weakest_coordinates(session: Session, response: Response, state: Floats) -> list[str]:
    """Names of the independent coordinates that move with least inertia at `state` (states,).

    `session` has the independent coordinates as inputs, then the driven ones. The inertias follow
    from the kinetic energies T at unit rates: m_ij = T(i and j) - T(i) - T(j).
    """
    free, count = len(response.independent), len(session.graph.inputs)
    if free == 1:
        return [".".join(response.independent[0])]
    pairs = [(i, j) for i in range(free) for j in range(i)]
    rates = np.zeros((count, free + len(pairs)))
    rates[range(free), range(free)] = 1.0
    for column, pair in enumerate(pairs, free):
        rates[list(pair), column] = 1.0
    energies = _energies(session, state, rates)
    inertia = np.diag(2.0 * energies[:free])
    for energy, (i, j) in zip(energies[free:], pairs, strict=True):
        inertia[i, j] = inertia[j, i] = energy - energies[i] - energies[j]
    if not np.all(np.isfinite(inertia)):
        return []
    moves = np.abs(np.linalg.eigh(inertia)[1][:, 0])
    return [
        ".".join(coordinate)
        for coordinate, much in zip(response.independent, moves, strict=True)
        if much > _TAKES_PART * moves.max()
    ]


def _energies(session: Session, state: Floats, rates: Floats) -> Floats:
    """Kinetic energy at rates (inputs, cases) of the inputs."""
    wanted = session.problem.quantities()["row.kinetic_energy"]
    readout = session.readout([wanted])
    cases = np.zeros(rates.shape[1], dtype=np.intp)
    places = [session.layout.state(edge, freedom) for edge, freedom in session.graph.inputs]
    batch = session.run(
        state[places][:, None][:, cases],
        state[:, None][:, cases],
        readout=readout,
        rates=rates,
        demand=Demand.VELOCITY,
    )
    assert batch.outputs is not None
    found: Floats = batch.outputs[readout.slots[wanted.name].first]
    return found
