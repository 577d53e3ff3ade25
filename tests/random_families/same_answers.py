"""Does an answer depend on what was asked before?

    python same_answers.py COUNT SEED [spoil]

draws COUNT mechanisms (plane and space, loops 0 to 3, legs, idle freedoms, ties, laws of time,
loads that vary, friction, responses, parameters; some of them with faults), asks one model of each
many questions in random order - also through pickles, copies, models with other parameters, and
from threads - and each question of a model that was loaded for it alone. Every answer has to be
the same to the bit, whatever lanes and threads. With `spoil` the free memory is filled with nan
and the like before the one, and with zeros before the other, so that what is read before it is
written shows. The mechanisms are written from docs/format.md alone; only the installed package is
needed.
"""

import copy
import json
import pickle
import random
import sys
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from enum import Enum
from pathlib import Path

import numpy as np

# ---------------------------------------------------------------- mechanisms

FREEDOMS = {
    "R": 1,
    "P": 1,
    "H": 1,
    "C": 2,
    "U": 2,
    "Ss": 2,
    "S": 3,
    "E": 3,
    "Sc": 3,
    "Sg": 4,
    "Cp": 4,
    "Sp": 5,
}
COORDINATES = {
    "R": ["theta"], "P": ["s"], "C": ["theta", "s"], "H": ["theta", "s"], "S": [], "Sp": [], "Sg": ["s"],
    "U": ["theta1", "theta2"], "E": ["x", "y", "theta"], "Ss": ["theta1", "theta2"],
    "Sc": ["s", "theta1", "theta2"], "Cp": ["theta1", "theta2", "x", "y"], "W": [], "Ps": ["theta", "s"],
}  # fmt: skip
PLANE_FREEDOMS = {"R": 1, "P": 1, "Ps": 2}


class Mechanism:
    """A file being drawn: its sections, the files beside it, and what may be asked of it."""

    def __init__(self, rng):
        self.rng = rng
        self.data = {"format": 1}
        self.files = {}
        self.plane = False
        self.joints = {}
        self.links = {}
        self.inputs = []
        self.responses = []
        self.named = []
        self.scale = 100.0

    # -- numbers

    def vector(self, spread=1.0, about=None):
        n = 2 if self.plane else 3
        about = about or [0.0] * n
        digits = self.rng.choice([0, 1, 3])
        return [round(a + self.rng.uniform(-1, 1) * spread, digits) for a in about]

    def direction(self):
        rng = self.rng
        n = 2 if self.plane else 3
        if rng.random() < 0.5:
            one = [0] * n
            one[rng.randrange(n)] = rng.choice([1, 1, -1])
            return one
        while True:
            found = [rng.randint(-4, 4) for _ in range(n)]
            if any(found):
                return found

    def is_angle(self, coordinate):
        return coordinate.split(".")[1].startswith("theta")

    # -- structure

    def link(self, name=None):
        name = name or f"k{len(self.links) + 1}"
        self.links[name] = {}
        return name

    def joint(self, kind, first, second, point):
        rng = self.rng
        name = f"{'ABDEFGJKLMNQ'[len(self.joints) % 12]}{len(self.joints) // 12 or ''}"
        one = {"type": kind, "links": [first, second]}
        if kind != "W":
            one["point"] = point
        if kind in ("R", "P", "C", "H") and not (self.plane and kind == "R"):
            one["axis"] = self.direction()
        if kind == "H":
            one["lead"] = f"{rng.choice([5, -8, 12.5])} mm"
        if kind == "Sp":
            one["normal"] = self.direction()
        if kind == "Sg":
            one["groove"] = self.direction()
        if kind == "Ps":
            one["slot"] = self.direction()
        pair = rng.choice(
            [
                ([0, 0, 1], [1, 0, 0]),
                ([1, 0, 0], [0, 1, 0]),
                ([0, 1, 1], [1, 0, 0]),
                ([1, 2, 0], [2, -1, 0]),
            ]
        )
        for first_key, second_key, kinds in (
            ("axis", "axis2", "U"), ("normal", "x", "E"), ("slot", "pin", "Ss"), ("axis", "pin", "Sc"), ("axis", "normal", "Cp"),
        ):  # fmt: skip
            if kind == kinds:
                one[first_key], one[second_key] = pair
        if rng.random() < 0.1 and kind not in ("W",):
            one["links"].reverse()
        self.joints[name] = one
        return name

    def coordinates(self):
        return [
            f"{name}.{c}" for name, one in self.joints.items() for c in COORDINATES[one["type"]]
        ]

    def chain(self, first, last, kinds, start, end, closed):
        """Joints of these kinds from one link to another over new links; drawn closed or not."""
        links = [first] + [self.link() for _ in kinds[1:]] + [last]
        made = []
        for place, kind in enumerate(kinds):
            part = place / max(1, len(kinds) - 1)
            about = [a + (b - a) * part for a, b in zip(start, end)]
            point = self.vector(0.6 * self.scale, about)
            made.append(self.joint(kind, links[place], links[place + 1], point))
        if not closed:
            one = self.joints[made[-1]]
            if one["type"] != "W":
                one["point"] = {
                    n: self.vector(0.1 * self.scale, one["point"]) for n in one["links"]
                }
        return made


def kinds_with(rng, table, total, weights, least=2):
    """Kinds whose freedoms sum up to a total."""
    while True:
        kinds, left = [], total
        while left > 0:
            fitting = [k for k in table if table[k] <= left]
            kinds.append(rng.choices(fitting, [weights.get(k, 1) for k in fitting])[0])
            left -= table[kinds[-1]]
        if least <= len(kinds) <= 7:
            rng.shuffle(kinds)
            return kinds


SPACE_WEIGHTS = {
    "R": 10,
    "P": 4,
    "C": 5,
    "H": 2,
    "S": 4,
    "Sp": 1,
    "Sg": 1.5,
    "U": 2,
    "E": 1,
    "Ss": 0.7,
    "Sc": 0.7,
    "Cp": 0.7,
}
PLANE_WEIGHTS = {"R": 6, "P": 2, "Ps": 1.5}


