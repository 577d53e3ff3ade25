"""Rows whose unknown states are moved by random amounts, and where the true ones lie from there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mechkin_cli.proofs.boxes import Boxes, Enclosed, Nodes, prove_boxes
from mechkin_cli.sweep.result import Result


class Moved(NamedTuple):
    """Boxes about moved places, and how far the true positions lie from their middles by columns
    (columns, rows)."""

    boxes: Boxes
    off: np.ndarray


def quaternion_product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    return np.array(
        [
            p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
        ]
    )


def moved(result: Result, by: float, seed: int) -> Moved:
    session, random = result.session, np.random.default_rng(seed)
    solved = result.solved & result.row_states.reached
    true = result.row_states.states[:, solved]
    inputs = session.inputs.values[:, solved], session.inputs.reduced[:, solved]
    enclosed = Enclosed.of(session)
    unknown = prove_boxes(enclosed, Nodes.of(session, *inputs, true)).radius.max(axis=1) > 0.0
    states, off = true.copy(), np.zeros((len(unknown), true.shape[1]))
    for carrier in session.layout.carriers:
        for number in range(len(carrier.part.type.freedoms)):
            column = carrier.column + number
            if unknown[column]:
                off[column] = by * random.uniform(-1, 1, true.shape[1])
        columns = slice(carrier.column, carrier.column + len(carrier.part.type.freedoms))
        own = slice(carrier.state, carrier.state + carrier.part.type.states)
        if carrier.part.type.is_ball:
            # the way back from where (1, -x / 2) leads is x
            half = np.concatenate([np.ones((1, true.shape[1])), -0.5 * off[columns]])
            states[own] = quaternion_product(half, true[own])
            states[own] /= np.sqrt((states[own] ** 2).sum(axis=0))
        else:
            states[own] -= off[columns]
    return Moved(prove_boxes(enclosed, Nodes.of(session, *inputs, states)), off)
