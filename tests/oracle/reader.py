"""Read a mechanism file of format 1, what the oracle needs of it: all joints; loads by laws."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from oracle.document import document
from oracle.expressions import Scope
from oracle.mechanism import Input, Joint, Link, Load, Mechanism
from oracle.numerics import Number, mp
from oracle.units import Units
from oracle.vectors import IDENTITY, cross, frame, product, shortest_turn, transpose, unit

_INERTIA = (("xx", "xy", "xz"), ("xy", "yy", "yz"), ("xz", "yz", "zz"))


def read(source: str | Path | dict[str, Any], **parameters: str) -> Mechanism:
    """Read a file (a path), the text of one, or a `document`; `parameters` override its own.

    Left out: `chain`, `plane`, springs, dampers, loads from tables, inputs that follow others.
    """
    data = document(source)
    if "plane" in data:
        raise NotImplementedError(f"plane: {data['plane']}")
    units = Units(data.get("units"))
    scope = Scope(units, data.get("parameters", {}) | parameters)
    places = {
        key: {
            name: (entry["link"], scope.vector(entry[field], kind))
            for name, entry in data.get(key, {}).items()
        }
        for key, field, kind in (("points", "at", "length"), ("directions", "vector", "number"))
    }
    return Mechanism(
        units=units,
        links={n: _link(scope, link or {}) for n, link in data["links"].items() if n != "ground"},
        joints={name: _joint(scope, joint) for name, joint in data["joints"].items()},
        points=places["points"],
        directions={n: (link, unit(v)) for n, (link, v) in places["directions"].items()},
        loads=[_load(scope, load) for load in data.get("loads", [])],
        inputs={
            name: _input(scope, name, law)
            for name, law in data.get("motion", {}).get("inputs", {}).items()
        },
        near={
            name: scope.scalar(text, kind_of(name))
            for name, text in data.get("assembly", {}).get("near", {}).items()
        },
    )


def kind_of(coordinate: str) -> str:
    """The kind of unit of a joint coordinate."""
    return "length" if coordinate.endswith((".s", ".x", ".y")) else "angle"


def _link(scope: Scope, link: dict[str, Any]) -> Link:
    inertia = link.get("inertia", {})
    tensor = [[scope.scalar(inertia.get(key, "0"), "inertia") for key in r] for r in _INERTIA]
    if axes := inertia.get("axes"):
        x, y = (unit(scope.vector(axes[key], "number")) for key in ("x", "y"))
        columns = transpose([x, y, cross(x, y)])
        tensor = product(columns, tensor, transpose(columns))
    centre = link.get("center_of_mass", ["0", "0", "0"])
    return Link(scope.scalar(link.get("mass", "0"), "mass"), scope.vector(centre, "length"), tensor)


def _per_link(scope: Scope, joint: dict[str, Any], key: str, kind: str) -> list[list[Number]]:
    written = joint[key]
    if isinstance(written, dict):
        return [scope.vector(written[link], kind) for link in joint["links"]]
    return [scope.vector(written, kind)] * 2


def _joint(scope: Scope, joint: dict[str, Any]) -> Joint:
    first, second = joint["links"]
    axes, zero, x = _directions(scope, joint)
    # a weld has no place of its own: the origin of the drawing stands for it
    places = _per_link(scope, {"point": ["0", "0", "0"]} | joint, "point", "length")
    lead = scope.scalar(joint["lead"], "length") if "lead" in joint else None
    return Joint(joint["type"], first, second, (places[0], places[1]), axes, zero, lead, x)


def _directions(scope: Scope, joint: dict[str, Any]) -> tuple[Any, Any, Any]:
    """The axes, the rotation at zero and the direction x of an E."""
    key = next((key for key in ("axis", "normal", "groove") if key in joint), None)
    if key is None:
        return None, IDENTITY, None
    if "axis2" in joint:
        pair = [unit(scope.vector(joint[k], "number")) for k in ("axis", "axis2")]
        return (pair[0], pair[1]), IDENTITY, None
    axis, other = (unit(a) for a in _per_link(scope, joint, key, "number"))
    zero, x = IDENTITY, None
    towards = "x" if joint["type"] == "E" else "zero"
    if towards in joint:
        a, b = _per_link(scope, joint, towards, "number")
        zero = product(frame(axis, a), transpose(frame(other, b)))
        x = transpose(frame(axis, a))[0] if towards == "x" else None
    elif isinstance(joint[key], dict):
        zero = shortest_turn(other, axis)
    return (axis, other), zero, x


def _load(scope: Scope, load: dict[str, Any]) -> Load:
    kind = load["type"]
    if kind == "gravity":
        return Load(kind, vector=scope.vector(load["g"], "acceleration"))
    if kind not in ("force", "torque"):
        raise NotImplementedError(f"the oracle has no load of type {kind}")
    if "joint" in load:
        return Load(kind, joint=load["joint"], value=scope.law(load["value"], kind))
    return Load(
        kind,
        link=load["link"],
        point=scope.vector(load["point"], "length") if kind == "force" else None,
        vector=[scope.law(text, kind) for text in load[kind]],
        turns_with_link=load.get("axes", "ground") == "link",
    )


def _input(scope: Scope, name: str, law: dict[str, Any]) -> Input:
    kind = kind_of(name)
    if "values" in law:
        values = scope.vector(law["values"], kind)
    elif "at" in law:
        values = [scope.scalar(law["at"], kind)]
    else:
        values = _range(scope, law, kind)
    prefix = "angular " if kind == "angle" else ""
    kinds = {
        "rate": prefix + "rate" if prefix else "speed",
        "acceleration": prefix + "acceleration",
        "jerk": prefix + "jerk",
    }
    return Input(values, *(scope.scalar(law.get(key, "0"), k) for key, k in kinds.items()))


def _range(scope: Scope, law: dict[str, Any], kind: str) -> list[Number]:
    start, end = (scope.scalar(law[key], kind) for key in ("from", "to"))
    if "count" in law:
        count = int(law["count"])
        step = (end - start) / (count - 1)
    else:
        step = abs(scope.scalar(law["step"], kind))
        count = int(mp.floor(abs(end - start) / step + mp.mpf("1e-9"))) + 1
        step = step if end >= start else -step
    return [start + i * step for i in range(count)]