def structure(m):
    """Links and joints; gives how many inputs they need."""
    rng = m.rng
    m.plane = rng.random() < 0.4
    n = 2 if m.plane else 3
    origin = [0.0] * n
    table, weights, held = (
        (PLANE_FREEDOMS, PLANE_WEIGHTS, 3) if m.plane else (FREEDOMS, SPACE_WEIGHTS, 6)
    )
    form = rng.random()
    closed = rng.random() < 0.85
    if form < 0.12:  # an open chain
        kinds = [
            rng.choice(["R", "P"] if m.plane else ["R", "P", "C", "H", "U"])
            for _ in range(rng.randint(1, 3))
        ]
        before = "ground"
        for kind in kinds:
            after = m.link()
            m.joint(kind, before, after, m.vector(m.scale))
            before = after
        return sum(table[k] for k in kinds)
    if form < 0.22 and not m.plane:  # planar or spherical loop in space, overconstrained
        point = [0.0, 0.0, 0.0]
        links = ["ground", m.link(), m.link(), m.link()]
        spherical = rng.random() < 0.4
        corners = [
            [0, 0, 0],
            [40, 0, 0],
            [120, rng.randint(60, 100), 0],
            [rng.randint(100, 130), 0, 0],
        ]
        axes = [[0, 0, 1], [1, 0, 3], [2, 3, 4], [4, 0, 1]]
        for i in range(4):
            name = m.joint("R", links[i], links[(i + 1) % 4], point if spherical else corners[i])
            m.joints[name]["axis"] = axes[i] if spherical else [0, 0, 1]
        if rng.random() < 0.3 and not spherical:
            last = list(m.joints)[3]
            m.joints[last]["type"] = "P"
            m.joints[last]["axis"] = [1, 0, 0]
        return 1
    if form < 0.34 and not m.plane:  # a rocker driven over a leg, S-S or S-P-S
        crank, rod, rocker = m.link(), m.link(), m.link()
        m.joint("R", "ground", crank, m.vector(20))
        m.joint("S", crank, rod, m.vector(20, [40, 10, 0]))
        inputs = 1
        if rng.random() < 0.3:
            inner = m.link()
            a, b = m.vector(20, [40, 10, 0]), m.vector(20, [150, 60, 40])
            list(m.joints.values())[-1]["point"] = a
            name = m.joint("P", rod, inner, a)
            m.joints[name]["axis"] = [round(y - x, 6) for x, y in zip(a, b)]
            m.joint("S", inner, rocker, b)
            inputs = 2
        else:
            m.joint("S", rod, rocker, m.vector(20, [150, 60, 40]))
        m.joint(rng.choice(["R", "R", "R", "P", "H"]), "ground", rocker, m.vector(20, [140, 0, 30]))
        return inputs
    freedoms = rng.choices([1, 2], [4, 1])[0]
    kinds = kinds_with(rng, table, held + freedoms, weights)
    if rng.random() < 0.8 and not {"R", "P"} & {kinds[0]}:
        for i, kind in enumerate(kinds):
            if kind in ("R", "P"):
                kinds[0], kinds[i] = kinds[i], kinds[0]
                break
    end = [1.5 * m.scale] + [0.0] * (n - 1)
    m.chain("ground", "ground", kinds, origin, end, closed)
    more = rng.choices([0, 1, 2], [5, 2, 1] if not m.plane else [3, 2, 1])[0]
    for _ in range(more):
        wanted = rng.choices([0, 1], [6, 1])[0]
        freedoms += wanted
        kinds = kinds_with(rng, table, held + wanted, weights)
        first, last = rng.sample(["ground", *m.links], 2)
        start = m.vector(m.scale)
        m.chain(first, last, kinds, start, m.vector(m.scale, start), closed)
    if rng.random() < 0.06:  # a weld, or a link that hangs on
        m.joint("W", rng.choice(list(m.links)), m.link(), None)
    if rng.random() < 0.06:
        m.joint("R", rng.choice(list(m.links)), m.link(), m.vector(m.scale))
        freedoms += 1
    return freedoms


def masses(m):
    rng = m.rng
    if rng.random() < 0.25:
        return
    for one in m.links.values():
        if rng.random() < 0.6:
            one["mass"] = round(rng.uniform(0.1, 5), 2)
            one["center_of_mass"] = m.vector(m.scale)
            if rng.random() < 0.6:
                i = round(rng.uniform(100, 5000), 1)
                one["inertia"] = (
                    i if m.plane else {"xx": i, "yy": round(1.2 * i, 1), "zz": round(0.9 * i, 1)}
                )


def marks(m):
    rng = m.rng
    points = {}
    for i in range(rng.randint(0, 3)):
        link = rng.choice([*m.links, "ground"]) if m.links else "ground"
        points[f"p{i}"] = {"link": link, "at": m.vector(m.scale)}
    if points:
        m.data["points"] = points
    if rng.random() < 0.3 and m.links:
        m.data["directions"] = {"d0": {"link": rng.choice(list(m.links)), "vector": m.direction()}}
    m.points = points


def parameters(m):
    """Some numbers of the drawing become parameters."""
    rng = m.rng
    m.parameters = {}
    if rng.random() < 0.35:
        return
    names = ["r", "q", "h", "w"]
    places = [
        (j, i) for j in m.joints for i in range(2) if isinstance(m.joints[j].get("point"), list)
    ]
    rng.shuffle(places)
    for name, (joint, i) in zip(names[: rng.randint(1, 4)], places):
        value = m.joints[joint]["point"][i]
        unit = m.data["units"].get("length", "mm") if rng.random() < 0.98 else ""
        m.parameters[name] = f"{value} {unit}".strip()
        form = rng.random()
        m.joints[joint]["point"][i] = (
            name if form < 0.6 else f"{name} + 0 mm" if form < 0.8 else f"2*{name}/2"
        )
    if m.parameters and rng.random() < 0.3:
        first = next(iter(m.parameters))
        m.parameters["z"] = f"{first}*2 + 1 mm"  # nothing uses it, which is a note
    if rng.random() < 0.3:
        m.parameters["k"] = "2 N/mm"
    if rng.random() < 0.1:
        m.parameters["unused"] = "3 deg"
    if m.parameters:
        m.data["parameters"] = m.parameters


def angle_or_length(m, coordinate, least, most):
    if m.is_angle(coordinate):
        return round(m.rng.uniform(least, most), m.rng.choice([0, 1]))
    return round(m.rng.uniform(least, most) * 0.3, 1)


def followed(m, coordinate, other):
    """An expression of another coordinate in the dimension of this one."""
    if m.is_angle(coordinate) == m.is_angle(other):
        return f"2*{other}"
    return f"{other}/(10 mm)*(1 rad)" if m.is_angle(coordinate) else f"20 mm*sin({other})"


