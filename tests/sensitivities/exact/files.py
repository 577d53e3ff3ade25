"""Kept mechanism files with parameters to take sensitivities to, as data for both sides.

Links get points of the test's own, from which the oracle takes its first guess of their poses, and
numbers of files become parameters: a bare number the parameter's own value, an expression one plus
a parameter that is zero.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

from oracle import document, read
from oracle.expressions import is_bare
from oracle.idle import legs
from oracle.units import Units
from planar.space import in_space
from references import FILE_OF, SWEPT

Data = dict[str, Any]
BEYOND = {"lecture_swash_plate"}
"""A shoe between a plane and a ball spins freely, of which the oracle knows nothing."""
NAMES = [path.stem for path in SWEPT if path.stem not in BEYOND]
CORNERS = {"origin": (0, 0, 0), "x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
MARK = "marked"
STANDARD = "9.80665 m/s^2"


def file(name: str) -> Data:
    """A kept file without its tables, with four marked points on every link (three in a plane)."""
    data = document(FILE_OF[name])
    data = {k: v for k, v in data.items() if k not in ("tables", "quantities", "responses")}
    plane = "plane" in data
    for load in data.get("loads", []):
        if load.get("g") == "standard":
            load["g"] = ["0", f"-{STANDARD}"] if plane else ["0", "0", f"-{STANDARD}"]
    points = data.setdefault("points", {})
    unit = Units(data.get("units")).text("length")
    for number, link in enumerate(n for n in data["links"] if n != "ground"):
        for corner, at in CORNERS.items():
            if corner != "z" or not plane:
                place = [f"{x} {unit}" for x in at]
                points[mark(number, corner)] = {"link": link, "at": place[:2] if plane else place}
    return data


def mark(number: int, corner: str) -> str:
    """The name of a marked point of a link."""
    return f"{MARK}{number}{corner}"


def spatial(data: Data, *, freed: bool = False) -> Data:
    """A file of a plane as one in space; others as they are.

    Args:
        data: the file.
        freed: with reactions that are unique. A pin of every loop becomes a ball in a groove along
            z, which transmits the same forces in the plane and nothing that a plane has not.
    """
    if "plane" not in data:
        return data
    found = in_space(data)
    for load in found["loads"]:
        if load["type"] == "spring":
            kind = "torque" if load["coordinate"] == "theta" else "force"
            name = f"{load['joint']}.{load['coordinate']}"
            unit = Units(data.get("units")).text("angle" if kind == "torque" else "length")
            pull = f"-({load.pop('stiffness')})*({name} - {load.pop('free', '0')} {unit})"
            load |= {"type": kind, "value": pull}
    for name in FREED.get(data["name"], ()) if freed else ():
        joint = found["joints"][name]
        joint |= {"type": "Sg", "groove": joint.pop("axis")}
    return found


def conventional(data: Data) -> set[str]:
    """Owners of what is conventional, and the test's own points: a leg that spins freely about its
    line stands as it happens to, and so do its joints' axes."""
    mechanism = read(spatial(data))
    spinning = {link for leg in legs(mechanism) for link in leg.links}
    inner = {n for n, j in mechanism.joints.items() if spinning >= {j.first, j.second}}
    points = {n for n, (link, _) in mechanism.points.items() if link in spinning}
    return spinning | inner | points | {n for n in mechanism.points if n.startswith(MARK)}


FREED = {
    "four-bar with a coupler curve and a motor": ("B",),
    "quick-return shaper with a pin in a slot": ("A_pin", "B"),
    "Stephenson III six-bar": ("B", "E"),
}


def with_parameters(data: Data, count: int, seed: object) -> list[str]:
    """Makes parameters of numbers of a file, drawn at random; their names.

    Each place is as likely as another: points, axes, masses, their centres, inertia, loads, leads.
    """
    draw = random.Random(repr(seed))
    places = list(_places(data))
    parameters = data.setdefault("parameters", {})
    names = []
    units = Units(data.get("units"))
    for owner, key, kind in draw.sample(places, min(count, len(places))):
        name, text = f"given{len(names)}", owner[key]
        unit = "" if kind == "number" else f" {units.text(kind)}"
        bare = is_bare(text)
        parameters[name] = (text if bare else "0") + unit
        owner[key] = name if bare else f"({text}) + {name}"
        names.append(name)
    return names


def _places(data: Data) -> Iterator[tuple[Any, Any, str]]:
    """Where a scalar stands and its kind; not the mass of what spins freely, whose spin would need
    a moment where it is not the same all round."""
    spinning = {link for leg in legs(read(spatial(data))) for link in leg.links}
    for joint in data["joints"].values():
        for key, kind in (("point", "length"), ("axis", "number"), ("normal", "number")):
            written = joint.get(key, [])
            for vector in written.values() if isinstance(written, dict) else [written]:
                yield from ((vector, i, kind) for i in range(len(vector)))
        if "lead" in joint:
            yield joint, "lead", "length"
    for name, link in data["links"].items():
        if name not in {"ground", *spinning} and link and "mass" in link:
            yield link, "mass", "mass"
            yield from ((link["center_of_mass"], i, "length") for i in range(2))
            inertia = link.get("inertia", {})
            if isinstance(inertia, dict):
                yield from ((inertia, k, "inertia") for k in inertia if k != "axes")
    for load in data.get("loads", []):
        if load["type"] in ("force", "torque") and "value" in load and is_bare(load["value"]):
            yield load, "value", load["type"]


def some_rows(count: int, wanted: int) -> list[int]:
    """Rows spread over a run, neither its first nor its last where it has others."""
    if count <= wanted:
        return list(range(count))
    return sorted({(2 * k + 1) * count // (2 * wanted) for k in range(wanted)})
