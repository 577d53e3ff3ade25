"""Loads of a loop of revolutes by one dense system for all joints and the effort.

Unknown: moment about the ground origin and force that each joint exerts on its second link, and the
effort of the first joint. Equations: balance of every moving link (six each), no moment about the
axis of any joint (one each): 43 for seven joints.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from benchmark.arithmetic import Arithmetic, extended
from benchmark.dense_forces import inertia_wrench
from benchmark.loop import Lines, LoopKinematics, lines_of, loop_kinematics
from benchmark.matrices import Matrix, Vector, cross, dot, image, rotation

from benchmarks.sevenr import GRAVITY, JOINTS, Body, Loop
from mechkin_cli.tape.double_double import eliminate


def loop_solution(loop: Loop, theta1: Any, guess: Any) -> dict[str, Any]:
    """Everything in extended precision; theta1 (rows), guess (6, rows) of theta2 ... theta7."""
    lines = lines_of(loop, extended())
    values = np.asarray(theta1, dtype=np.longdouble)
    start = [np.asarray(x, dtype=np.longdouble) for x in guess]
    k = loop_kinematics(lines, values, start, np.longdouble)
    return _named(k) | _loads(loop, lines, k, values.size, np.longdouble)


def loop_row_by_row(loop: Loop, theta1: Any, guess: Any, arithmetic: Arithmetic) -> dict[str, Any]:
    """As `loop_solution` in any arithmetic; the arrays hold its numbers as objects."""
    lines, number = lines_of(loop, arithmetic), arithmetic.number
    rows = []
    for i, value in enumerate(theta1):
        k = loop_kinematics(lines, number(value), [number(x[i]) for x in guess], object)
        motion = {name: np.array([x], dtype=object) for name, x in _named(k).items()}
        rows.append(motion | _loads(loop, lines, k, 1, object))
    return {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}


def _named(k: LoopKinematics) -> dict[str, Any]:
    found = {}
    for suffix, columns in (("", k.angles), ("_dot", k.rates), ("_ddot", k.accelerations)):
        for joint, column in zip(JOINTS[1:], columns[1:], strict=True):
            found[f"{joint}.theta{suffix}"] = column
    return found


def _loads(loop: Loop, lines: Lines, k: LoopKinematics, rows: int, dtype: Any) -> dict[str, Any]:
    """Effort and wrenches by name, arrays (rows) and (rows, 3)."""
    count = len(loop.lines)
    places = [*(motion.place for motion in k.links), None]
    axes = [_carried(axis, place) for axis, place in zip(lines.axes, places, strict=True)]
    points = [image(m, p) if m else p for m, p in zip(places, lines.points, strict=True)]
    size = 6 * count + 1
    matrix = np.zeros((rows, size, size), dtype)
    right = np.zeros((rows, size), dtype)
    for link, (body, motion) in enumerate(zip(loop.bodies, k.links, strict=True)):
        for i in range(6):
            matrix[:, 6 * link + i, 6 * link + i] = 1
            matrix[:, 6 * link + i, 6 * (link + 1) + i] = -1
        force, moment = _needed(body, lines.arithmetic, motion)
        for i, value in enumerate((*moment, *force)):
            right[:, 6 * link + i] = value
    for joint, (axis, point) in enumerate(zip(axes, points, strict=True)):
        # the moment about the point p along a is a . moment + (p x a) . force
        for i, value in enumerate((*axis, *cross(point, axis))):
            matrix[:, 6 * (count - 1) + joint, 6 * joint + i] = value
    for i in range(3):
        matrix[:, i, size - 1] = axes[0][i]
    unknown = eliminate(matrix, right).T
    found: dict[str, Any] = {f"{JOINTS[0]}.effort": unknown[size - 1]}
    for joint, name in enumerate(JOINTS):
        moment, force = (list(unknown[6 * joint + i : 6 * joint + i + 3]) for i in (0, 3))
        lever = cross(points[joint], force)
        about = [m - moved for m, moved in zip(moment, lever, strict=True)]
        found[f"{name}.force"] = np.stack(force, axis=1)
        found[f"{name}.moment"] = np.stack(about, axis=1)
    return found


def _carried(axis: Vector, place: Matrix | None) -> Vector:
    return axis if place is None else [dot(row, axis) for row in rotation(place)]


def _needed(body: Body, arithmetic: Arithmetic, motion: Any) -> tuple[Vector, Vector]:
    """Force and moment about the ground origin that a link needs from its joints."""
    number = arithmetic.number
    mass, centre = number(body.mass), [number(x) for x in body.centre]
    xx, yy, zz, xy, xz, yz = (number(x) for x in body.tensor)
    tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    force, moment = inertia_wrench(motion, mass, centre, rotation(motion.place), tensor)
    weight = [mass * number(g) for g in GRAVITY]
    lever = cross(image(motion.place, centre), weight)
    force = [x - w for x, w in zip(force, weight, strict=True)]
    return force, [x - w for x, w in zip(moment, lever, strict=True)]
