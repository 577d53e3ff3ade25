"""The same mechanism written otherwise, and how its answers must change.

Every function takes a `document` and returns a new one; tables are left as they are. In the lists
of answers, `M` is a moment about the joint point, `Mo` about the ground origin; what is not named
stays. Numbers that change are written with the digits of `mp`, so reading them costs one rounding.
"""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from typing import Any

from oracle.document import Document, document
from oracle.expressions import Scope, is_bare
from oracle.fields import coordinates, scalars, vectors
from oracle.numerics import Number, mp
from oracle.units import Units
from oracle.vectors import add, apply

_LENGTHS = {"length": 1, "speed": 1, "acceleration": 1, "jerk": 1}
_LENGTHS |= {"force": 1, "torque": 2, "inertia": 2}
_LENGTH_WRITTEN_OUT = re.compile(r"[\d.]+ (?:mm|cm|m|in)\b(?!/)")
_PROSE = ("format", "type", "name", "title", "source", "label", "units")


def rotation_matrix(a: int, b: int, c: int, d: int) -> list[list[Number]]:
    """The rotation of the quaternion a + b i + c j + d k, of any length."""
    square = mp.mpf(a * a + b * b + c * c + d * d)
    rows = [
        [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
        [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
        [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]
    return [[x / square for x in row] for row in rows]


def moved(
    data: Document, rotation: Sequence[Sequence[Number]], shift: Sequence[Number]
) -> Document:
    """The drawing turned by a rotation matrix, then shifted (`shift` in file units).

    Coordinates, efforts: unchanged. Positions x -> R x + shift; velocities, accelerations, omega,
    alpha, axes, directions, forces, M: turned by R. Mo -> R Mo + shift x R F.
    """
    data = document(data)
    _give_inertia_axes(data)
    _map_vectors(
        data,
        {
            "point": lambda v: add(apply(rotation, v), [mp.mpf(x) for x in shift]),
            "polar": lambda v: apply(rotation, v),
            "pseudo": lambda v: apply(rotation, v),
        },
    )
    return data


def mirrored(data: Document) -> Document:
    """The drawing mirrored in the plane x = 0, axes as arrows (they mirror like points).

    Angles and their rates change sign, also y of an E; slides s and x do not. Efforts likewise.
    Positions, velocities, accelerations, axes, directions, forces: x components change sign. M, Mo,
    omega, alpha: y and z components change sign. Leads and determinants change sign.
    """
    data = document(data)
    _give_inertia_axes(data)
    _map_vectors(
        data,
        {
            "point": lambda v: [-v[0], v[1], v[2]],
            "polar": lambda v: [-v[0], v[1], v[2]],
            "pseudo": lambda v: [v[0], -v[1], -v[2]],
        },
    )
    for link in data["links"].values():
        # z = x cross y of mirrored axes is the opposite of the mirrored z
        inertia = (link or {}).get("inertia", {})
        for key in ("xz", "yz"):
            if key in inertia:
                inertia[key] = _negated(inertia[key])
    for joint in data["joints"].values():
        if "lead" in joint:
            joint["lead"] = _negated(joint["lead"])
    for load in data.get("loads", []):
        if load["type"] == "torque" and "joint" in load:
            load["value"] = _negated(load["value"])
    _negate_coordinates(data, lambda name: ".theta" in name or name.endswith(".y"))
    return data


def swapped_links(data: Document, joint: str) -> Document:
    """One joint's links in the other order, its axis kept.

    Its theta and s, their rates, its force, Mo and effort change sign; its point and M belong to
    the other link (only Mo compares simply). The axes of a U change places, and theta1 becomes
    -theta2; a U must not be driven. Sp, Sg and E do not swap so simply. Everything else is
    unchanged.
    """
    data = document(data)
    drawn = data["joints"][joint]
    drawn["links"].reverse()
    if drawn["type"] == "U":
        drawn["axis"], drawn["axis2"] = drawn["axis2"], drawn["axis"]
    for load in data.get("loads", []):
        if load.get("joint") == joint and "value" in load:
            load["value"] = _negated(load["value"])
    _negate_coordinates(data, lambda name: name.startswith(joint + "."))
    return data


def renamed(data: Document, names: Mapping[str, str]) -> Document:
    """Links, joints, points, directions or parameters by other names: the same answers by those."""
    if not names:
        return document(data)
    either = "|".join(map(re.escape, names))
    pattern = re.compile(rf"(?<![\w.])({either})(?!\w)")

    def change(value: Any, prose: bool = False) -> Any:
        if isinstance(value, dict):
            return {change(k): change(v, k in _PROSE) for k, v in value.items()}
        if isinstance(value, list):
            return [change(v) for v in value]
        return value if prose else pattern.sub(lambda m: names[m[1]], value)

    return {key: change(value, key in _PROSE) for key, value in document(data).items()}


def reordered(data: Document, seed: int) -> Document:
    """Links, joints, points, directions and parameters in another order: all answers unchanged."""
    data = document(data)
    generator = random.Random(seed)
    for key in ("links", "joints", "points", "directions", "parameters"):
        entries = list(data.get(key, {}).items())
        generator.shuffle(entries)
        if entries:
            data[key] = dict(entries)
    return data


def beside_itself(data: Document, mark: str = "_again") -> Document:
    """The mechanism and a copy of it in one file, driven alike: the copy's links, joints, points
    and directions bear a mark behind their names, and all answers are there twice."""
    data = document(data)
    sections = ("links", "joints", "points", "directions")
    names = {name for key in sections for name in data.get(key, {})}
    copy = renamed(data, {name: name + mark for name in names})
    for key in sections:
        data[key] = data.get(key, {}) | copy.get(key, {})
    data["motion"]["inputs"] |= copy["motion"]["inputs"]
    data["loads"] = data.get("loads", []) + [
        load for load in copy.get("loads", []) if load["type"] != "gravity"
    ]
    if "assembly" in data:
        data["assembly"]["near"] |= copy["assembly"]["near"]
    return {key: value for key, value in data.items() if value}


def with_links(data: Document, links: Document, joints: Document) -> Document:
    """With more links and joints: where these leave the others alone, so are their answers."""
    data = document(data)
    return data | {"links": data["links"] | links, "joints": data["joints"] | joints}


def scaled(data: Document, factor: str) -> Document:
    """All lengths times a number, masses and times the same.

    Angles and angular rates: unchanged. Slides, positions and their rates, forces: times the
    factor. Moments: times its square.
    """
    data = document(data)
    for (container, key), kind in scalars(data):
        if power := _LENGTHS.get(kind, 0):
            container[key] = f"({container[key]}{_unit(data, container[key], kind)})" + (
                f" * {factor}" * power
            )
    for law in data.get("motion", {}).get("inputs", {}).values():
        if "with" in law:
            law["with"] = _LENGTH_WRITTEN_OUT.sub(rf"(\g<0> * {factor})", str(law["with"]))
    return data


def in_other_units(data: Document, units: Mapping[str, str]) -> Document:
    """Other `units:`; every bare number keeps its meaning by its old unit written out.

    Answers in the base are the same quantities; in file units they change by the units' ratio.
    """
    data = document(data)
    for (container, key), kind in scalars(data):
        if is_bare(container[key]) and kind != "number":
            container[key] += _unit(data, container[key], kind)
    # the units come first, as a reader expects them
    return {"format": data["format"], "units": dict(units)} | {
        key: value for key, value in data.items() if key not in ("format", "units")
    }


def _unit(data: Document, text: str, kind: str) -> str:
    """The file's unit to write behind a bare number."""
    return f" {Units(data.get('units')).text(kind)}" if is_bare(text) else ""


def _give_inertia_axes(data: Document) -> None:
    for link in data["links"].values():
        if "inertia" in (link or {}):
            link["inertia"].setdefault("axes", {"x": ["1", "0", "0"], "y": ["0", "1", "0"]})


def _map_vectors(data: Document, functions: Mapping[str, Any]) -> None:
    """Apply a function per behaviour to the value of every vector, in file units."""
    units = Units(data.get("units"))
    scope = Scope(units, data.get("parameters", {}))
    for (container, key), kind, behaviour in list(vectors(data)):
        if isinstance(container[key], str):
            continue  # the name of a point, which stands elsewhere
        values = [x / units.of(kind) for x in scope.vector(container[key], kind)]
        container[key] = [_text(x) for x in functions[behaviour](values)]


def _text(value: Number) -> str:
    return mp.nstr(value, mp.dps)


def _negated(text: str) -> str:
    if not is_bare(text):
        return f"-({text})"
    text = text.strip()
    return text[1:] if text[0] == "-" else "-" + text.removeprefix("+")


def _negate_coordinates(data: Document, chosen: Any) -> None:
    for name, place in coordinates(data):
        container, key = place
        # a step has no sign: it is taken towards the end
        if chosen(name) and key != "step":
            container[key] = _negated(container[key])