def motion(m, count):
    rng = m.rng
    free = m.coordinates()
    if not free:
        return
    helical = {f"{n}.s" for n, one in m.joints.items() if one["type"] == "H"}
    free = [c for c in free if c not in helical]
    if rng.random() < 0.75:  # the first ones, where a motor would sit
        chosen = free[:count]
    else:
        chosen = rng.sample(free, min(count, len(free)))
    if rng.random() < 0.05 and len(free) > count:
        chosen = [*chosen, free[-1]]
    rows = rng.choice([1, 3, 5, 9, 13])
    timed = rng.random() < 0.3
    inputs = {}
    for i, c in enumerate(chosen):
        span = rng.choice([10, 40, 40, 90, 360])
        begin = 0 if rng.random() < 0.6 else angle_or_length(m, c, -30, 30)
        to = begin + (span if m.is_angle(c) else round(0.3 * min(span, 90), 2))
        if timed:
            law = rng.choice(
                [
                    "constant-rate",
                    "constant-acceleration",
                    "polynomial",
                    "harmonic",
                    "cycloidal",
                    "table",
                ]
            )
            rate = "rad/s" if m.is_angle(c) else "mm/s"
            one = {"law": law}
            if law == "constant-rate":
                one |= {"at": begin, "rate": f"{rng.choice([0.5, 1, -2])} {rate}"}
            elif law == "constant-acceleration":
                one |= {"at": begin, "rate": f"0.2 {rate}", "acceleration": f"0.7 {rate}^2"}
            elif law == "polynomial":
                one["coefficients"] = [begin, f"0.4 {rate}", f"0.3 {rate}^2", f"-0.1 {rate}^3"]
            elif law in ("harmonic", "cycloidal"):
                one |= {"from": begin, "to": to}
                if rng.random() < 0.4:
                    one |= {"start": "0.1 s", "duration": "0.5 s"}
            else:
                one["file"] = f"law{i}.csv"
                m.files[f"law{i}.csv"] = "t,x\n" + "".join(
                    f"{t},{round(begin + (to - begin) * (t / 1.0) ** 2, 4)}\n"
                    for t in (0, 0.25, 0.5, 0.75, 1.0)
                )
                if rng.random() < 0.5:
                    one["interpolation"] = rng.choice(["spline", "monotone", "linear"])
                if rng.random() < 0.3:
                    one["ends"] = rng.choice(["natural", "clamped", "not-a-knot"])
            if i and rng.random() < 0.35:
                one = {
                    "with": rng.choice(
                        [
                            followed(m, c, chosen[0]),
                            f"{followed(m, c, chosen[0])} + {'3 deg' if m.is_angle(c) else '3 mm'}*sin(2 rad/s*time)",
                        ]
                    )
                }
        else:
            form = rng.random()
            if form < 0.7:
                one = {"from": begin, "to": to, "count": rows}
                if rng.random() < 0.1:
                    one = {"from": begin, "to": to, "step": max(1, round((to - begin) / 7, 1))}
            elif form < 0.85:
                one = {
                    "values": [
                        round(begin + (to - begin) * k / max(1, rows - 1), 3) for k in range(rows)
                    ]
                }
            else:
                one = {"at": begin}
            if i and rng.random() < 0.3:
                one = {
                    "with": rng.choice(
                        [
                            followed(m, c, chosen[0]),
                            f"-{followed(m, c, chosen[0])}",
                            f"{followed(m, c, chosen[0])} + {'2 deg' if m.is_angle(c) else '1 mm'}",
                        ]
                    )
                }
                if rng.random() < 0.5:
                    one["drive"] = rng.choice(["tie", "own"])
            elif rng.random() < 0.7:
                one["rate"] = rng.choice([1, 0.5, "2 rad/s" if m.is_angle(c) else "10 mm/s"])
                if rng.random() < 0.3:
                    one["acceleration"] = rng.choice([1, -0.5])
                if rng.random() < 0.1:
                    one["jerk"] = 0.3
        inputs[c] = one
    m.inputs = chosen
    section = {"inputs": inputs}
    if timed:
        section["time"] = {"from": 0, "to": "1 s", "count": rows}
    if rng.random() < 0.93:
        m.data["motion"] = section
    m.timed = timed
    others = [c for c in free if c not in chosen]
    if others and rng.random() < 0.25:
        c = rng.choice(others)
        m.data["assembly"] = {"near": {c: angle_or_length(m, c, -120, 120)}}
    elif rng.random() < 0.08:
        m.data["assembly"] = {"mode": rng.choice("AB")}
    elif rng.random() < 0.08:
        m.data["assembly"] = {"at_branch_points": "straight"}
    if rng.random() < 0.08:
        m.data.setdefault("assembly", {})["turns"] = rng.choice([0, 2])
    if others and rng.random() < 0.06:
        m.data["actuators"] = rng.sample(others, min(len(others), count))
    if rng.random() < 0.1 and m.joints:
        m.data["follow"] = [rng.choice(list(m.joints))]


def responses(m, count):
    rng = m.rng
    if rng.random() > 0.22 or not m.coordinates():
        return
    made = {}
    for name in ["fall", "swing"][: rng.choice([1, 1, 2])]:
        start = {
            c: 0 if rng.random() < 0.7 else angle_or_length(m, c, -20, 20)
            for c in (m.inputs or m.coordinates())[:count]
        }
        first = next(iter(start), None)
        if first and rng.random() < 0.5:
            start[f"{first}_dot"] = "0.5 rad/s" if m.is_angle(first) else "10 mm/s"
        one = {
            "start": start,
            "time": rng.choice([{"from": 0, "to": 0.2, "count": 5}, {"values": [0, 0.05, 0.2]}]),
        }
        if first and rng.random() < 0.4:
            one["efforts"] = {
                first: rng.choice(["3 N*m", "2 N*m - 0.1 N*m*s/rad*" + first + "_dot"])
                if m.is_angle(first)
                else rng.choice(["5 N", f"5 N - 0.1 N/mm*{first}"])
            }
        if first and rng.random() < 0.3:
            one["stop"] = [
                rng.choice(
                    [
                        {"value": first, "at": 5},
                        {"dead_centre": first},
                        {"value": "time - 0.1 s", "direction": "up"},
                    ]
                )
            ]
        if len(start) > 1 and rng.random() < 0.3:
            driven = [c for c in start if not c.endswith("_dot")][-1]
            if driven != first:
                del start[driven]
                one["driven"] = {
                    driven: rng.choice([{"at": 0}, {"law": "harmonic", "from": 0, "to": 5}])
                }
        if rng.random() < 0.2:
            one["fixed_step"] = "5 ms"
        elif rng.random() < 0.2:
            one["tolerance"] = 1e-8
        made[name] = one
    m.data["responses"] = made
    m.responses = list(made)


