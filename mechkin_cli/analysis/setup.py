"""What a sweep fixes before its first row is run: the part of the mechanism that is followed, what
is computed, the kernel's plan and inputs, and the first assembly."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from mechkin_cli.analysis.assembly import Start, choose_start
from mechkin_cli.analysis.probe import Probe
from mechkin_cli.analysis.rows import KernelInputs, kernel_inputs
from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import OutputPlan, demand_of
from mechkin_cli.solver.graph import SolverGraph, build_graph
from mechkin_cli.solver.layout import Layout


@dataclass(frozen=True)
class Setup:
    """A sweep that is ready to run.

    `asked` are the quantities asked for; `wanted` those that the kernel computes for them, whose
    plan `outputs` holds; `lanes` is the width of its packs (0 for the widest).
    """

    problem: Problem
    asked: tuple[Wanted, ...]
    wanted: tuple[Wanted, ...]
    demand: Demand
    layout: Layout
    inputs: KernelInputs
    start: Start
    outputs: OutputPlan
    lanes: int

    @property
    def graph(self) -> SolverGraph:
        """Tree, closing joints and blocks of the part that is followed."""
        return self.layout.graph

    @property
    def derived(self) -> list[Wanted]:
        """The quantities asked for that are computed from a finished run."""
        return [quantity for quantity in self.asked if quantity.kind in DERIVED_KINDS]

    def reading(self, wanted: Iterable[Wanted], demand: Demand) -> Setup:
        """The same sweep for other quantities."""
        wanted = tuple(wanted)
        outputs = _planned(self.problem, self.layout, wanted)
        return replace(self, wanted=wanted, demand=demand, outputs=outputs)


def prepare(
    problem: Problem,
    quantities: Iterable[str],
    *,
    verdicts: bool,
    closed_at: list[str] | None,
    lanes: int,
) -> Setup:
    """Prepares the sweep of `analyze`, whose arguments these are.

    Raises:
        UnsolvableGraph: the mechanism cannot be solved as it is driven.
        KeyError: an unknown quantity.
    """
    known = problem.quantities()
    asked = [known[name] for name in dict.fromkeys(quantities)]
    problem, graph = _followed(problem, asked, closed_at)
    layout = Layout(problem.mechanism, graph)
    wanted = _computed(problem, asked)
    if problem.hold_idle and demand_of(problem.mechanism, wanted) & Demand.FORCES:
        held = {known[f"{leg.body}.holding_moment"] for leg in find_legs(problem.mechanism)}
        wanted += sorted(held.difference(wanted))
    inputs = kernel_inputs(problem, layout)
    probe = Probe(problem, layout)
    start = choose_start(problem, layout, layout.build(), inputs.values, probe)
    size = None if start.state is None else probe.size(inputs.values[:, start.row], start.state)
    return Setup(
        problem=problem,
        asked=tuple(asked),
        wanted=tuple(wanted),
        demand=_demand(problem, graph, wanted, verdicts),
        layout=layout,
        inputs=inputs,
        start=start,
        outputs=_planned(problem, layout, wanted, size),
        lanes=lanes,
    )


def _followed(
    problem: Problem, wanted: list[Wanted], closed_at: list[str] | None
) -> tuple[Problem, SolverGraph]:
    """The part of the problem that its `follow:` leaves, and the solver graph of that part."""
    graph = build_graph(problem.mechanism, problem.motion.driven, closed_at)
    if problem.follow is None:
        return problem, graph
    from mechkin_cli.analysis.followed import followed_part

    part = followed_part(problem, graph, wanted)
    if part is problem:
        return problem, graph
    return part, build_graph(part.mechanism, part.motion.driven, closed_at)


def _computed(problem: Problem, asked: list[Wanted]) -> list[Wanted]:
    """What the kernel computes for the quantities asked for."""
    derived = [quantity for quantity in asked if quantity.kind in DERIVED_KINDS]
    if not derived:
        return list(asked)
    from mechkin_cli.analysis.derived import basis_of

    plain = [quantity for quantity in asked if quantity.kind not in DERIVED_KINDS]
    return plain + basis_of(problem.mechanism, derived)


def _demand(problem: Problem, graph: SolverGraph, wanted: list[Wanted], verdicts: bool) -> Demand:
    demand = demand_of(problem.mechanism, wanted)
    if verdicts and graph.blocks:
        demand |= Demand.CONDITION
    if verdicts and demand & Demand.FORCES and demand & Demand.VELOCITY:
        demand |= Demand.POWER
    return demand


def _planned(
    problem: Problem, layout: Layout, wanted: Iterable[Wanted], size: float | None = None
) -> OutputPlan:
    """The kernel's plan with outputs for some quantities; `size` as in `Layout.build`."""
    outputs = OutputPlan(layout, layout.build(size), problem.motion.driven)
    for quantity in wanted:
        outputs.add(quantity)
    return outputs
