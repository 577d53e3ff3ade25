"""`--explain`: the solver graph, what is computed and what is skipped, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.kernel.functions import INSTRUCTIONS, width, widths
from mechkin_cli.mechanism import COEFFICIENT_KINDS, DERIVED_KINDS, POWER_KINDS, accelerated
from mechkin_cli.plan import WRENCH_KINDS, Demand
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.mechanism import Joint, Wanted
    from mechkin_cli.structure import Block, SolverGraph


def explanation(analysis: Analysis) -> str:
    """Tree, closing joints, blocks and the demand plan."""
    graph = analysis.result.graph
    of = analysis.model.name if analysis.run == SWEEP else f"the start of {analysis.run}"
    lines = [f"solver graph of {of}", "  tree"]
    for edge in graph.edges:
        way = "" if edge.forward else ", passed from its second link to its first"
        way = ", hung between its spheres" if edge.hung else way
        lines.append(f"    {edge.parent} -> {edge.child} by {_joint(edge.joint, way)}")
    lines.append("  loops closed at" if graph.closings else "  no loops")
    for closing in graph.closings:
        loop = ", ".join(graph.edges[k].joint.name for k, _ in closing.loop)
        count = closing.equations
        equations = f", {count} equation{'s' * (count > 1)}"
        if closing.constraint.words:
            equations += f": {closing.constraint.words}"
        lines.append(f"    {_joint(closing.joint, equations)}" + f" with {loop}" * bool(loop))
    if graph.blocks:
        lines.append("  blocks, solved in this order")
    for number, block in enumerate(graph.blocks, 1):
        unknowns = f"{len(block.unknowns)} unknowns {_unknowns(graph, block)}"
        more = block.equations > len(block.unknowns)
        lines.append(f"    {number}: {unknowns}" + f" from {block.equations} equations" * more)
    lines.append("demand plan")
    lines += [f"  {line}" for line in _demand_lines(analysis)]
    return "\n".join(lines) + "\n"


def _unknowns(graph: SolverGraph, block: Block) -> str:
    return ", ".join(_freedom(graph.edges[k].joint, freedom) for k, freedom in block.unknowns)


def _freedom(joint: Joint, freedom: int) -> str:
    """A coordinate's name; turns of a sphere have none of their own."""
    names = {number: name for name, number in reversed(joint.type.freedom_of.items())}
    if freedom in names:
        return f"{joint.name}.{names[freedom]}"
    turns = [f for f, slide in enumerate(joint.type.slides) if not slide]
    return f"{joint.name} (turn {turns.index(freedom) + 1} of {len(turns)})"


def _joint(joint: Joint, words: str) -> str:
    kind = "six unknowns" if joint.type.is_free else joint.letter
    return f"{joint.name} ({kind}{words})"


def _demand_lines(analysis: Analysis) -> list[str]:
    result = analysis.result
    problem = analysis.model.problem if analysis.run == SWEEP else result.problem
    demand, mechanism = result.demand, problem.mechanism
    massless = not any(link.has_mass for link in mechanism.links.values())
    forces = bool(demand & Demand.FORCES)
    known = problem.quantities()
    asked = [known[name] for name in result.columns if name in known]
    reactions = any(quantity.kind in WRENCH_KINDS for quantity in asked)
    lines = [
        f"first assembly: {result.how or 'none found'}",
        _positions(analysis),
        _line("velocities", bool(demand & Demand.VELOCITY), "no column reads a rate"),
        _line("accelerations", bool(demand & Demand.ACCELERATION), _without(forces, massless)),
        _line("input efforts and closing wrenches", forces, "no column reads a force"),
        _line("joint wrenches", reactions, "no column reads a reaction"),
        _line("condition of each row", bool(demand & Demand.CONDITION), "not asked for"),
        _line(
            "power balance of each row",
            bool(demand & Demand.POWER),
            "no rates are computed" if forces else "no column reads a force",
        ),
    ]
    if forces and problem.load_laws:
        from mechkin_cli.mechanism import quantities_read

        read = ", ".join(quantities_read(problem))
        lines.append(f"loads that vary: evaluated with the forces, from {read}")
    lines += _derived_lines(asked)
    if forces and massless:
        lines.append("inertia: skipped, no link has mass")
    return [*lines, _width_line()]


def _positions(analysis: Analysis) -> str:
    result = analysis.result
    if analysis.run == SWEEP:
        nodes = f"{result.nodes} nodes followed, the rest filled in between"
        return f"positions: {result.rows} rows, {nodes}"
    response = analysis.model.design.response(analysis.run)
    step = f"a tolerance of {response.tolerance:g}"
    if response.fixed_step is not None:
        step = f"steps of {response.fixed_step:g} s"
    return f"motion: {result.rows} rows, integrated in {result.nodes} steps with {step}"


def _width_line() -> str:
    known = ", ".join(f"{lanes} ({INSTRUCTIONS[lanes]})" for lanes in widths())
    return f"width: {width()} rows at a time; this machine has {known}"


def _derived_lines(asked: list[Wanted]) -> list[str]:
    lines = []
    plain = DERIVED_KINDS - POWER_KINDS - COEFFICIENT_KINDS
    simple = [quantity.name for quantity in asked if quantity.kind in plain]
    if simple:
        lines.append(f"derived from positions and rates: {', '.join(simple)}")
    if any(quantity.kind == "mechanical_advantage" for quantity in asked):
        lines.append("mechanical advantages: one more run, with unit rate of one input")
    linear = {accelerated(quantity) for quantity in asked if quantity.kind in COEFFICIENT_KINDS}
    if linear:
        lines.append(f"coefficients of accelerations: one more run for each input, {len(linear)}")
    angles = sum(quantity.kind == "transmission_angle" for quantity in asked)
    if angles:
        lines.append(f"transmission angles: static runs with a unit load, {angles} in all")
    return lines


def _without(forces: bool, massless: bool) -> str:
    if forces and massless:
        return "no link has mass and no column reads an acceleration"
    return "no column reads an acceleration or a force"


def _line(what: str, computed: bool, why_not: str) -> str:
    return f"{what}: computed" if computed else f"{what}: skipped, {why_not}"