def loads(m):
    rng = m.rng
    found = []
    vec = 2 if m.plane else 3
    names = list(m.joints)
    turning = [n for n in names if m.joints[n]["type"] in ("R", "C")]
    sliding = [n for n in names if m.joints[n]["type"] in ("P", "C")]
    first = (m.inputs or [None])[0]
    if rng.random() < 0.5:
        found.append({"type": "gravity", "g": rng.choice(["standard", [0] * (vec - 1) + [-9810]])})
    for _ in range(rng.choice([0, 0, 1, 1, 2, 3])):
        form = rng.randrange(9)
        if form == 0 and m.links:
            force = [round(rng.uniform(-20, 20), 1) for _ in range(vec)]
            if rng.random() < 0.4 and first:
                force[0] = (
                    f"5 N*{'sin' if rng.random() < 0.5 else 'cos'}({first})"
                    if m.is_angle(first)
                    else f"0.3 N/mm*{first}"
                )
            found.append(
                {
                    "type": "force",
                    "link": rng.choice(list(m.links)),
                    "point": m.vector(m.scale),
                    "force": force,
                }
            )
            if rng.random() < 0.3:
                found[-1]["axes"] = "link"
        elif form == 1 and m.links:
            found.append(
                {
                    "type": "torque",
                    "link": rng.choice(list(m.links)),
                    "torque": 120 if m.plane else m.vector(300),
                }
            )
        elif form == 2 and turning:
            n = rng.choice(turning)
            value = rng.choice(
                [
                    10,
                    "2 N*m",
                    f"1 N*m*sin(2*{n}.theta)",
                    f"3 N*m - 0.1 N*m*s/rad*{n}.theta_dot",
                    f"if({n}.theta > 5 deg, 2 N*m, 1 N*m)",
                ]
            )
            if rng.random() < 0.2:
                m.files["load.csv"] = "x,y\n" + "".join(
                    f"{x},{round(0.01 * x * x, 3)}\n" for x in range(-400, 401, 100)
                )
                value = {"table": "load.csv"}
                if rng.random() < 0.5:
                    value["interpolation"] = rng.choice(["linear", "monotone", "spline"])
            found.append({"type": "torque", "joint": n, "value": value})
        elif form == 3 and sliding:
            n = rng.choice(sliding)
            value = rng.choice([10, "20 N", f"20 N - 0.5 N/mm*{n}.s", "5 N*sign(" + n + ".s_dot)"])
            if getattr(m, "timed", False) and rng.random() < 0.3:
                value = "10 N*time/(1 s)"
            found.append({"type": "force", "joint": n, "value": value})
        elif form == 4 and len(m.points) > 1:
            a, b = rng.sample(list(m.points), 2)
            stiff = "k" if "k" in m.parameters else "0.5 N/mm"
            found.append({"type": "spring", "between": [a, b], "stiffness": stiff, "free": "50 mm"})
        elif form == 5 and len(m.points) > 1:
            a, b = rng.sample(list(m.points), 2)
            found.append({"type": "damper", "between": [a, b], "damping": "0.2 N*s/mm"})
        elif form == 6 and turning:
            found.append(
                {
                    "type": "spring",
                    "joint": rng.choice(turning),
                    "coordinate": "theta",
                    "stiffness": "3 N*m/rad",
                    "free": 10,
                    "preload": "0.1 N*m",
                }
            )
        elif form == 7 and sliding:
            found.append(
                {
                    "type": "damper",
                    "joint": rng.choice(sliding),
                    "coordinate": "s",
                    "damping": "0.2 N*s/mm",
                }
            )
        elif form == 8:
            n = rng.choice(names)
            kind = m.joints[n]["type"]
            if kind in ("R", "P", "C", "H", "S", "Sp", "Sg", "Ps"):
                one = {
                    "type": "friction",
                    "joint": n,
                    "coefficient": rng.choice(
                        [0.1, 0.05, {"static": 0.15, "sliding": 0.1, "speed": "5 mm/s"}]
                    ),
                }
                if kind in ("R", "C", "H", "S"):
                    one["radius"] = "4 mm"
                if kind in ("R", "C") and not m.plane and rng.random() < 0.4:
                    one["length"] = "60 mm"
                found.append(one)
    for one in found:
        if m.responses and rng.random() < 0.15:
            one["runs"] = [rng.choice(["sweep", *m.responses])]
    if found:
        m.data["loads"] = found
    if rng.random() < 0.15 and not m.plane:
        m.data["idle"] = "hold"


def expressions(m):
    """Quantities and expressions that a column may have."""
    rng = m.rng
    found = list(m.coordinates())
    found += [f"{c}_dot" for c in found] + [f"{c}_ddot" for c in found[:2]]
    for name, one in m.joints.items():
        found += [
            f"norm({name}.force)",
            f"{name}.force.x",
            f"{name}.point.y" if one["type"] != "W" else "pi",
        ]
        if one["type"] in ("R", "P", "C", "H"):
            found += [f"{name}.radial_force"]
        if one["type"] == "S":
            found += [f"{name}.q0", f"norm({name}.turn)" if rng.random() < 0.5 else f"{name}.q3"]
    for p in m.points:
        found += [f"{p}.position.x", f"norm({p}.velocity)", f"{p}.acceleration.y"]
    for k in list(m.links)[:2]:
        found += [f"{k}.omega" if m.plane else f"norm({k}.omega)", f"{k}.finite_angle"]
    for c in m.inputs:
        found += [f"{c}.effort", f"{c}.reduced_inertia"]
    found += [
        "row.condition",
        "row.residual",
        "row.kinetic_energy",
        "row.potential_energy",
        "row.power_error",
        "row.status",
        "row.mode",
    ]
    found += ["row.error_bound", "norm(ground.shaking_force)", *m.named]
    if getattr(m, "timed", False):
        found += ["time", "row.work", "row.energy_error"]
    others = [c for c in m.coordinates() if c not in m.inputs]
    if m.inputs and others:
        c = rng.choice(others)
        found += [
            f"derivative({c}, {m.inputs[0]})",
            f"{c}_ddot.per_acceleration",
            f"{c}_ddot.without_acceleration",
        ]
        if rng.random() < 0.5:
            found += [
                f"{c}.mechanical_advantage",
                f"{c}.dynamic_transmission_angle",
                f"{c}.transmission_angle",
            ]
    return found


