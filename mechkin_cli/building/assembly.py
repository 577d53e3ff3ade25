"""`assembly:` and `follow:`: which assembly is meant, and which loops are followed."""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.building.coordinates import dimension_of, is_coordinate
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.motion import Assembly
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.schema.assembly import AssemblySection


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
