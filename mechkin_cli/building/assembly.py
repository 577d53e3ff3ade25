"""`assembly:` and `follow:` - the assembly of the first row, and the loops that are followed; and
the idle freedoms of a built problem.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mechkin_cli import idle, mobility
from mechkin_cli.building.fields import Fields, Path, dimension_of, is_coordinate
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.mechanism import Assembly, Joint, Problem
from mechkin_cli.schema import AssemblySection

if TYPE_CHECKING:
    from mechkin_cli.mechanism import LockedFreedom


def build_assembly(
    fields: Fields, section: AssemblySection | None, joints: Mapping[str, Joint]
) -> Assembly:
    """The assembly that the section chooses, with its coordinates in SI."""
    if section is None:
        return Assembly()
    near = near_values(fields, ("assembly", "near"), section.near, joints)
    straight = section.at_branch_points is not None
    return Assembly(near, section.mode, section.turns, straight)


def near_values(
    fields: Fields, path: Path, texts: Mapping[str, str], joints: Mapping[str, Joint]
) -> dict[str, float]:
    """The coordinates (rad, m) of the section `near` at `path`."""
    near = {}
    for name, text in texts.items():
        place = (*path, name)
        if is_coordinate(fields, place, name, joints):
            near[name] = fields.number(place, text, dimension_of(name.rpartition(".")[2]))
    return near


def build_follow(
    fields: Fields, names: tuple[str, ...] | None, joints: Mapping[str, Joint]
) -> tuple[str, ...] | None:
    """The joints that `follow:` lists, each of which must exist; None without it."""
    for i, name in enumerate(names or ()):
        if name not in joints and not fields.is_refused(name):
            hint = nearest_hint(name, list(joints))
            fields.error("unknown-joint", ("follow", i), f"there is no joint {name}", hint)
    return names


def held_of(problem: Problem) -> tuple[LockedFreedom, ...]:
    """The locks of the idle freedoms."""
    held, as_drawn = idle.held_freedoms(problem.mechanism, problem.motion.driven)
    return mobility.held_along(problem, held) if as_drawn else held


def note_spins(fields: Fields, problem: Problem, *, free: bool = False) -> None:
    """Notes causes that would drive the idle freedoms: kinematics alone does not determine how they
    move, nor does a `free` motion whose start does not name them."""
    if not problem.has_idle:
        return
    for link, diagnostic in idle.spin_errors(problem, free=free):
        placed = diagnostic._replace(place=fields.document.place(("links", link)))
        if placed not in fields.diagnostics:
            fields.diagnostics.append(placed)


def settled(problem: Problem) -> Problem:
    """The problem without the moments of inertia that nothing turns."""
    return idle.without_spin(problem) if problem.held else problem
