"""Which assembly the first row has, and which loops are followed, as the file says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mechkin_cli.building.fields import Fields, Path, dimension_of, is_coordinate
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.idle import held_freedoms
from mechkin_cli.mechanism import Assembly, Joint, Problem
from mechkin_cli.schema import AssemblySection

if TYPE_CHECKING:
    from mechkin_cli.mechanism import LockedFreedom


def build_assembly(
    fields: Fields, section: AssemblySection | None, joints: Mapping[str, Joint]
) -> Assembly:
    """The assembly that the section means, with its coordinates in SI."""
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
    """The joints that `follow:` lists, each of which must be there; None without it."""
    for i, name in enumerate(names or ()):
        if name not in joints and not fields.is_refused(name):
            hint = nearest_hint(name, list(joints))
            fields.error("unknown-joint", ("follow", i), f"there is no joint {name}", hint)
    return names


def held_of(problem: Problem) -> tuple[LockedFreedom, ...]:
    """What holds the idle freedoms."""
    held, as_drawn = held_freedoms(problem.mechanism, problem.motion.driven)
    if not as_drawn:
        return held
    from mechkin_cli.mobility import held_along

    return held_along(problem, held)


def note_spins(fields: Fields, problem: Problem, *, free: bool = False) -> None:
    """Notes what would drive the idle freedoms: kinematics alone does not know how they move, and a
    `free` motion where its start does not name them."""
    if not problem.has_idle:
        return
    from mechkin_cli.idle import spin_errors

    for link, diagnostic in spin_errors(problem, free=free):
        found = diagnostic._replace(place=fields.document.place(("links", link)))
        if found not in fields.diagnostics:
            fields.diagnostics.append(found)


def settled(problem: Problem) -> Problem:
    """The problem without the moments of inertia that nothing turns."""
    if not problem.held:
        return problem
    from mechkin_cli.idle import without_spin

    return without_spin(problem)
