"""Mechanisms with legs between two spheres, assembled as drawn: S-S links and driven S-P-S legs.

Legs have mass, centred on the line of their spheres and symmetric about it.
"""

from __future__ import annotations

from typing import Any

from oracle import to_text

Place = tuple[int, int, int]
GRAVITY = {"type": "gravity", "g": ["1", "-2", "-9"]}
BODY = {
    "mass": "3",
    "center_of_mass": ["1", "1", "4"],
    "inertia": {"xx": "2", "yy": "2.5", "zz": "3", "xy": "0.2", "yz": "-0.1"},
}


def rssr(mass_centre: str = "0.5") -> str:
    """The coupler's mass centre lies on its line if `mass_centre` is 0.5."""
    coupler = _leg((0, 2, 0), (6, 3, 1), 0.5)
    coupler["center_of_mass"][2] = mass_centre
    return _text(
        {"crank": _link("0 1 0"), "coupler": coupler, "rocker": _link("6 1 1")},
        {
            "A": {
                "type": "R",
                "links": ["ground", "crank"],
                "point": _v("0 0 0"),
                "axis": _v("1 0 3"),
            },
            "B": {"type": "S", "links": ["crank", "coupler"], "point": _v("0 2 0")},
            "C": {"type": "S", "links": ["rocker", "coupler"], "point": _v("6 3 1")},
            "D": {
                "type": "R",
                "links": ["ground", "rocker"],
                "point": _v("6 0 1"),
                "axis": _v("2 1 1"),
            },
        },
        ["A.theta"],
    )


def suspension() -> str:
    """A wheel carrier on five S-S links, moved by an S-P-S strut."""
    pairs = [
        ((0, 0, 0), (5, 0, 1)),
        ((0, 3, 0), (5, 1, 0)),
        ((1, 0, 4), (5, 0, 5)),
        ((0, 3, 4), (6, 2, 5)),
        ((-1, -2, 2), (5, -2, 3)),
    ]
    links: dict[str, Any] = {"carrier": BODY}
    joints: dict[str, Any] = {}
    for k, (low, high) in enumerate(pairs, start=1):
        links[f"link{k}"] = _leg(low, high, 0.5)
        joints |= {
            f"G{k}": {"type": "S", "links": ["ground", f"link{k}"], "point": _place(low)},
            f"K{k}": {"type": "S", "links": [f"link{k}", "carrier"], "point": _place(high)},
        }
    _add_driven(links, joints, "", (2, 1, 9), (4, 1, 1), "carrier")
    return _text(links, joints, ["P.s"])


def stewart() -> str:
    """A platform on six driven S-P-S legs."""
    pairs = [
        ((6, 1, 0), (2, 3, 7)),
        ((6, -1, 0), (2, -3, 7)),
        ((-2, 6, 0), (2, 4, 7)),
        ((-4, 5, 1), (-4, 1, 7)),
        ((-2, -6, 0), (1, -4, 7)),
        ((-4, -5, 0), (-4, -1, 8)),
    ]
    links: dict[str, Any] = {"platform": BODY}
    joints: dict[str, Any] = {}
    for k, (low, high) in enumerate(pairs, start=1):
        _add_driven(links, joints, str(k), low, high, "platform")
    return _text(links, joints, [f"P{k}.s" for k in range(1, 7)])


def _add_driven(links: Any, joints: Any, k: str, low: Place, high: Place, body: str) -> None:
    links[f"lower{k}"] = _leg(low, high, 0.25)
    links[f"upper{k}"] = _leg(low, high, 0.75)
    along = [str(b - a) for a, b in zip(low, high, strict=True)]
    joints |= {
        f"L{k}": {"type": "S", "links": ["ground", f"lower{k}"], "point": _place(low)},
        f"P{k}": {
            "type": "P",
            "links": [f"lower{k}", f"upper{k}"],
            "point": _place(low),
            "axis": along,
        },
        f"U{k}": {"type": "S", "links": [f"upper{k}", body], "point": _place(high)},
    }


def _leg(low: Place, high: Place, part: float) -> dict[str, Any]:
    """Mass at a part of the way from one sphere to the other, and its symmetric inertia."""
    line = [b - a for a, b in zip(low, high, strict=True)]
    square = [line[1], -line[0], 0] if line[0] or line[1] else [1, 0, 0]
    return {
        "mass": "0.5",
        "center_of_mass": [str(a + part * x) for a, x in zip(low, line, strict=True)],
        "inertia": {
            "xx": "0.02",
            "yy": "0.7",
            "zz": "0.7",
            "axes": {"x": [str(x) for x in line], "y": [str(x) for x in square]},
        },
    }


def _link(centre: str) -> dict[str, Any]:
    return {
        "mass": "2",
        "center_of_mass": _v(centre),
        "inertia": {"xx": "1", "yy": "1", "zz": "1.5"},
    }


def _v(text: str) -> list[str]:
    return text.split()


def _place(place: Place) -> list[str]:
    return [str(x) for x in place]


def _text(links: Any, joints: Any, inputs: list[str]) -> str:
    law = {"at": "0", "rate": "0.5", "acceleration": "-0.3"}
    motion = {"inputs": {name: dict(law) for name in inputs}}
    data = {"format": "1", "links": links, "joints": joints, "motion": motion, "loads": [GRAVITY]}
    return to_text(data)
