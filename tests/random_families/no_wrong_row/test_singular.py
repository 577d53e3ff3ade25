"""The triangle of derivatives against differences of all conditions by all coordinates."""

from __future__ import annotations

import numpy as np
from random_families.no_wrong_row.branch import TURN, Undecided, way
from random_families.no_wrong_row.case import drawn
from random_families.no_wrong_row.field import FAST
from random_families.no_wrong_row.node import Node
from random_families.no_wrong_row.singular import least_of_block


def test_the_least_singular_value_is_that_of_all_differences() -> None:
    seen = 0
    for number in range(30):
        case = drawn(number, 1 + number % 2)
        linkage = case.drawing.linkage()
        bodies = {body.name: body for body in linkage.bodies}
        for group in case.drawing.merged:
            if isinstance(bodies[group[0]], Node):
                continue
            try:
                one = way(linkage, 1, TURN)
            except Undecided:
                continue
            here = len(one.t) // 3
            t = one.t[here : here + 1]
            value = {name: linkage.at(t, FAST).value[name] for name in group}
            scale = [linkage.size if bodies[name].slides else 1.0 for name in group]
            sides = []
            for sign in (1, -1):
                for name, unit in zip(group, scale, strict=True):
                    held = value | {name: value[name] + sign * 1e-5 * unit}
                    placed = linkage.at(t, FAST, held=held)
                    sides.append([float(placed.miss[i](held[i])[0]) for i in group])
            up, down = np.array(sides[: len(group)]), np.array(sides[len(group) :])
            singular = np.linalg.svd((up - down) / 2e-5, compute_uv=False)
            found = float(least_of_block(linkage, group, one)[here])
            assert abs(found - singular[-1]) < 1e-4 + 0.02 * found
            seen += 1
    assert seen > 8
