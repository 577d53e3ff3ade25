"""What must not change mobility: names, order, direction of the pairs, scale, place in space."""

from __future__ import annotations

import math
from typing import Any

import pytest
import yaml
from mobility.overconstrained import (
    bricard,
    coaxial_hinge,
    double_spherical,
    general,
    leg,
    planar,
    sarrus,
    stretched,
)

import mechkin_cli as mk

TEXTS = {
    "planar": planar(),
    "sarrus": sarrus(),
    "bricard": bricard(),
    "stretched": stretched(),
    "RSSR": double_spherical(),
    "collar": coaxial_hinge(),
    "leg": leg(),
    "RPRHRRR": general("RPRHRRR", lead=0.3),
    "RCSR": general("RCSR"),
}
Document = dict[str, Any]


def seen(document: Document) -> tuple[Any, ...]:
    """Everything that mobility says in numbers."""
    found = mk.loads(yaml.safe_dump(document, sort_keys=False)).mobility()
    redundant = sorted(item.number for item in found.redundant)
    idle = sorted(len(item.links) for item in found.idle)
    return found.count, found.loops, found.mobility, found.first_order, redundant, idle


def reordered(document: Document) -> Document:
    """Joints and links written in the opposite order."""
    joints, links = document["joints"], document["links"]
    return document | {
        "joints": dict(reversed(joints.items())),
        "links": dict(reversed(links.items())),
    }


def renamed(document: Document) -> Document:
    """Other names, whose alphabetic order is another."""
    joints = list(document["joints"].values())
    return document | {"joints": {f"K{len(joints) - i}": joint for i, joint in enumerate(joints)}}


def swapped(document: Document) -> Document:
    """Every joint from its second link to its first."""
    return document | {
        "joints": {
            name: joint | {"links": joint["links"][::-1]}
            for name, joint in document["joints"].items()
        }
    }


def mapped(document: Document, point: Any, direction: Any) -> Document:
    """Points and directions mapped."""

    def of(joint: dict[str, Any]) -> dict[str, Any]:
        maps = {"point": point, "axis": direction}
        return {
            key: (
                {link: maps[key](v) for link, v in value.items()}
                if isinstance(value, dict)
                else maps[key](value)
            )
            if key in maps
            else value
            for key, value in joint.items()
        }

    return document | {"joints": {name: of(j) for name, j in document["joints"].items()}}


def doubled(document: Document) -> Document:
    """All lengths doubled, leads too."""
    larger = mapped(document, lambda p: [2 * float(c) for c in p], lambda v: v)
    joints = {
        name: joint | ({"lead": 2 * float(joint["lead"])} if "lead" in joint else {})
        for name, joint in larger["joints"].items()
    }
    return larger | {"joints": joints}


def turned(document: Document) -> Document:
    """Turned about an axis of no meaning and shifted."""
    c, s = math.cos(0.7), math.sin(0.7)

    def direction(v: Any) -> list[float]:
        x, y, z = (float(a) for a in v)
        x, y = c * x - s * y, s * x + c * y
        return [x, c * y - s * z, s * y + c * z]

    def point(p: Any) -> list[float]:
        return [a + b for a, b in zip(direction(p), (3.0, -1.0, 0.5), strict=True)]

    return mapped(document, point, direction)


@pytest.mark.parametrize("change", [reordered, renamed, swapped, doubled, turned])
@pytest.mark.parametrize("name", TEXTS)
def test_the_answer_stays(name: str, change: Any) -> None:
    document = yaml.safe_load(TEXTS[name])
    assert seen(change(document)) == seen(document)


@pytest.mark.parametrize("name", ["planar", "RSSR", "RCSR"])
def test_a_weld_between_two_halves_of_a_link_changes_nothing(name: str) -> None:
    document = yaml.safe_load(TEXTS[name])
    joints = dict(document["joints"])
    last = next(n for n, j in reversed(joints.items()) if "L1" in j["links"])
    halves = ["half" if link == "L1" else link for link in joints[last]["links"]]
    joints |= {last: joints[last] | {"links": halves}}
    joints["weld"] = {"type": "W", "links": ["L1", "half"]}
    split = document | {"joints": joints, "links": document["links"] | {"half": {}}}
    assert seen(split)[:5] == seen(document)[:5]


@pytest.mark.parametrize("name", ["planar", "RSSR"])
def test_a_link_that_hangs_free_adds_its_freedoms(name: str) -> None:
    document = yaml.safe_load(TEXTS[name])
    flag = {"type": "C", "links": ["L1", "flag"], "point": [0, 0, 0], "axis": [1, 2, 3]}
    hung = document | {
        "joints": document["joints"] | {"hinge": flag},
        "links": document["links"] | {"flag": {}},
    }
    count, loops, mobility, first, redundant, _ = seen(document)
    assert seen(hung)[:5] == (count + 2, loops, mobility + 2, first + 2, redundant)
