"""Links made of welded pieces, in rows, stars and rings: they move as the whole links do."""

from __future__ import annotations

import itertools
import os
import random
from typing import Any

import numpy as np
import pytest
import yaml
from mobility.overconstrained import coaxial_hinge, double_spherical, general, planar

import mechkin_cli as mk

SEEDS = range(int(os.environ.get("MECHKIN_RANDOM", "5")))
TEXTS = {
    "planar": planar(),
    "RSSR": double_spherical(),
    "collar": coaxial_hinge(),
    "RCSR": general("RCSR"),
}
WELD = {"type": "W"}
HINGE = {"type": "R", "links": ["ground", "a"], "point": [0, 0, 0], "axis": [0, 0, 1]}
BALL = {"type": "S", "links": ["ground", "a"], "point": [0, 0, 0]}
Document = dict[str, Any]


def in_pieces(document: Document, draw: random.Random, rings: int) -> Document:
    """Every link as one to four pieces, each welded to one before; its joints go to any of them.
    `rings` welds more join pieces that are joined already."""
    pieces = {
        link: [link, *(f"{link}_{k}" for k in range(draw.randint(0, 3)))]
        for link in ["ground", *document["links"]]
    }
    joints = {
        name: joint | {"links": [draw.choice(pieces[link]) for link in joint["links"]]}
        for name, joint in document["joints"].items()
    }
    pairs = [
        (draw.choice(all_[:k]), all_[k]) for all_ in pieces.values() for k in range(1, len(all_))
    ]
    large = [all_ for all_ in pieces.values() if len(all_) > 2]
    pairs += [tuple(draw.sample(draw.choice(large), 2)) for _ in range(rings if large else 0)]
    joints |= {f"W{k}": WELD | {"links": list(pair)} for k, pair in enumerate(pairs)}
    links = {piece: {} for all_ in pieces.values() for piece in all_ if piece != "ground"}
    return document | {"links": links, "joints": joints}


def mobility(document: Document) -> mk.Mobility:
    return mk.loads(yaml.safe_dump(document, sort_keys=False)).mobility()


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("rings", [0, 2])
def test_pieces_move_as_the_whole(name: str, seed: int, rings: int) -> None:
    whole = yaml.safe_load(TEXTS[name])
    draw = random.Random(f"{name} {seed} {rings}")
    found, expected = mobility(in_pieces(whole, draw, rings)), mobility(whole)
    assert found.mobility == expected.mobility
    assert found.first_order == expected.first_order
    assert found.dimensions == expected.dimensions


@pytest.mark.parametrize("count", [1, 2, 3, 6])
@pytest.mark.parametrize(("joint", "freedoms"), [(HINGE, 1), (BALL, 3), (None, 0)])
@pytest.mark.parametrize("ring", [False, True])
def test_rows_and_rings_of_welds(
    count: int, joint: Document | None, freedoms: int, ring: bool
) -> None:
    """A row of welded links behind a hinge, a ball, or a weld to ground."""
    names = list("abcdefg")[: count + 1]
    joints = {"O": joint or WELD | {"links": ["ground", "a"]}}
    pairs = list(itertools.pairwise(names))
    pairs += [(names[0], names[-1])] if ring else []
    joints |= {f"W{k}": WELD | {"links": list(pair)} for k, pair in enumerate(pairs)}
    document = {"format": 1, "name": "row", "links": {n: {} for n in names}, "joints": joints}
    found = mobility(document)
    assert found.mobility == found.first_order == freedoms
    assert found.idle == ()
    assert found.loops == int(ring)
    assert sum(item.number for item in found.redundant) == 6 * int(ring)


def test_welded_pieces_have_the_motion_of_the_whole() -> None:
    whole = {
        "format": 1,
        "name": "four-bar",
        "plane": "xy",
        "links": {"crank": {}, "rod": {}, "rocker": {}},
        "joints": {
            "O": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]},
            "A": {"type": "R", "links": ["crank", "rod"], "point": [0, 0.4]},
            "B": {"type": "R", "links": ["rod", "rocker"], "point": [1.2, 0.9]},
            "C": {"type": "R", "links": ["ground", "rocker"], "point": [1.3, 0]},
        },
        "motion": {"inputs": {"O.theta": {"from": 0, "to": 60, "step": 10}}},
    }
    expected = mk.loads(yaml.safe_dump(whole)).analyze()["C.theta"]
    for seed in SEEDS:
        model = mk.loads(yaml.safe_dump(in_pieces(whole, random.Random(seed), 0)))
        assert np.abs(model.analyze()["C.theta"] - expected).max() < 1e-12
