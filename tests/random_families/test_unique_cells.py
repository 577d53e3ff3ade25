"""Planar loops anywhere in space: which components of joint reactions are unique, in every row.

All unknown reactions of the joints and the driving torque stand in the 18 equations of three links;
a component is arbitrary if a vector of the null space has it. This does not change along a sweep of
a planar loop, so that no column has empty cells among full ones. Without any load the same cells
are empty and all others zero. `MECHKIN_RANDOM` multiplies the number of loops.
"""

from __future__ import annotations

import os
import re
from typing import NamedTuple

import numpy as np
from random_families.turning_loop import Array, frame, text

import mechkin_cli as mk

COUNT = 30 * int(os.environ.get("MECHKIN_RANDOM", "1"))
KINDS = ("RRRR", "RRRP", "RRSR", "RRCR", "RRRC")
BETWEEN = {"A": (None, 0), "B": (0, 1), "C": (1, 2), "D": (None, 2)}
"""Links that a joint joins: crank, rod and rocker or slide; None is ground."""
SLIDE = np.array([1.0, 0.2, 0.0]) / np.hypot(1.0, 0.2)


class Loop(NamedTuple):
    """A file, its joints' letters, and their places in the plane's frame."""

    text: str
    letters: str
    places: dict[str, Array]


def loop(rng: np.random.Generator) -> Loop:
    turned, shift, size = frame(rng), rng.normal(size=3), 10 ** rng.uniform(-3, 3)
    letters = str(rng.choice(KINDS))
    flat = {
        "A": (0.0, 0.0),
        "B": (rng.uniform(0.2, 0.4), 0.1),
        "C": (1.0, 0.9),
        "D": (1.3, 0.0),
    }
    places = {
        name: np.array([x, y, 0.0 if kind == "S" else rng.choice([0.0, 0.3])])
        for (name, (x, y)), kind in zip(flat.items(), letters, strict=True)
    }

    def at(p: Array) -> str:
        return text(size * (turned @ p + shift))

    links = dict(
        zip("ABCD", ("ground, crank", "crank, rod", "rod, rocker", "ground, rocker"), strict=True)
    )
    joints = ""
    for name, kind in zip("ABCD", letters, strict=True):
        along = SLIDE if kind == "P" else np.array([0.0, 0.0, 1.0])
        axis = "" if kind == "S" else f", axis: {text(turned @ along)}"
        joints += (
            f"  {name}: {{type: {kind}, links: [{links[name]}], point: {at(places[name])}{axis}}}\n"
        )

    def mass(x: float, y: float) -> str:
        centre = at(np.array([x, y, rng.choice([0.0, 0.2])]))
        return f"{{mass: {rng.uniform(0.1, 2)!r}, center_of_mass: {centre}}}"

    gravity = turned @ np.array([0.3, -9.8, rng.choice([0.0, 1.0])])
    directions = "".join(
        f"  e{letter}: {{link: ground, vector: {text(turned[:, k])}}}\n"
        for k, letter in enumerate("xyz")
    )
    load = "force" if letters[3] == "P" else "torque"
    return Loop(
        f"format: 1\nname: planar\nlinks: {{crank: {mass(0.1, 0.1)}, rod: {mass(0.6, 0.5)}, "
        f"rocker: {mass(1.1, 0.5)}}}\njoints:\n{joints}"
        "motion: {inputs: {A.theta: {from: 0, to: 60, step: 4, rate: 3}}}\n"
        f"loads:\n  - {{type: gravity, g: {text(gravity)}}}\n"
        f"  - {{type: {load}, joint: D, value: 3}}\ndirections:\n{directions}",
        letters,
        places,
    )


def reactions(kind: str) -> Array:
    """Columns: the moments about the joint's point and the forces that a joint carries."""
    free = {"R": [2], "S": [0, 1, 2], "C": [2, 5]}
    if kind != "P":
        return np.eye(6)[:, [k for k in range(6) if k not in free[kind]]]
    along = np.concatenate([np.zeros(3), SLIDE])
    return np.asarray(np.linalg.svd(np.outer(along, along))[0][:, 1:])


