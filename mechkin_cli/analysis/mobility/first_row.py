"""The first row's assembly as poses of the links."""

from __future__ import annotations

import numpy as np

from mechkin_cli.analysis.assembly import choose_start
from mechkin_cli.analysis.mobility.configurations import Body, Configuration, Poses
from mechkin_cli.analysis.probe import Probe
from mechkin_cli.analysis.rows import kernel_inputs
from mechkin_cli.mechanism.model import Attached
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.demand import OutputPlan
from mechkin_cli.solver.graph import UnsolvableGraph, build_graph
from mechkin_cli.solver.layout import Layout


def first_row(problem: Problem, body: Body) -> Configuration | None:
    """The assembly that a sweep starts from; None if the file drives none that can be solved."""
    if not problem.motion.inputs:
        return None
    try:
        graph = build_graph(problem.mechanism, problem.motion.driven)
    except UnsolvableGraph:
        return None
    layout = Layout(problem.mechanism, graph)
    inputs = kernel_inputs(problem, layout).values[:, 0]
    start = choose_start(problem, layout, layout.build(), inputs[:, None], Probe(problem, layout))
    if start.state is None:
        return None
    plan = layout.build()
    outputs = OutputPlan(layout, plan, problem.motion.driven)
    marks = [body.centre, *(body.centre + body.size * axis for axis in np.eye(3))]
    slots = [
        [outputs.add_point(Attached(link, tuple(mark.tolist())), 0) for mark in marks]
        for link in body.links
    ]
    values = run(plan, inputs[:, None], start.state[:, None], outputs=outputs.outputs).outputs
    assert values is not None
    turns, places = [], []
    for link in slots:
        origin, *tips = ((values[s : s + 3, 0] - body.centre) / body.size for s in link)
        turns.append(np.stack([tip - origin for tip in tips], axis=1))
        places.append(origin)
    found = Configuration(body, Poses(np.array(turns), np.array(places)))
    return found if found.assembled else None
