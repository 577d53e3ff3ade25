"""What is right: the rows of a scene repeated in double-double from the text of its file.

About 32 digits, of which as many are kept as numpy's widest numbers have. The closure of `truth`,
of another formula and without the kernel, stands beside it: the tests hold one against the other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.benchmark.truth import true_values, width
from mechkin_cli.errors import NotRepeated, wide_run
from mechkin_cli.plan import demand_of

if TYPE_CHECKING:
    from mechkin_cli.benchmark.scene import Scene, Values


TEXT = "double-double, from the numbers of the file's text"


def exact_values(scene: Scene) -> tuple[Values, str]:
    """Everything that is asked of a scene, at its places (width, places), and what it is by.

    Where the text cannot be followed in double-double, positions and motion are those of the
    closure.
    """
    wanted = scene.wanted(scene.asked.level("everything"))
    try:
        wide = wide_run(scene.result)
    except NotRepeated as reason:
        said = f"the closure of another formula, {width()}, as the text is not followed ({reason})"
        return true_values(scene), said
    demand = demand_of(scene.problem.mechanism, wanted)
    found = wide.run(wanted, scene.session, wide.inputs, demand)
    values: dict[str, Any] = {
        name: np.asarray(parts.high, np.longdouble)[:, scene.places]
        + np.asarray(parts.low, np.longdouble)[:, scene.places]
        for name, parts in found.items()
    }
    return values, TEXT
