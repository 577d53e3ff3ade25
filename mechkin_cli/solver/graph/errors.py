"""Why a mechanism has no solver graph, each as an error that names the joints concerned."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.solver.graph.assur import Undriven
from mechkin_cli.solver.graph.network import Connection
from mechkin_cli.solver.graph.records import UnsolvableGraph

MOST_NAMES = 20
"""Names in a message."""


def listed(names: Sequence[str]) -> str:
    """Names with commas, the first of them where they are many."""
    if len(names) <= MOST_NAMES:
        return ", ".join(names)
    return f"{', '.join(names[:MOST_NAMES])}, ... ({len(names)} in all)"


def no_closing_joint(name: str, joints: Sequence[str]) -> UnsolvableGraph:
    """A loop has no joint that may close it."""
    diagnostic = Diagnostic(
        "no-closing-joint",
        "error",
        f"the loops of {name} cannot be closed: every loop needs a joint "
        "other than H that is not an input and has no spring on its angle",
        hint="drive another coordinate, or put the spring on another joint",
    )
    return UnsolvableGraph(diagnostic, tuple(joints))


def input_closes(name: str) -> UnsolvableGraph:
    """A loop shall be closed at an input."""
    diagnostic = Diagnostic(
        "input-closes",
        "error",
        f"{name} is driven, so no loop can be closed there",
        hint="choose another closing joint",
    )
    return UnsolvableGraph(diagnostic, (name,))


def disconnected(links: Sequence[str]) -> UnsolvableGraph:
    """Links that nothing joins to ground."""
    diagnostic = Diagnostic(
        "disconnected-link",
        "error",
        f"not joined to ground, nor to a link that is: {listed(links)}",
        hint="add a joint, or remove the link",
    )
    return UnsolvableGraph(diagnostic)


def driven_solid(connections: Iterable[Connection], equations: int) -> UnsolvableGraph:
    """A loop all of whose freedoms are driven."""
    joints = sorted({name for c in connections for name in _joints(c)})
    diagnostic = Diagnostic(
        "driven-solid",
        "error",
        f"nothing is left to close the loop through {listed(joints)}: "
        "all its other freedoms are driven",
        measured=f"{equations} equations, no unknowns",
        hint="drive fewer coordinates",
    )
    return UnsolvableGraph(diagnostic, tuple(joints))


def undriven(
    mechanism: Mechanism, inputs: Sequence[tuple[str, str]], parts: Sequence[Undriven]
) -> UnsolvableGraph:
    """Freedoms that neither an input nor a loop determines."""
    concerned = {name for part in parts for c in part.connections for name in _joints(c)}
    joints = [joint for name, joint in mechanism.joints.items() if name in concerned]
    taken = set(inputs)
    names = [
        f"{joint.name}.{coordinate}"
        for joint in joints
        for coordinate, freedom in joint.type.freedom_of.items()
        if not any(
            (joint.name, c) in taken for c, f in joint.type.freedom_of.items() if f == freedom
        )
    ]
    names = names or [joint.name for joint in joints]
    missing = sum(part.missing for part in parts)
    count = "one free coordinate is" if missing == 1 else f"{missing} free coordinates are"
    diagnostic = Diagnostic(
        "undriven-freedom",
        "error",
        f"{count} not driven; candidates: {listed(names)}",
        measured=f"{missing} more unknown{'s' * (missing > 1)} than closing equations",
        hint="add inputs under motion",
    )
    around = tuple(joint.name for joint in joints)
    return UnsolvableGraph(diagnostic, around, missing, tuple(names))


def _joints(c: Connection) -> tuple[str, ...]:
    return (c.name,) if c.leg is None else c.leg.joints
