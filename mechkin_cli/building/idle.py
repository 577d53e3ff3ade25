"""Idle freedoms of a built problem: what holds them, and what must not drive them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.mechanism.holding import held_freedoms
from mechkin_cli.mechanism.legs import find_legs

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields
    from mechkin_cli.mechanism.held import Held
    from mechkin_cli.mechanism.problem import Problem


def held_of(problem: Problem) -> tuple[Held, ...]:
    """What holds the idle freedoms."""
    held, as_drawn = held_freedoms(problem.mechanism, problem.motion.driven)
    if not as_drawn:
        return held
    from mechkin_cli.freedoms.held_along import held_along

    return held_along(problem, held)


def note_spins(fields: Fields, problem: Problem, *, free: bool = False) -> None:
    """Notes what would drive the idle freedoms: kinematics alone does not know how they move, and a
    `free` motion where its start does not name them."""
    if not (find_legs(problem.mechanism) or problem.held):
        return
    from mechkin_cli.mechanism.spins import spin_errors

    for link, diagnostic in spin_errors(problem, free=free):
        found = diagnostic._replace(place=fields.document.place(("links", link)))
        if found not in fields.diagnostics:
            fields.diagnostics.append(found)


def settled(problem: Problem) -> Problem:
    """The problem without the moments of inertia that nothing turns."""
    if not problem.held:
        return problem
    from mechkin_cli.mechanism.idle import without_spin

    return without_spin(problem)
