"""Random loops with one to three groups of joints that leave something idle, two spheres, a plane
and a hinge across it and the like: all other coordinates, rates and efforts against a
pseudo-inverse. `MECHKIN_RANDOM` multiplies the number of loops.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from random_families.screw_loops import (
    Array,
    Joint,
    Motion,
    closed,
    determined,
    jacobian,
)

import mechkin_cli as mk

COUNT = 25 * int(os.environ.get("MECHKIN_RANDOM", "1"))
ROWS, STEPS = 13, 2
"""Rows, and steps of two degrees from row to row."""
LOAD = 7.0
SINGULAR = 0.03

Rng = np.random.Generator


def unit(rng: Rng) -> Array:
    v = rng.normal(size=3)
    return np.asarray(v / np.linalg.norm(v))


def across(rng: Rng, u: Array) -> Array:
    v = np.cross(u, unit(rng))
    return np.asarray(v / np.linalg.norm(v))


def ball(p: Array) -> list[Motion]:
    return [Motion("", u, p) for u in np.eye(3)]


def hinge(p: Array, u: Array) -> Joint:
    return Joint("R", {"point": p, "axis": u}, [Motion("theta", u, p)])


def slide(p: Array, u: Array) -> Joint:
    return Joint("P", {"point": p, "axis": u}, [Motion("s", u, p, slides=True)])


def cylinder(p: Array, u: Array) -> Joint:
    motions = [Motion("theta", u, p), Motion("s", u, p, slides=True)]
    return Joint("C", {"point": p, "axis": u}, motions)


def screw(p: Array, u: Array, lead: float) -> Joint:
    motion = Motion("theta", u, p, advance=lead / (2 * np.pi))
    return Joint("H", {"point": p, "axis": u, "lead": lead}, [motion])


def cardan(p: Array, u: Array, v: Array) -> Joint:
    motions = [Motion("theta1", u, p), Motion("theta2", v, p)]
    return Joint("U", {"point": p, "axis": u, "axis2": v}, motions)


def sphere(p: Array) -> Joint:
    return Joint("S", {"point": p}, ball(p))


def plane(rng: Rng, p: Array, n: Array) -> Joint:
    x = across(rng, n)
    slides = [Motion("", u, p, slides=True) for u in (x, np.cross(n, x))]
    return Joint("E", {"point": p, "normal": n, "x": x}, [*slides, Motion("", n, p)])


def grooved(p: Array, u: Array) -> Joint:
    return Joint("Sg", {"point": p, "groove": u}, [*ball(p), Motion("", u, p, slides=True)])


def on_plane(rng: Rng, p: Array, n: Array) -> Joint:
    x = across(rng, n)
    slides = [Motion("", u, p, slides=True) for u in (x, np.cross(n, x))]
    return Joint("Sp", {"point": p, "normal": n}, [*ball(p), *slides])


def groups(rng: Rng) -> list[tuple[list[Joint], int]]:
    """Joints with something idle in common, and how many freedoms they give the loop."""
    n, p, q = unit(rng), rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3)
    d = (q - p) / np.linalg.norm(q - p)
    u = unit(rng)
    return [
        ([plane(rng, p, n), sphere(q)], 5),
        ([cylinder(p, n), sphere(p + n * rng.normal())], 4),
        ([sphere(p), sphere(q)], 5),
        ([sphere(p), hinge(p + 0.3 * (q - p), d), sphere(q)], 5),
        ([cylinder(p, n), cylinder(p + n, n)], 2),
        ([hinge(p, n), hinge(p + n, n)], 1),
        ([hinge(p, n), cylinder(p + n, n)], 2),
        ([slide(p, n), slide(q, n)], 1),
        ([cylinder(p, n), slide(q, n)], 2),
        ([plane(rng, p, n), plane(rng, q, n)], 3),
        ([plane(rng, p, n), hinge(q, n)], 3),
        ([plane(rng, p, n), slide(q, across(rng, n))], 3),
        ([plane(rng, p, n), cylinder(q, n)], 4),
        ([hinge(p, n), sphere(p + 0.5 * n)], 3),
        ([cardan(p, u, across(rng, u)), sphere(p)], 3),
        ([sphere(p), grooved(q, unit(rng))], 6),
        ([sphere(p), plane(rng, q, n), sphere(rng.uniform(-1, 1, 3))], 7),
        ([sphere(p), slide(q, d), sphere(q)], 6),
        ([sphere(p), cylinder(p, d), sphere(q)], 6),
        ([cylinder(p, n), plane(rng, rng.uniform(-1, 1, 3), n), sphere(q)], 6),
        ([slide(p, n), on_plane(rng, q, across(rng, n))], 5),
        ([hinge(p, n), on_plane(rng, p + 0.4 * n, unit(rng))], 5),
        ([cylinder(p, n), on_plane(rng, q, n)], 6),
        ([hinge(p, n), grooved(p + 0.3 * n, unit(rng))], 4),
        ([slide(p, n), grooved(q, n)], 4),
        ([plane(rng, p, n), on_plane(rng, q, n)], 5),
    ]


def filler(rng: Rng, most: int) -> tuple[Joint, int]:
    """Any other joint with at most so many freedoms."""
    p, u = rng.uniform(-1, 1, 3), unit(rng)
    makers: list[tuple[int, Callable[[], Joint]]] = [
        (1, lambda: hinge(p, u)),
        (1, lambda: slide(p, u)),
        (1, lambda: screw(p, u, float(rng.uniform(0.1, 1)))),
        (2, lambda: cylinder(p, u)),
        (2, lambda: cardan(p, u, across(rng, u))),
        (3, lambda: sphere(p)),
    ]
    fitting = [item for item in makers if item[0] <= most]
    count, make = fitting[rng.integers(len(fitting))]
    return make(), count


def joints_of(rng: Rng) -> list[Joint]:
    """A driven hinge, and joints with six freedoms besides what is idle."""
    need, parts = 6, []
    for _ in range(int(rng.integers(1, 4))):
        table = [item for item in groups(rng) if item[1] <= need]
        if table:
            joints, count = table[rng.integers(len(table))]
            parts.append(joints[:: rng.choice([1, -1])])
            need -= count
    while need:
        joint, count = filler(rng, need)
        parts.append([joint])
        need -= count
    order = rng.permutation(len(parts))
    joints = [hinge(rng.uniform(-1, 1, 3), unit(rng)), *(j for k in order for j in parts[k])]
    for joint in joints[1:]:
        joint.reversed = bool(rng.random() < 0.3 and joint.letter in "RPCSE")
    return joints


class Loop(NamedTuple):
    """A file, and by coordinate that the input decides its values and rates by row."""

    text: str
    values: dict[str, Array]
    rates: dict[str, Array]
    loaded: str
    shape: str


def followed(rng: Rng, joints: list[Joint]) -> Loop | None:
    """The loop over its rows; None where it is singular or decides nothing."""
    motions = [(m, -1 if j.reversed else 1) for j in joints for m in j.motions]
    names = [f"J{k}.{m.name}" if m.name else "" for k, j in enumerate(joints) for m in j.motions]
    q = np.zeros(len(motions))
    known = determined(jacobian(motions, q)[1])[2]
    columns = [k for k in sorted(known) if names[k]]
    way = float(rng.choice([-1, 1]))
    values, rates = [], []
    for row in range(ROWS * STEPS - 1):
        q[0] = way * row * np.radians(2.0)
        place = closed(motions, q)
        if place is None or not columns:
            return None
        q, lines = place
        rank, least, now = determined(lines)
        if rank < 6 or least < SINGULAR or not known <= now:
            return None
        if row % STEPS == 0:
            values.append(q)
            rates.append(-np.linalg.lstsq(lines[:, 1:], lines[:, 0], rcond=1e-9)[0])
    # a load names its joint: one coordinate of a turning and one of a sliding joint
    loadable = [names[k] for k in columns if not names[k][-1].isdigit()]
    if not loadable:
        return None
    loaded = loadable[rng.integers(len(loadable))]
    last = way * (ROWS - 1) * STEPS * np.radians(2.0)
    kind = "force" if loaded.endswith(".s") else "torque"
    name = loaded.partition(".")[0]
    links = ["ground", *(f"L{k}" for k in range(1, len(joints))), "ground"]
    text = (
        "format: 1\nname: idle\nunits: {length: m, angle: rad}\n"
        f"links: {{{', '.join(f'{link}: {{}}' for link in links[1:-1])}}}\njoints:\n"
        + "".join(j.line(f"J{k}", links[k], links[k + 1]) for k, j in enumerate(joints))
        + f"motion: {{inputs: {{J0.theta: {{from: 0, to: {float(last)!r}, count: {ROWS}, "
        f"rate: 1}}}}}}\nloads:\n  - {{type: {kind}, joint: {name}, value: {LOAD}}}\n"
    )
    table, speed = np.array(values), np.array(rates)
    return Loop(
        text,
        {names[k]: table[:, k] for k in columns},
        {names[k]: speed[:, k - 1] for k in columns},
        loaded,
        "-".join(j.letter for j in joints),
    )


def drawn(number: int) -> Loop:
    rng = np.random.default_rng(number)
    while True:
        loop = followed(rng, joints_of(rng))
        if loop is not None:
            return loop


def fault(number: int) -> str:
    """The first difference; "" if none."""
    loop = drawn(number)
    names = [*loop.values, *(f"{name}_dot" for name in loop.values), "J0.effort"]
    result = mk.loads(loop.text).analyze(names)
    where = f"{number} ({loop.shape})"
    if (result["row.status"] != "ok").any():
        return f"{where}: {result['row.status'].tolist()}"
    for name, want in loop.values.items():
        off = result[name] - want
        if not name.endswith(".s"):
            off = np.remainder(off + np.pi, 2 * np.pi) - np.pi
        if not np.abs(off).max() < 1e-8:
            return f"{where}: {name} is off by {np.abs(off).max():.2g}"
        speed = loop.rates[name]
        if not np.abs(result[f"{name}_dot"] - speed).max() < 1e-7 * (1 + np.abs(speed).max()):
            return f"{where}: {name}_dot is off"
    power = LOAD * loop.rates[loop.loaded]
    if not np.abs(result["J0.effort"] + power).max() < 1e-6 * (1 + np.abs(power).max()):
        return f"{where}: J0.effort is off with a load at {loop.loaded}"
    return ""


def test_what_is_not_idle_goes_its_own_way() -> None:
    wrong = [words for n in range(COUNT) if (words := fault(n))]
    assert not wrong, "\n".join(wrong)
