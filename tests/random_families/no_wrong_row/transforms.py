"""The same mechanism written in another way: whatever is asked of it must not change."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import replace

from random_families.no_wrong_row.drawing import Drawing

TWIN = "_2nd"
EXTRA_LINKS = ("extra_rod", "extra_rocker")
EXTRA_JOINTS = (
    "E1: {type: S, links: [link_A, extra_rod], point: [0.31, 0.12, 0.05]}",
    "E2: {type: S, links: [extra_rod, extra_rocker], point: [9.1, 4.2, 1.5]}",
    "E3: {type: R, links: [ground, extra_rocker], point: [9.3, -3.6, 0.7], axis: [0.2, 0.3, 1]}",
)
"""An RSSR loop whose crank is short against all else, so that it turns far from dead centres."""


def renamed_by(names: dict[str, str]) -> Callable[[str], str]:
    """Exchanges whole names in a text."""
    return lambda text: re.sub(r"[A-Za-z_]\w*", lambda m: names.get(m[0], m[0]), text)


def double(drawing: Drawing) -> None:
    """Draws all but the ground and the first crank once more; twins have the same columns."""
    names = {link: link + TWIN for link in drawing.links if link != "link_A"}
    names |= {own: own + TWIN for own in map(key_of, [*drawing.joints, *drawing.marks])}
    del names["A"]
    renamed = renamed_by(names)
    drawing.links += [names[link] for link in drawing.links if link != "link_A"]
    drawing.joints += [renamed(joint) for joint in drawing.joints if key_of(joint) != "A"]
    drawing.marks += [renamed(mark) for mark in drawing.marks]
    drawing.inputs.update({renamed(n): renamed(v) for n, v in drawing.inputs.items()})
    twins = [replace(c, name=renamed(c.name)) for c in drawing.columns if c.name != "A.theta"]
    drawing.columns += twins
    drawing.families.append("doubled")


def key_of(entry: str) -> str:
    return entry.split(":")[0]


def reordered(drawing: Drawing) -> None:
    """Other orders of links and joints, and other names of links."""
    rng = random.Random(len(drawing.joints))
    letters = rng.sample("abcdefghijklmnopqrstuvwxyz", 26)
    names = {
        link: f"{letters[k % 26]}{link}" for k, link in enumerate(drawing.links) if link != "link_A"
    }
    renamed = renamed_by(names)
    drawing.links = rng.sample([renamed(link) for link in drawing.links], len(drawing.links))
    drawing.joints = rng.sample([renamed(joint) for joint in drawing.joints], len(drawing.joints))
    drawing.marks = [renamed(mark) for mark in drawing.marks]
    drawing.heavy = {renamed(link) for link in drawing.heavy}


def with_extra_loop(drawing: Drawing) -> None:
    """A loop that nothing needs."""
    drawing.links += EXTRA_LINKS
    drawing.joints += EXTRA_JOINTS


def split(drawing: Drawing) -> None:
    """Bodies on C or U as two links on P and R, or R and R: a block of two becomes two blocks."""
    for group in drawing.merged:
        if len(group) != 2:
            continue
        carrier, name = group
        joint = next(j for j in drawing.joints if key_of(j) == name)
        found = re.search(r"point: (\[.*?\]), axis: (\[.*?\])(?:, axis2: (\[.*?\]))?", joint)
        assert found
        point, one, two = found.groups()
        first, last = f"link_{carrier}", f"link_{name}"
        kind, old, new = ("P", "s", "theta") if two is None else ("R", "theta1", "theta2")
        drawing.links.append(first)
        drawing.joints.remove(joint)
        held = f"links: [ground, {first}], point: {point}, axis: {one}"
        turned = f"links: [{first}, {last}], point: {point}, axis: {two or one}"
        drawing.joints += [f"{carrier}: {{type: {kind}, {held}}}", f"{name}: {{type: R, {turned}}}"]
        # the leg that places the carrier ends on the second axis
        leg = f"rod_{name}a, {last}]"
        drawing.joints = [j.replace(leg, f"rod_{name}a, {first}]") for j in drawing.joints]
        coordinate = "s" if two is None else "theta"
        names = {f"{name}.{old}": f"{carrier}.{coordinate}", f"{name}.{new}": f"{name}.theta"}
        drawing.columns = [replace(c, name=names.get(c.name, c.name)) for c in drawing.columns]


WRITINGS = {f.__name__: f for f in (double, reordered, with_extra_loop, split)}
