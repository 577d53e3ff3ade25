"""What the scalars and vectors of a file mean: their units, and how a new drawing changes them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from oracle.document import Document
from oracle.reader import kind_of

Place = tuple[Any, Any]
"""A container (dictionary or list) and a key in it: where a value stands."""

INERTIA_KEYS = ("xx", "yy", "zz", "xy", "xz", "yz")
_LAW = {
    "angle": ("angle", "angular rate", "angular acceleration", "angular jerk"),
    "length": ("length", "speed", "acceleration", "jerk"),
}
LAW_POSITIONS = ("from", "to", "step", "at", "values")
LAW_RATES = ("rate", "acceleration", "jerk")


def _path_parts(data: Document) -> list[Document]:
    """The pulleys and drums of cables."""
    paths = (coupling.get("path", ()) for coupling in data.get("couplings", {}).values())
    return [place for path in paths for place in path if isinstance(place, dict)]


def vectors(data: Document) -> Iterator[tuple[Place, str, str]]:
    """(where, kind of unit, behaviour) of every vector.

    `point` turns and shifts with the drawing, `polar` only turns, `pseudo` (moments) changes its
    sign more than a polar vector in a mirror.
    """
    for link in data["links"].values():
        if "center_of_mass" in (link or {}):
            yield (link, "center_of_mass"), "length", "point"
        for axis in (link or {}).get("inertia", {}).get("axes", {}):
            yield (link["inertia"]["axes"], axis), "number", "polar"
    for joint in data["joints"].values():
        for key, kind, behaviour in (
            ("point", "length", "point"),
            ("axis", "number", "polar"),
            ("axis2", "number", "polar"),
            ("normal", "number", "polar"),
            ("groove", "number", "polar"),
            ("x", "number", "polar"),
            ("zero", "number", "polar"),
        ):
            if isinstance(joint.get(key), dict):
                for link in joint[key]:
                    yield (joint[key], link), kind, behaviour
            elif key in joint:
                yield (joint, key), kind, behaviour
    for place in _path_parts(data):
        for key in ("axis", "swivel"):
            if key in place:
                yield (place, key), "number", "polar"
    for point in data.get("points", {}).values():
        yield (point, "at"), "length", "point"
    for direction in data.get("directions", {}).values():
        yield (direction, "vector"), "number", "polar"
    for load in data.get("loads", []):
        for key, kind, behaviour in (
            ("g", "acceleration", "polar"),
            ("point", "length", "point"),
            ("force", "force", "polar"),
            ("torque", "torque", "pseudo"),
            ("across", "number", "polar"),
        ):
            if key in load:
                yield (load, key), kind, behaviour


def scalars(data: Document) -> Iterator[tuple[Place, str]]:
    """(where, kind of unit) of every scalar that has a unit; the entries of vectors included."""
    for (container, key), kind, _ in vectors(data):
        yield from (((container[key], i), kind) for i in range(3))
    for link in data["links"].values():
        if "mass" in (link or {}):
            yield (link, "mass"), "mass"
        inertia = (link or {}).get("inertia", {})
        yield from (((inertia, key), "inertia") for key in INERTIA_KEYS if key in inertia)
    for joint in data["joints"].values():
        if "lead" in joint:
            yield (joint, "lead"), "length"
    yield from (((place, "radius"), "length") for place in _path_parts(data) if "radius" in place)
    for coupling in data.get("couplings", {}).values():
        lengths = ("radius", "module", "pitch", "lead")
        yield from (((coupling, key), "length") for key in lengths if key in coupling)
        yield from (
            ((coupling["radii"], i), "length") for i in range(len(coupling.get("radii", ())))
        )
        yield from (
            ((coupling, key), "angle") for key in ("helix", "pressure_angle") if key in coupling
        )
        if "pretension" in coupling:
            yield (coupling, "pretension"), "force"
    for load in data.get("loads", []):
        if load["type"] == "friction":
            lengths = ("radius", "length", "collar", "width")
            yield from (((load, key), "length") for key in lengths if key in load)
            if "speed" in load["coefficient"]:
                yield (load["coefficient"], "speed"), "speed"
        elif "joint" in load:
            yield (load, "value"), load["type"]
    for name, place in coordinates(data):
        container, key = place
        position, *rates = _LAW[kind_of(name)]
        if key in LAW_RATES:
            yield place, rates[LAW_RATES.index(key)]
        else:
            yield place, position


def coordinates(data: Document) -> Iterator[tuple[str, Place]]:
    """(joint coordinate, where) of every value of a coordinate or a rate: motion and assembly."""
    for name, law in data.get("motion", {}).get("inputs", {}).items():
        for key in law:
            if key == "values":
                yield from ((name, (law["values"], i)) for i in range(len(law["values"])))
            elif key in LAW_POSITIONS + LAW_RATES:
                yield name, (law, key)
    near = data.get("assembly", {}).get("near", {})
    yield from ((name, (near, name)) for name in near)