def tables(m):
    rng = m.rng
    if rng.random() < 0.2 and m.coordinates():
        c = rng.choice(m.coordinates())
        m.data["quantities"] = {"g1": rng.choice([f"2*{c}", f"{c}_dot^2", f"max({c}, 2*{c})"])}
        if rng.random() < 0.5:
            m.data["quantities"]["g2"] = "g1*3"
        m.named = list(m.data["quantities"])
    pool = expressions(m)
    if rng.random() < 0.75:
        made = []
        for i in range(rng.choice([1, 1, 2, 3])):
            columns = []
            calm = [t for t in pool if "transmission" not in t and "advantage" not in t]
            for text in (lambda p: rng.sample(p, min(len(p), rng.randint(2, 7))))(
                pool if rng.random() < 0.3 else calm
            ):
                one = text
                if rng.random() < 0.6 or "(" in text:
                    one = {"label": f"c{len(columns)} {text}"[:30], "value": text}
                    if rng.random() < 0.4 and text not in ("row.status", "row.mode"):
                        one["decimals"] = rng.randint(0, 9)
                columns.append(one)
            table = {"name": f"table_{i + 1}", "columns": columns}
            if rng.random() < 0.3:
                table["title"] = "A table | of *things*"
            if rng.random() < 0.3:
                table["summary"] = rng.sample(
                    ["max", "min", "peak", "mean", "rms", "range"], rng.randint(1, 6)
                )
            if m.responses and rng.random() < 0.7:
                table["run"] = rng.choice(["sweep", *m.responses])
            made.append(table)
        m.data["tables"] = made
    turn = (
        m.inputs
        and m.is_angle(m.inputs[0])
        and m.data.get("motion", {}).get("inputs", {}).get(m.inputs[0], {})
    )
    if (
        rng.random() < (0.5 if turn and turn.get("to", 0) - turn.get("from", 0) == 360 else 0.02)
        and m.inputs
    ):
        made = [{"type": "work", "name": "work"}]
        if rng.random() < 0.5:
            made.append({"type": "harmonics", "name": "harm", "of": [rng.choice(m.coordinates())]})
        if rng.random() < 0.5:
            made.append({"type": "flywheel", "name": "fly", "unevenness": 0.02})
        m.data["balances"] = made
    if rng.random() < 0.06 and not m.plane:
        m.data["coefficients"] = [{"name": "dense", "row": 1}]
    if rng.random() < 0.1:
        m.data["view"] = {"speed": "4 s", "forces": rng.choice(["shown", "hidden"])}
        if m.links:
            m.data["view"]["hidden"] = [rng.choice(list(m.links))]


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


# ---------------------------------------------------------------- questions

HEAVY = {
    "fit": 0.15,
    "tolerances": 0.4,
    "study": 0.6,
    "view": 0.8,
    "sensitivities": 0.7,
    "errors": 0.8,
    "certify": 0.8,
    "ranges": 1,
    "modes": 1.5,
}


def another(rng, value):
    """A value near that of a parameter, as a setting."""
    text = str(value)
    number = "".join(c for c in text if c in "0123456789.-eE+").strip()
    try:
        number = float(number)
    except ValueError:
        return rng.choice([1, "2 mm"])
    unit = text.lstrip("0123456789.-+ ") if isinstance(value, str) else ""
    new = round(
        number * rng.choice([1.0, 1.001, 1.01, 0.98, 1.1, 0.5]) + rng.choice([0, 0, 0.01]), 5
    )
    if rng.random() < 0.03:
        return rng.choice(["1e9 m", "nan", "3 kg", "x", 0])
    return f"{new} {unit}".strip() if rng.random() < 0.6 and unit else new


def via(rng, info):
    """How the model asked comes from the one loaded."""
    steps = []
    for _ in range(rng.choices([0, 1, 2, 3], [6, 3, 1.5, 0.7])[0]):
        form = rng.random()
        if form < 0.6 and info["parameters"]:
            name = rng.choice(list(info["parameters"]))
            steps.append(["with", {name: another(rng, info["parameters"][name])}])
        else:
            steps.append([rng.choice(["pickle", "copy", "deepcopy"])])
    return steps


def named(rng, info, most, solved=False):
    """Names of quantities alone, as `analyze`, `respond` and `solve` take them."""
    plain_names = [t for t in info["expressions"] if not set(t) & set("()*+ ^,")]
    plain_names = [t.rsplit(".", 1)[0] if t[-2:] in (".x", ".y", ".z") else t for t in plain_names]
    if solved and rng.random() < 0.95:
        plain_names = [
            t
            for t in plain_names
            if not t.startswith("row.")
            and "transmission" not in t
            and "advantage" not in t
            and "per" not in t
        ]
    return rng.sample(plain_names, min(len(plain_names), rng.randint(1, most)))


