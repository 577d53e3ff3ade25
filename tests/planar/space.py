"""A file in a plane as the same file in space, as people wrote it before `plane: xy`.

Every hinge has the axis z, every vector a zero; a pin in a slot is a block without mass that turns
on the pin and slides in the slot.
"""

from __future__ import annotations

from typing import Any

Data = dict[str, Any]


def flat(vector: list[Any]) -> list[Any]:
    return [*vector, 0]


def each(given: Any) -> Any:
    if isinstance(given, dict):
        return {link: flat(vector) for link, vector in given.items()}
    return flat(given)


def in_space(data: Data) -> Data:
    """The same mechanism in space; coordinates of a pin in a slot A are those of A_pin and A."""
    found = {key: value for key, value in data.items() if key != "plane"}
    found["links"] = {name: _link(link) for name, link in data["links"].items()}
    found["joints"] = {}
    for name, joint in data["joints"].items():
        if joint["type"] != "Ps":
            found["joints"][name] = _joint(joint)
            continue
        block, (pinned, slotted) = f"{name}_block", joint["links"]
        at = joint["point"]
        of_pin, of_slot = (at, at) if isinstance(at, list) else (at[pinned], at[slotted])
        found["links"][block] = {}
        found["joints"][f"{name}_pin"] = {
            "type": "R",
            "links": [pinned, block],
            "point": flat(of_pin),
            "axis": [0, 0, 1],
        }
        # the block runs along the slot as s grows: it is the second link against the slotted one
        found["joints"][name] = {
            "type": "P",
            "links": [slotted, block],
            "point": {slotted: flat(of_slot), block: flat(of_pin)},
            "axis": flat(joint["slot"]),
        }
    for key, place in (("points", "at"), ("directions", "vector")):
        found[key] = {
            name: {**one, place: flat(one[place])} for name, one in data.get(key, {}).items()
        }
    found["loads"] = [_load(load) for load in data.get("loads", ())]
    return found


def _link(link: Data) -> Data:
    if "mass" not in link:
        return link
    about = link.get("inertia", 0)
    return {
        "mass": link["mass"],
        "center_of_mass": flat(link["center_of_mass"]),
        "inertia": {"xx": about, "yy": about, "zz": about},
    }


def _joint(joint: Data) -> Data:
    found = dict(joint)
    if "point" in joint:
        found["point"] = each(joint["point"])
    if joint["type"] == "R":
        found["axis"] = [0, 0, 1]
        if "zero" in joint:
            found["zero"] = each(joint["zero"])
    elif joint["type"] == "P":
        found["axis"] = each(joint["axis"])
        if isinstance(joint["axis"], dict):
            found["zero"] = {link: [0, 0, 1] for link in joint["links"]}
    return found


def _load(load: Data) -> Data:
    found = dict(load)
    for key in ("g", "force", "point"):
        if isinstance(load.get(key), list):
            found[key] = flat(load[key])
    if load["type"] == "torque" and "link" in load:
        found["torque"] = [0, 0, load["torque"]]
    return found
