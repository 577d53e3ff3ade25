"""A sweep by a script with CasADi: the closure as symbols, its derivatives by the library, all rows
by its Newton root finder, interpreted: its C code takes seconds to compile. Tables as `sweep.py`.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

try:
    import casadi as ca
    import numpy as np
except ImportError as error:
    sys.exit(f"left out: {error.name} is not installed (pip install casadi)")

import json

from sweep import CLOSED, read, write


def main():
    source, folder, *other = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        problem = json.load(file)
    write(folder, problem, rows_of(problem), other)


def rows_of(problem):
    count, driven = len(problem["joints"]), problem["driven"]
    unknown = [k for k in range(count) if k not in driven]
    x, p = ca.SX.sym("x", len(unknown)), ca.SX.sym("p", len(problem["rows"][0]))
    q = ca.SX.zeros(count)
    for own, number in enumerate(unknown):
        q[number] = x[own]
    for own, number in enumerate(driven):
        q[number] = p[own]
    spots = ca.vertcat(*placed(problem, q))
    gap = closure(problem, spots, p[len(driven) :])
    both, outer = ca.vertcat(x, p), ca.SX.sym("outer", p.numel())
    inner, bend = ca.SX.sym("inner", x.numel()), ca.SX.sym("bend", p.numel())
    columns = ca.jacobian(gap, x)
    moving = ca.vertcat(inner, outer)
    drift = ca.jtimes(ca.jtimes(gap, both, moving), both, moving) + ca.jtimes(gap, p, bend)
    first = ca.Function("first", [x, p, outer], [ca.solve(columns, -ca.jtimes(gap, p, outer))])
    second = ca.Function("second", [x, p, inner, outer, bend], [ca.solve(columns, -drift)])
    told, rest = ca.SX.sym("told", count), ca.SX.sym("rest", count)
    own = ca.SX.sym("q", count)
    there = ca.vertcat(*placed(problem, own))
    speed = ca.jtimes(there, own, told)
    turn = ca.jtimes(speed, own, told) + ca.jtimes(there, own, rest)
    places = ca.Function("places", [own, told, rest], [there, speed, turn])
    finder = ca.rootfinder("finder", "newton", {"x": x, "p": p, "g": gap}, {"abstol": CLOSED})
    rows = len(problem["rows"])
    given, rates, bends = (np.array(problem[k]).T for k in ("rows", "rates", "accelerations"))
    found = finder.mapaccum("sweep", rows)(np.array(problem["start"])[unknown], given)
    slopes = first.map(rows)(found, given, rates)
    curves = second.map(rows)(found, given, slopes, rates, bends)
    orders = []
    for own_part, driven_part in ((found, given), (slopes, rates), (curves, bends)):
        full = np.zeros((count, rows))
        full[unknown], full[driven] = np.array(own_part), driven_part[: len(driven)]
        orders.append(full)
    points = [np.array(part) for part in places.map(rows)(*orders)]
    shaped = [part.reshape(-1, 3, rows) for part in points]
    return [
        read(problem, [part[:, k] for part in orders], [part[:, :, k] for part in shaped])
        for k in range(rows)
    ]


def placed(problem, q):
    """Places of the spots: each joint turns or slides what it carries about its drawn axis."""
    frames = []
    for number, joint in enumerate(problem["joints"]):
        before = ca.SX.eye(4) if joint["parent"] < 0 else frames[joint["parent"]]
        frames.append(before @ displacement(joint, q[number]))
    found = []
    for spot in problem["spots"]:
        frame = ca.SX.eye(4) if spot["joint"] < 0 else frames[spot["joint"]]
        found.append((frame @ ca.vertcat(*spot["place"], 1))[:3])
    return found


def displacement(joint, q):
    axis, point = np.array(joint["axis"], float), np.array(joint["point"], float)
    axis = axis / np.linalg.norm(axis)
    found = ca.SX.eye(4)
    if joint["kind"] == "P":
        found[:3, 3] = q * axis
        return found
    cross = np.cross(np.eye(3), axis)
    turned = ca.SX.eye(3) + ca.sin(q) * cross + (1 - ca.cos(q)) * (cross @ cross)
    found[:3, :3] = turned
    found[:3, 3] = point - turned @ point
    return found


def closure(problem, spots, lengths):
    """As many equations as unknowns: of a link held at three spots, one spot and two directions."""
    gaps = []
    for number, (one, other) in enumerate(problem["pairs"]):
        off = spots[3 * one : 3 * one + 3] - spots[3 * other : 3 * other + 3]
        gaps += [off[k] for k in problem["kept"][number]]
    for number, (one, other) in enumerate(problem["lengths"]):
        span = spots[3 * other : 3 * other + 3] - spots[3 * one : 3 * one + 3]
        gaps.append(ca.norm_2(span) - lengths[number])
    return ca.vertcat(*gaps)


if __name__ == "__main__":
    main()
