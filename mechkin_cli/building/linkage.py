"""Links and what joins them: the joints of `joints:` and `chain:`, and that they reach ground."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from mechkin_cli.building.fields import Fields
from mechkin_cli.building.joints import build_joints
from mechkin_cli.building.links import build_links
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Link
from mechkin_cli.schema.file import MechanismFile


def build_linkage(fields: Fields, file: MechanismFile) -> tuple[dict[str, Link], dict[str, Joint]]:
    """Links and joints by name; a link that only `chain:` names has no mass."""
    links = build_links(fields, file.links, "unphysical-inertia" in file.accept)
    pairs = _chain_pairs(file)
    links |= {name: Link(name) for _, name in pairs if name != GROUND_NAME and name not in links}
    return links, _joints(fields, file, links, pairs)


def _joints(
    fields: Fields,
    file: MechanismFile,
    links: Mapping[str, Link],
    chain_pairs: Sequence[tuple[str, str]],
) -> dict[str, Joint]:
    """The joints of `joints:` and of `chain:`; every link must be joined to ground by them."""
    joints = build_joints(fields, file.joints, links)
    if chain_pairs:
        from mechkin_cli.building.chain import build_chain

        joints |= build_chain(fields, file.chain, chain_pairs)
    pairs = [(joint.links[0], joint.links[1]) for joint in file.joints.values()]
    _check_connected(fields, links, [*pairs, *chain_pairs])
    return joints


def _chain_pairs(file: MechanismFile) -> list[tuple[str, str]]:
    """The two links of every joint of the chain: each row's joint lies behind the link before."""
    return list(pairwise([GROUND_NAME, *(row.link for row in file.chain)]))


def _check_connected(
    fields: Fields, links: Mapping[str, object], pairs: Sequence[tuple[str, str]]
) -> None:
    """Every link must be joined, by way of others, to ground."""
    if any(name not in links and name != GROUND_NAME for pair in pairs for name in pair):
        return  # a misspelt link, reported at its joint
    joined: dict[str, list[str]] = {}
    for first, second in pairs:
        joined.setdefault(first, []).append(second)
        joined.setdefault(second, []).append(first)
    reached, front = {GROUND_NAME}, [GROUND_NAME]
    for link in front:
        more = [other for other in joined.get(link, ()) if other not in reached]
        reached.update(more)
        front += more
    for name in links:
        if name not in reached:
            fields.key_error(
                "disconnected-link",
                ("links", name),
                f"link {name} is not joined to ground, nor to a link that is",
                "add a joint, or remove the link",
            )
