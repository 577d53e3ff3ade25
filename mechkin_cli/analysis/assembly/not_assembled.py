"""What to say where a mechanism cannot be assembled: which loop does not close."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic, Number

if TYPE_CHECKING:
    from mechkin_cli.solver.search import Found
    from mechkin_cli.solver.session import Session

LOOP_SHOWN = 12
"""Joints of a loop that are named one by one."""


def nothing_found(session: Session, found: Found, place: str = "at the first row") -> Diagnostic:
    """What to say where no start closed: which loop it is."""
    loop, name = _failed_loop(session, found), session.problem.mechanism.name
    hint = "check the dimensions, or start the sweep at another input"
    if any(joint.type.is_threaded for joint in session.problem.mechanism.joints.values()):
        turns = session.problem.assembly.turns
        hint += f"; threads were searched {turns}.5 turns to either side: assembly: {{turns: N}}"
    if session.is_redundant:
        hint = "dimensions of an overconstrained loop must be exact (write expressions)"
    return Diagnostic(
        "not-assembled",
        "error",
        f"{name} cannot be assembled {place}{loop}",
        measured=_missed(found),
        limit=None if found.complete else f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint=hint,
        numbers=(
            Number("starts", found.tried),
            Number("residual", found.closest, limit=tolerances.RESIDUAL_ACCEPT),
        ),
    )


def _missed(found: Found) -> str:
    if found.free:
        return (
            f"{found.free} of {found.starts} random starts closed the loops, all where they still "
            "move with the inputs held, or in a singular position"
        )
    if found.complete:
        return "its equations have no real root"
    return (
        f"none of {found.tried} random starts closed, the best to {found.closest:.2g} of the size"
    )


def _failed_loop(session: Session, found: Found) -> str:
    """The joints of the loops that did not close, and whether others were closed before."""
    if found.failed is None or found.free:
        return ""
    graph = session.graph
    names: dict[str, None] = {}
    closings = graph.blocks[found.failed].closings
    for closing in (graph.closings[c] for c in closings):
        joints = (closing.joint.name,) if closing.leg is None else closing.leg.joints
        ways = {sign: [e for e, s in closing.loop if e >= 0 and s == sign] for sign in (1, -1)}
        # outward to the closing joint's first link, and back
        there, back = ([graph.edges[e].joint.name for e in sorted(ways[s])] for s in (-1, 1))
        names.update(dict.fromkeys((*there, *joints, *reversed(back))))
    shown = [name for name in names if name in session.problem.mechanism.joints]
    more = f" and {len(shown) - LOOP_SHOWN} more" if len(shown) > LOOP_SHOWN else ""
    loops = "the loop" if len(closings) == 1 else f"the {len(closings)} loops"
    close = "does not close" if len(closings) == 1 else "do not close together"
    before = f", in none of {found.places} assemblies before it" if found.places > 1 else ""
    return f": {loops} through {', '.join(shown[:LOOP_SHOWN])}{more} {close}{before}"