def question(rng, info, words=None):
    some = lambda least, most: rng.sample(
        info["expressions"], min(len(info["expressions"]), rng.randint(least, most))
    )
    words = words or {
        "analyze": 5, "read": 6, "respond": 3 if info["responses"] else 0.1, "modes": 1, "ranges": 0.8, "mobility": 1, "solve": 3, "vary": 3 if info["parameters"] else 0.1,
        "errors": 1, "certify": 1, "sensitivities": 1 if info["parameters"] else 0.05, "tolerances": 0.4 if info["parameters"] else 0.03,
        "study": 0.4 if info["parameters"] else 0.03, "fit": 0.12 if info["parameters"] else 0.01, "view": 0.4, "listing": 1, "picture": 0.5,
        "given": 0.6,
    }  # fmt: skip
    word = rng.choices(list(words), list(words.values()))[0]
    q = {"ask": word, "via": via(rng, info)}
    mode = rng.choices([None, "A", "B", "C", "Z"], [8, 2, 1, 0.5, 0.2])[0]
    response = (
        rng.choice(info["responses"])
        if info["responses"] and rng.random() < 0.97
        else rng.choice([None, "fall"])
    )
    knobs = {"lanes": rng.choice([0, 0, 2, 4]), "threads": rng.choice([0, 1, 2])}
    if word in ("analyze", "errors", "certify", "read"):
        q |= {"mode": mode, "knobs": knobs}
        if rng.random() < 0.12:
            q["closed_at"] = rng.sample(
                info["joints"], min(len(info["joints"]), rng.choice([1, 1, 2]))
            )
    if word == "analyze":
        q["quantities"] = rng.choice([None, named(rng, info, 4), named(rng, info, 8)])
        q["tables"] = rng.choice(
            [None, None, [], info["tables"][:1], ["nosuch"] if rng.random() < 0.1 else None]
        )
    if word == "read":
        q["quantities"] = some(1, 6)
        q["run"] = response if info["responses"] and rng.random() < 0.2 else None
    if word == "respond":
        q |= {
            "run": response,
            "mode": mode,
            "quantities": rng.choice([None, named(rng, info, 3)]),
            "knobs": knobs,
        }
    if word == "modes":
        q |= {
            "run": response if rng.random() < 0.2 and info["responses"] else None,
            "certify": rng.random() < 0.3,
        }
        q["at"] = rng.choice(
            [None, None, 10, "0.3 rad", {info["inputs"][0]: 20} if info["inputs"] else 3]
        )
    if word == "ranges":
        q |= {
            "input": rng.choice([None, *info["inputs"]]),
            "outputs": rng.sample(
                info["coordinates"], min(len(info["coordinates"]), rng.choice([0, 0, 1]))
            ),
        }
    if word == "solve":
        q["inputs"] = {
            c: rng.choice([1, 5, 12.5, "0.2 rad", "3 mm"])
            for c in info["inputs"]
            if rng.random() < 0.8
        }
        q["quantities"] = rng.choice([None, named(rng, info, 4, True)])
    if word == "vary":
        names = rng.sample(
            list(info["parameters"]), min(len(info["parameters"]), rng.choice([1, 1, 2]))
        )
        size = rng.choice([1, 2, 5])
        q |= {
            "parameters": {
                n: [another(rng, info["parameters"][n]) for _ in range(size)] for n in names
            },
            "quantities": rng.choice([None, some(1, 3)]),
        }
        q |= {
            "reduce": rng.choice([None, None, "peak", ["max", "mean"], ["rms", "range"]]),
            "knobs": knobs,
        }
        q["run"] = response if info["responses"] and rng.random() < 0.2 else "sweep"
    if word == "sensitivities":
        q |= {
            "quantities": some(1, 2),
            "parameters": list(info["parameters"])[:1] or None,
            "at": rng.choice([None, None, 0]),
        }
    if word == "tolerances":
        q |= {
            "tolerances": {n: rng.choice([0.01, "0.02 mm"]) for n in list(info["parameters"])[:2]},
            "quantities": some(1, 2),
            "samples": 8,
        }
    if word == "study":
        n = next(iter(info["parameters"]), "r")
        value = info["parameters"].get(n, 1)
        q["study"] = {
            "vary": {
                n: rng.choice([[another(rng, value) for _ in range(3)], {"tolerance": "0.5 mm"}])
            },
            "keep": [
                {"of": t, "as": rng.choice(["max", ["peak", "rms"], "place_of_max"])}
                for t in some(1, 2)
            ],
        }
        if isinstance(q["study"]["vary"][n], dict):
            q["study"]["sample"] = {"count": 5, "seed": rng.randint(0, 3)}
        if rng.random() < 0.3:
            q["study"]["dead_centres"] = "place"
    if word == "fit":
        n = next(iter(info["parameters"]), "r")
        try:
            base = float(
                "".join(c for c in str(info["parameters"].get(n, 1)) if c in "0123456789.-")
            )
        except ValueError:
            base = 1.0
        c = rng.choice(info["coordinates"]) if info["coordinates"] else "A.theta"
        q |= {
            "targets": rng.choice([{"of": c, "least": "peak"}, {"of": c, "least": "rms"}]),
            "bounds": {n: [base - 2, base + 2]},
        }
    if word == "view":
        q |= {"run": None, "modes": rng.random() < 0.5}
    if word == "picture":
        q["y"] = some(1, 2)
    return q


# ---------------------------------------------------------------- answers, as plain lines


def plain(value, depth=0):
    """An answer as text: every bit of every number, and no object's address."""
    if value is None or (isinstance(value, (bool, int, str)) and not isinstance(value, Enum)):
        return repr(value)
    if isinstance(value, Enum):
        return f"<{value.name}>"
    if isinstance(value, (float, np.floating)):
        return float(value).hex() if value == value else "nan"
    if isinstance(value, np.integer):
        return repr(int(value))
    if isinstance(value, np.bool_):
        return repr(bool(value))
    if isinstance(value, np.ndarray):
        if value.dtype.kind == "f":
            whole = ",".join(
                "nan" if x != x else x.hex() for x in value.ravel().astype(float).tolist()
            )
        else:
            whole = repr(value.tolist())
        return f"array{value.dtype.str}{value.shape}[{whole}]"
    if depth > 8:
        return "..."
    if hasattr(value, "record") and hasattr(value, "severity"):  # a diagnostic
        names = (
            "code",
            "count",
            "hint",
            "index",
            "limit",
            "measured",
            "message",
            "numbers",
            "place",
            "severity",
        )
        return (
            "{"
            + ", ".join(f"{n}={plain(getattr(value, n), depth + 1)}" for n in names)
            + plain(value.record(), depth + 1)
            + "}"
        )
    if isinstance(value, Mapping):
        return (
            "{"
            + ", ".join(f"{plain(k, depth + 1)}: {plain(v, depth + 1)}" for k, v in value.items())
            + "}"
        )
    if hasattr(value, "_fields"):
        return (
            "("
            + ", ".join(f"{n}={plain(getattr(value, n), depth + 1)}" for n in value._fields)
            + ")"
        )
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(plain(v, depth + 1) for v in value) + "]"
    if isinstance(value, (set, frozenset)):
        return "set" + plain(sorted(value), depth + 1)
    if isinstance(value, Path):
        return f"path {value.name}"
    if hasattr(value, "__dataclass_fields__"):
        return (
            "("
            + ", ".join(
                f"{n}={plain(getattr(value, n), depth + 1)}" for n in value.__dataclass_fields__
            )
            + ")"
        )
    return f"?{type(value).__name__}"


def tried(call):
    """What a call gives, or what it raises, as text."""
    try:
        return plain(call())
    except Exception as error:
        found = f"!{type(error).__name__}: {error}"
        for name in ("diagnostics", "offset", "hint"):
            if hasattr(error, name):
                found += f" {name}={plain(getattr(error, name))}"
        return found


