"""Random mechanisms as files, some of them with faults, beside the files that they read."""

from __future__ import annotations

import copy
import json
import random

from random_families.same_answers.chains import Mechanism, marks, masses, parameters, structure
from random_families.same_answers.sections import expressions, loads, motion, responses, tables


def written(data):
    """Sections as YAML, one line for each entry."""
    lines = []
    for key, value in data.items():
        if isinstance(value, dict) and value:
            lines.append(f"{key}:")
            lines += [f"  {name}: {json.dumps(one)}" for name, one in value.items()]
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            lines.append(f"{key}:")
            lines += [f"  - {json.dumps(one)}" for one in value]
        else:
            lines.append(f"{key}: {json.dumps(value)}")
    return "\n".join(lines) + "\n"


def paths(value, at=()):
    found = [at] if at else []
    items = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, one in items:
        found += paths(one, (*at, key))
    return found


NONSENSE = [
    "nan", "inf", "1e400", "-", "", "abc", "5 furlong", "3 kg", "2 N", "1 +", "sin(3 m)", "0", 0, -1, 1e-300, 1e300, True, None, [], {},
    "nowhere", "ground", "r + 1 s", "foo(2)", "1/0", "0/0", "(1", "1)", "2 mm mm", "1e", "θ", "a b", [0, 0, 0], [0, 0], [1], "P1", "time",
    "A.theta", "A.tehta", "sqrt(-1)", "0x10", "on", "010", "1_000", "1,5", "5deg", "-0", "acos(2)", "[1, 2]", "if(1, 2)", "1 < 2", "k9",
]  # fmt: skip


def harmed(rng, data):
    """The sections with a fault or three."""
    data = copy.deepcopy(data)
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        at = rng.choice(paths(data))
        inner = data
        for key in at[:-1]:
            inner = inner[key]
        key = at[-1]
        form = rng.randrange(8)
        if form == 0 and isinstance(inner, dict) and len(key) > 2:  # misspelt
            i = rng.randrange(len(key) - 1)
            other = (
                key[:i] + key[i + 1] + key[i] + key[i + 2 :]
                if rng.random() < 0.5
                else key[:i] + key[i + 1 :]
            )
            inner[other] = inner.pop(key)
        elif form == 1:
            del inner[key]
        elif form == 2 and isinstance(inner, dict):
            inner[
                rng.choice(["colour", "lenght", "rate", "lead", "axis", "name", "x", "runs", "A"])
            ] = rng.choice(NONSENSE)
        elif form == 3 and isinstance(inner, list):
            inner.append(copy.deepcopy(inner[key]))
        elif form == 4 and isinstance(inner[key], str):
            inner[key] = inner[key] + rng.choice(
                [" mm", " kg", "*2", "+", ".x", "_dot", "q", " ", "^2"]
            )
        elif form == 5 and isinstance(inner[key], (int, float)):
            inner[key] = rng.choice(
                [
                    -inner[key],
                    inner[key] * 1e6,
                    f"{inner[key]} kg",
                    f"{inner[key]} m",
                    f"{inner[key]} rad",
                    inner[key] + 1e-7,
                ]
            )
        else:
            inner[key] = rng.choice(NONSENSE)
    return data


def scratched(rng, text):
    """The text with a fault in its letters."""
    lines = text.split("\n")
    form = rng.randrange(6)
    i = rng.randrange(len(lines))
    if form == 0:
        lines.insert(i, lines[i])
    elif form == 1:
        del lines[i]
    elif form == 2:
        lines[i] = rng.choice([" ", "\t", "- ", "  "]) + lines[i]
    else:
        at = rng.randrange(max(1, len(text) - 1))
        letter = rng.choice("{}[]:,\"'#&*!|>%@`\t\n 0a.-é\x07\u2028")
        return text[:at] + letter + text[at + (form > 3) :]
    return "\n".join(lines)


UNITS = [
    {"length": "mm", "angle": "deg", "mass": "kg", "force": "N"}, {"length": "mm", "angle": "deg", "mass": "kg", "force": "N"},
    {"length": "mm"}, {"length": "in", "angle": "deg", "mass": "lbm", "force": "lbf"}, {"length": "cm", "angle": "rad", "force": "N"},
    {"length": "mm", "force": "N", "angular_rate": "rpm"}, {"length": "mm", "force": "kN", "time": "min", "angular_rate": "deg/s"},
]  # fmt: skip


def mechanism(seed, faults=0.2):
    """A mechanism: its text, the files beside it, and what may be asked about."""
    rng = random.Random(seed)
    m = Mechanism(rng)
    m.data["name"] = f"m{seed}"
    m.data["units"] = rng.choice(UNITS)
    count = structure(m)
    if m.plane:
        m.data["plane"] = "xy"
    m.data["links"] = m.links
    m.data["joints"] = m.joints
    masses(m)
    marks(m)
    parameters(m)
    motion(m, count)
    responses(m, count)
    loads(m)
    tables(m)
    if m.data["units"].get("angle") == "rad":
        for one in m.data.get("motion", {}).get("inputs", {}).values():
            for key in ("from", "to", "at"):
                if isinstance(one.get(key), (int, float)):
                    one[key] = round(one[key] / 57, 3)
    data, faulty = m.data, rng.random() < faults
    if faulty and rng.random() < 0.8:
        data = harmed(rng, data)
    text = written(data)
    if faulty and data is m.data:
        text = scratched(rng, text)
    return {
        "seed": seed, "text": text, "files": m.files, "inputs": m.inputs, "coordinates": m.coordinates(), "joints": list(m.joints),
        "parameters": {n: v for n, v in m.parameters.items() if n != "z"}, "responses": m.responses,
        "expressions": expressions(m), "faulty": faulty, "sweep": "motion" in m.data,
        "tables": [t["name"] for t in m.data.get("tables", ())],
    }  # fmt: skip