def arbitrary(found: Loop) -> set[str]:
    """Components, as columns of a table."""
    columns, owners = [], []
    for name, kind in zip("ABCD", found.letters, strict=True):
        for column in reactions(kind).T:
            moment = column[:3] + np.cross(found.places[name], column[3:])
            balance = np.zeros(18)
            for link, sign in zip(BETWEEN[name], (-1, 1), strict=True):
                if link is not None:
                    balance[6 * link : 6 * link + 6] = sign * np.concatenate([moment, column[3:]])
            columns.append(balance)
            owners.append((name, column))
    drive = np.zeros(18)
    drive[2] = 1.0
    _, values, rows = np.linalg.svd(np.array([*columns, drive]).T)
    null = rows[int((values > 1e-9).sum()) :, : len(owners)]
    out = set()
    for name in "ABCD":
        mine = [k for k, (owner, _) in enumerate(owners) if owner == name]
        wrench = np.array([owners[k][1] for k in mine]).T @ null[:, mine].T
        for k in np.flatnonzero(np.abs(wrench).max(axis=1, initial=0.0) > 1e-8):
            out.add(f"dot({name}.{'moment' if k < 3 else 'force'}, e{'xyz'[k % 3]})")
        along = SLIDE if found.letters["ABCD".index(name)] == "P" else np.array([0.0, 0.0, 1.0])
        loads = {
            "radial_force": np.cross(along, wrench[3:].T),
            "axial_force": along @ wrench[3:],
            "tilting_moment": np.cross(along, wrench[:3].T),
        }
        out |= {f"{name}.{q}" for q, part in loads.items() if np.abs(part).max(initial=0) > 1e-8}
    return out


def fault(number: int) -> str:
    """A cell that is empty or full against the null space; "" if none."""
    found = loop(np.random.default_rng(number))
    names = [
        f"dot({j}.{part}, e{x})" for j in "ABCD" for part in ("force", "moment") for x in "xyz"
    ]
    asked = [f"{j}.{part}" for j in "ABCD" for part in ("force", "moment")]
    for joint, kind in zip("ABCD", found.letters, strict=True):
        loads = () if kind == "S" else ("radial_force", "axial_force", "tilting_moment")
        names += [f"{joint}.{load}" for load in loads]
    result = mk.loads(found.text).analyze([*asked, "ex", "ey", "ez", "A.effort"])
    there = np.asarray(result["row.status"]) == "ok"
    where = f"{number} ({found.letters})"
    if there.sum() < 3:
        return ""
    if np.isnan(result["A.effort"][there]).any():
        return f"{where}: A.effort is not unique"
    free = arbitrary(found)
    for name in names:
        empty = np.isnan(result[name][there])
        if (empty != (name in free)).any():
            return f"{where}: {name} is {'' if name in free else 'not '}arbitrary, {empty.tolist()}"
    return ""


def unloaded_fault(number: int) -> str:
    """A cell of the loop without masses and loads that is not empty or zero as the null space
    has it; "" if none."""
    found = loop(np.random.default_rng(number))
    bare = re.sub(r"\{mass: [^}]*\}", "{}", found.text)
    bare = re.sub(r"loads:\n.*?(?=directions:)", "", bare, flags=re.DOTALL)
    asked = [f"{j}.{part}" for j in "ABCD" for part in ("force", "moment")]
    result = mk.loads(bare).analyze([*asked, "ex", "ey", "ez"])
    there = np.asarray(result["row.status"]) == "ok"
    free = arbitrary(found)
    for name in (f"dot({q}, e{x})" for q in asked for x in "xyz"):
        cells = result[name][there]
        right = np.isnan(cells) if name in free else cells == 0.0
        if not right.all():
            return f"{number} ({found.letters}): {name} is {cells.tolist()}"
    return ""


def test_cells_are_empty_where_a_reaction_is_arbitrary() -> None:
    wrong = [words for n in range(COUNT) if (words := fault(n))]
    assert not wrong, "\n".join(wrong)


def test_without_load_they_are_empty_there_and_zero_elsewhere() -> None:
    wrong = [words for n in range(COUNT) if (words := unloaded_fault(n))]
    assert not wrong, "\n".join(wrong)