def told(lines, name, call):
    lines.append(f"{name} = {tried(call)}")


def tell(lines, thing, *names):
    for name in names:
        told(lines, name, lambda name=name: getattr(thing, name))


def of_table(table):
    return {
        "name": table.name, "title": table.title,
        "columns": [{n: getattr(c, n) for n in ("label", "unit", "values")} for c in table.columns], "summary": table.summary,
    }  # fmt: skip


def analysis_lines(r, quantities=()):
    lines = []
    tell(lines, r, "run", "rows", "complete", "diagnostics", "balances")
    told(lines, "keys", r.keys)
    told(lines, "len", lambda: (len(r), list(r)))
    told(lines, "tables", lambda: [of_table(t) for t in r.tables])
    told(lines, "table names", lambda: list(r.tables.keys()))
    told(lines, "coefficients", lambda: [of_table(t) for t in r.coefficients])
    told(lines, "balance_tables", lambda: [of_table(t) for t in r.balance_tables])
    told(lines, "summary", r.summary)
    told(lines, "status", lambda: r["row.status"])
    for q in quantities or ():
        told(lines, q, lambda q=q: r[q])
        told(lines, f"unit {q}", lambda q=q: r.unit(q))
    told(lines, "repr", lambda: repr(r))
    return lines


def ask_analyze(m, q, knobs):
    r = m.analyze(q["quantities"], tables=q["tables"], mode=q["mode"], **closed(q), **knobs)
    return analysis_lines(r, q["quantities"])


def closed(q):
    return {"closed_at": q["closed_at"]} if "closed_at" in q else {}


def ask_read(m, q, knobs, kept=None):
    """Values of a run; the shared side reads them from a run that is kept."""
    key = repr((q["mode"], q.get("closed_at"), q["run"]))
    if kept is not None and key in kept:
        r = kept[key]
    elif q["run"]:
        r = m.respond(q["run"], mode=q["mode"], **knobs)
    else:
        r = m.analyze(mode=q["mode"], **closed(q), **knobs)
    if kept is not None:
        kept[key] = r
    lines = []
    for one in q["quantities"]:
        told(lines, one, lambda one=one: r[one])
        told(lines, f"unit {one}", lambda one=one: r.unit(one))
        told(lines, f"peak {one}", lambda one=one: r.peak(one))
        told(lines, f"in {one}", lambda one=one: one in r)
    tell(lines, r, "rows", "complete", "diagnostics")
    return lines


def ask_respond(m, q, knobs):
    return analysis_lines(
        m.respond(q["run"], q["quantities"], mode=q["mode"], **knobs), q["quantities"]
    )


def ask_modes(m, q, knobs):
    found, lines = m.modes(q["at"], run=q["run"], certify=q["certify"]), []
    tell(
        lines,
        found,
        "bound",
        "chance",
        "closed",
        "complete",
        "confidence",
        "diagnostics",
        "inputs",
        "modes",
        "picked",
        "proofs",
        "sentence",
        "starts",
        "turns",
    )
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_ranges(m, q, knobs):
    found, lines = m.ranges(q["input"], q["outputs"]), []
    tell(lines, found, "at", "circuits", "diagnostics", "input", "ranges", "unit")
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_mobility(m, q, knobs):
    found, lines = m.mobility(), []
    names = "configurations count diagnostics dimensions first_order fixed idle inputs loops mobility name redundant useful verdict"
    tell(lines, found, *names.split())
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_solve(m, q, knobs):
    found = m.solve(q["inputs"], q["quantities"])
    return [f"{k} = {plain(v)}" for k, v in found.items()] + [f"status = {plain(found.status)}"]


def ask_vary(m, q, knobs):
    found, lines = m.vary(q["parameters"], q["quantities"], q["reduce"], run=q["run"], **knobs), []
    tell(lines, found, "codes", "complete", "errors", "parameters", "status")
    told(
        lines,
        "values",
        lambda: {k: found[k] for k in (q["quantities"] or sorted(m.quantities)[:5])},
    )
    return lines


def ask_errors(m, q, knobs):
    r = m.analyze(mode=q["mode"], **closed(q), **knobs)
    found, lines = r.errors, []
    tell(lines, found, "digits", "why", "states")
    told(
        lines,
        "columns",
        lambda: [
            {
                n: getattr(c, n)
                for n in (
                    "table",
                    "label",
                    "unit",
                    "values",
                    "error",
                    "relative",
                    "digits",
                    "is_bound",
                    "largest",
                    "lost",
                    "lost_why",
                    "worst",
                    "why",
                )
            }
            for c in found.columns
        ],
    )
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_certify(m, q, knobs):
    found, lines = m.certify(mode=q["mode"], **closed(q), **knobs), []
    tell(lines, found, "closure", "diagnostics", "is_one_branch", "status", "tubes", "words")
    told(lines, "dead_centres", lambda: len(found.dead_centres))
    for c in sorted(k for k in m.quantities if k.endswith((".theta", ".s", ".effort")))[:3]:
        told(lines, f"enclosure {c}", lambda c=c: found.enclosure(c))
        told(lines, f"not enclosed {c}", lambda c=c: found.not_enclosed(c))
    return lines


def ask_sensitivities(m, q, knobs):
    s, lines = m.sensitivities(q["quantities"], q["parameters"], q["at"]), []
    tell(lines, s, "along", "along_unit", "parameters", "place", "quantities", "rows", "texts")
    for a in q["quantities"]:
        told(lines, f"value {a}", lambda a=a: s.value(a))
        for b in s.parameters:
            told(
                lines,
                f"{a} {b}",
                lambda a=a, b=b: (
                    s[a, b],
                    s.unit(a, b),
                    s.curvature(a, b),
                    s.reach(a, b),
                    s.verdict(a, b),
                    s.why(a, b),
                ),
            )
    derived = s.model
    told(lines, "model", lambda: derived.analyze()["row.status"])
    told(lines, "repr", lambda: repr(s))
    return lines


def ask_tolerances(m, q, knobs):
    t, lines = m.tolerances(q["tolerances"], q["quantities"], samples=q["samples"]), []
    tell(lines, t, "bands", "samples")
    for a in q["quantities"]:
        for name in (
            "drawn",
            "left_out",
            "lost_ends",
            "misleads",
            "nominal",
            "root_sum_square",
            "sampled",
            "scatter",
            "shares",
            "worst",
        ):
            told(lines, f"{name} {a}", lambda a=a, name=name: getattr(t, name)(a))
    told(lines, "repr", lambda: repr(t))
    return lines


