"""The same mechanism written in another way: whatever is asked of it must not change."""

from __future__ import annotations

import re
from dataclasses import replace

from random_families.no_wrong_row.drawing import Drawing

TWIN = "_2nd"


def double(drawing: Drawing) -> None:
    """Draws all but the ground and the first crank once more; twins have the same columns."""
    links = {link: link + TWIN for link in drawing.links if link != "link_A"}
    joints = {j.split(":")[0]: j.split(":")[0] + TWIN for j in drawing.joints}
    marks = {mark.split(":")[0]: mark.split(":")[0] + TWIN for mark in drawing.marks}
    del joints["A"]
    names = links | joints | marks

    def renamed(text: str) -> str:
        return re.sub(r"[A-Za-z_]\w*", lambda m: names.get(m[0], m[0]), text)

    drawing.links += links.values()
    drawing.joints += [renamed(j) for j in drawing.joints if not j.startswith("A:")]
    drawing.marks += [renamed(mark) for mark in drawing.marks]
    drawing.inputs.update({renamed(n): renamed(v) for n, v in drawing.inputs.items()})
    drawing.columns += [
        replace(c, name=renamed(c.name)) for c in drawing.columns if c.name != "A.theta"
    ]
    drawing.families.append("doubled")
