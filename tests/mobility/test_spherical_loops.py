"""Loops through one point in space, drawn by whole numbers: they have as many freedoms as angles,
less the rank of the axes, wherever their redundant constraints hide it.

`MECHKIN_RANDOM` multiplies the number of loops.
"""

from __future__ import annotations

import os
import random

import mpmath as mp
import pytest

import mechkin_cli as mk

LOOPS = 20 * int(os.environ.get("MECHKIN_RANDOM", "1"))


def axis(dice: random.Random) -> list[int]:
    while True:
        found = [dice.randint(-3, 3) for _ in range(3)]
        if any(found):
            return found


def square_to(one: list[int], dice: random.Random) -> list[int]:
    while True:
        a, b = one, axis(dice)
        found = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        if any(found):
            return found


def spherical_loop(seed: int) -> tuple[str, int]:
    """A file, and how many freedoms it has."""
    dice = random.Random(seed)
    count = dice.randint(3, 5)
    names = ["ground", *(f"L{k}" for k in range(1, count + 1)), "ground"]
    axes, joints = [], []
    for k in range(count + 1):
        own = axis(dice)
        text = f"links: [{names[k]}, {names[k + 1]}], point: [0, 0, 0], axis: {own}"
        axes.append(own)
        if dice.random() < 0.4:
            other = square_to(own, dice)
            axes.append(other)
            joints.append(f"  J{k}: {{type: U, {text}, axis2: {other}}}")
        else:
            joints.append(f"  J{k}: {{type: R, {text}}}")
    links = ", ".join(f"{name}: {{}}" for name in names[1:-1])
    text = f"format: 1\nunits: {{length: mm}}\nlinks: {{{links}}}\njoints:\n" + "\n".join(joints)
    return text + "\n", len(axes) - rank(axes)


def rank(rows: list[list[int]]) -> int:
    """Of whole numbers, by minors."""
    if any(mp.det(mp.matrix([a, b, c])) != 0 for a in rows for b in rows for c in rows):
        return 3
    return 2 if any(square(a, b) for a in rows for b in rows) else 1


def square(a: list[int], b: list[int]) -> bool:
    return any(a[i] * b[j] != a[j] * b[i] for i in range(3) for j in range(3))


@pytest.mark.parametrize("seed", [61, *range(LOOPS)])
def test_spherical_loops_have_their_freedoms(seed: int) -> None:
    text, freedoms = spherical_loop(seed)
    assert mk.loads(text).mobility().mobility == freedoms


SMALLEST = """format: 1
units: {length: mm}
links: {L1: {}, L2: {}, L3: {}}
joints:
  J0: {type: R, links: [ground, L1], point: [0, 0, 0], axis: [1, -2, 3]}
  J1: {type: U, links: [L1, L2], point: [0, 0, 0], axis: [-1, -1, 3], axis2: [9, 6, 5]}
  J2: {type: U, links: [L2, L3], point: [0, 0, 0], axis: [-1, -3, 0], axis2: [6, -2, 1]}
  J3: {type: R, links: [L3, ground], point: [0, 0, 0], axis: [-1, 2, -3]}
"""


def test_inputs_that_are_too_few_to_place_all_links() -> None:
    """They are found where nothing is driven, too, to tell what is free."""
    assert mk.loads(SMALLEST).mobility().mobility == 3
    driven = mk.loads(SMALLEST + "motion: {inputs: {J0.theta: {from: 0, to: 10, count: 3}}}\n")
    assert {note.code for note in driven.mobility().diagnostics} == {"undriven-freedom"}
    rows = driven.analyze(["J0.theta"])
    assert not rows.complete
    assert any(note.code == "undriven-freedom" for note in rows.diagnostics)


HUNG = """format: 1
units: {length: mm}
links: {L1: {}, L2: {}, L3: {}, L4: {}, L5: {}, L6: {}, L7: {}, L8: {}}
joints:
  J0: {type: R, links: [ground, L1], point: [-6.69, 7.04, 25.86], axis: [2.0047, -3.1859, 2.198]}
  J1: {type: R, links: [L1, L2], point: [-6.69, 7.04, 25.86], axis: [1.2776, 1.5319, 0.1452]}
  J2: {type: R, links: [L2, L3], point: [-6.69, 7.04, 25.86], axis: [1.2776, 1.5319, 0.1452]}
  J3: {type: R, links: [L3, ground], point: [-6.69, 7.04, 25.86], axis: [-1.673, -1.4995, 2.9921]}
  J4: {type: E, links: [L1, L4], point: [17.03, 12.12, 11.58],
       normal: [-1.7623520507855748, 1.6132989997847635, -1.5137310152022923],
       x: [1.2765, -0.8391, -2.3804]}
  J5: {type: P, links: [L4, L5], point: [-21.0, 7.83, 19.58],
       axis: [0.6399053709395477, 3.1368651272534067, 2.598191349701595]}
  J6: {type: E, links: [L5, ground], point: [4.82, 26.76, 33.48],
       normal: [-1.9164, -2.2978, -0.2178], x: [2.2792, -1.8393, -0.65]}
  J7: {type: R, links: [L5, L6], point: [-14.06, -21.61, 21.08],
       axis: [-2.4332279399166508, -2.071829598587656, 1.9460020315572875]}
  J8: {type: R, links: [L6, L7], point: [10.81, -23.09, -30.59], axis: [-2.4332, -2.0718, 1.946]}
  J9: {type: R, links: [L7, L8], point: [-18.76, -2.86, 16.15],
       axis: [-2.4332279399166508, -2.071829598587656, 1.9460020315572875]}
  J10: {type: R, links: [L8, L5], point: [-10.93, 29.23, 8.2], axis: [-2.4332, -2.0718, 1.946]}
"""


def test_a_loop_on_a_link_that_a_later_loop_places() -> None:
    """By ranks L5 is placed before the loop that its joint to ground is solved in. The screws of
    the fifteen freedoms have twelve singular values from 2.3 to 3e-6, then rounding."""
    model = mk.loads(HUNG)
    assert model.mobility().mobility == 3
    placed = {link for block in model.graph.blocks for link in block.unknowns}
    assert len(placed) == sum(len(block.unknowns) for block in model.graph.blocks)