def ask_study(m, q, knobs):
    found, lines = m.study(q["study"]), []
    tell(lines, found, "diagnostics", "overview", "rows")
    told(lines, "columns", lambda: {k: found[k] for k in found.to_pandas().columns})
    return lines


def ask_fit(m, q, knobs):
    f, lines = (
        m.fit(q["targets"], {k: tuple(v) for k, v in q["bounds"].items()}, starts=1, generations=2),
        [],
    )
    tell(
        lines,
        f,
        "at_bounds",
        "constraints",
        "cost",
        "costs",
        "evaluations",
        "exact_taken",
        "parameters",
        "reason",
        "rows_not_ok",
        "slopes",
        "status",
        "targets",
        "units",
        "yaml",
    )
    told(lines, "model", lambda: analysis_lines(f.model.analyze()))
    return lines


def ask_view(m, q, knobs):
    with tempfile.TemporaryDirectory() as folder:
        page = m.view(Path(folder) / "page.html", run=q["run"], modes=q["modes"])
        return ["page = " + page.read_text(encoding="utf-8")]


def ask_listing(m, q, knobs):
    lines = []
    tell(lines, m, "name", "source", "runs", "diagnostics")
    told(lines, "quantities", lambda: m.quantities)
    told(lines, "tables", lambda: [t.name for t in m.tables])
    told(lines, "repr", lambda: repr(m))
    told(lines, "html", lambda: m._repr_html_())
    return lines


def ask_picture(m, q, knobs):
    r = m.analyze()
    return ["picture = " + tried(lambda: r.picture(q["y"]))]


def ask_given(m, q, knobs):
    """Objects that came from elsewhere: an analysis through a pickle, the model of an analysis."""
    r = pickle.loads(pickle.dumps(m.analyze()))
    lines = analysis_lines(r)
    told(lines, "again", lambda: analysis_lines(r.model.analyze()))
    return lines


ASK = {name[4:]: call for name, call in globals().items() if name.startswith("ask_")}


def reached(model, steps):
    for step in steps:
        if step[0] == "with":
            model = model.with_parameters(step[1])
        elif step[0] == "pickle":
            model = pickle.loads(pickle.dumps(model))
        else:
            model = getattr(copy, step[0])(model)
    return model


def loaded(info, folder):
    import mechkin_cli as mk

    return mk.loads(info["text"], "m.yaml", folder=folder)


def answer(model, q, kept=None, knobs=None):
    """Lines of the answer of a model to a question."""
    lines = []

    def call():
        made = reached(model, q["via"]) if kept is None else kept.model(model, q["via"])
        runs = None if kept is None else kept.runs(q["via"])
        given = q.get("knobs", {}) if knobs is None else knobs
        if q["ask"] == "read":
            lines.extend(ask_read(made, q, given, runs))
        else:
            lines.extend(ASK[q["ask"]](made, q, given))

    told(lines, "answer", call)
    return lines


class Kept:
    """The shared model's derived models and runs, by the way they came about; some are made anew."""

    def __init__(self, rng):
        self.rng, self.models, self.all_runs = rng, {}, {}

    def model(self, model, steps):
        key = ""
        for step in steps:
            key += json.dumps(step)
            if key not in self.models or self.rng.random() < 0.15:
                self.models[key] = reached(model, [step])
                self.all_runs.pop(key, None)
            model = self.models[key]
        return model

    def runs(self, steps):
        return self.all_runs.setdefault("".join(json.dumps(s) for s in steps), {})


# ---------------------------------------------------------------- one model in random order against fresh ones


def written_out(info, folder):
    for name, text in info["files"].items():
        path = Path(folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def spoilt(number):
    """Leaves this number in memory that is free: what reads memory before it is written then shows it."""
    for size in range(1, 400):
        np.full(size, number)


def differences(seed, most=14, spoil=False):
    """Questions whose answer depends on what was asked before: (question, history, shared, fresh)."""
    rng = random.Random(seed)
    info = mechanism(seed, faults=0.05)
    found, asked = [], 0
    with tempfile.TemporaryDirectory() as folder:
        written_out(info, folder)
        try:
            shared = loaded(info, folder)
        except Exception:
            return found, asked, info
        pool = [question(rng, info) for _ in range(most)]
        steps = []
        while pool or rng.random() < 0.7:
            if pool:
                step = [pool.pop() for _ in range(min(len(pool), rng.choice([1, 1, 1, 3])))]
            else:
                step = [rng.choice(rng.choice(steps))]
            steps.append(step * 3 if len(step) == 1 and rng.random() < 0.15 else step)
        rng.shuffle(steps)
        questions = [q for step in steps for q in step]
        kept, history, answers = Kept(rng), [], []
        for step in steps:
            if spoil:
                spoilt(rng.choice([np.nan, np.inf, 1e300, -7.5]))
            if len(step) > 1:
                with ThreadPoolExecutor(len(step)) as pool:
                    answers += pool.map(lambda q: answer(shared, q, kept), step)
            else:
                answers.append(answer(shared, step[0], kept))
            history += [{**q, "together": len(step)} for q in step]
        fresh = {}
        for i, q in enumerate(questions):
            key = json.dumps({k: v for k, v in q.items() if k != "knobs"})
            if key not in fresh:
                if spoil:
                    spoilt(0.0)
                plainest = {} if "knobs" in q else None
                fresh[key] = answer(loaded(info, folder), q, knobs=plainest)
            asked += 1
            if answers[i] != fresh[key]:
                found.append((q, history[: i + 1], answers[i], fresh[key]))
    return found, asked, info


def shortest(one, other, width=600):
    for a, b in zip(one, other):
        if a != b:
            at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
            at = max(0, at - 80)
            return f"{a[:60]}\n   ...{a[at : at + width]}\n   ...{b[at : at + width]}"
    return f"{len(one)} and {len(other)} lines"


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    faults = questions = 0
    for i in range(seed, seed + count):
        found, asked, _ = differences(i, spoil="spoil" in sys.argv)
        questions += asked
        if (i - seed) % 5 == 4:
            print(f"{i - seed + 1} mechanisms, {questions} questions", file=sys.stderr, flush=True)
        for q, history, shared, fresh in found:
            faults += 1
            print(f"seed {i}: {json.dumps(q)}\n   {shortest(shared, fresh)}", flush=True)
    print(
        f"{count} mechanisms, {questions} questions, {faults} answers that depend on what was asked before"
    )
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
