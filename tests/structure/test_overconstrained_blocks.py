"""Blocks where more equations are written than are new: dyads of other joints in a plane, rods and
dyads beside equal ones, special and unassembled drawings.

A plane dyad moves alike whatever joints hold it in its plane, so chains of all kinds are compared
with that of R alone; rods beside equal ones change nothing at all.
"""

from __future__ import annotations

import math
import os
import random
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from references import SWEPT

import mechkin_cli as mk
from mechkin_cli.mechanism.vectors import GROUND
from mechkin_cli.session.assembled_places import is_drawn_assembled
from mechkin_cli.structure.network import connections_of, reduce
from mechkin_cli.structure.rank import Rates, middle_and_size

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

KINDS = ("RRR", "RSR", "SSR", "CSR", "SCR", "SRR")
UNKNOWNS = {"RRR": 2, "RSR": 2, "SSR": 1, "CSR": 3, "SCR": 3, "SRR": 2}


def joint(name: str, letter: str, ends: tuple[str, str], *point: object) -> str:
    axis = "" if letter == "S" else ", axis: [0, 0, 1]"
    at = point[0] if len(point) == 1 else list(point)
    return f"  {name}: {{type: {letter}, links: [{ends[0]}, {ends[1]}], point: {at}{axis}}}\n"


def head(links: list[str]) -> str:
    named = ", ".join(f"{link}: {{}}" for link in links)
    return f"format: 1\nunits: {{length: m, angle: deg, force: N}}\nlinks: {{{named}}}\njoints:\n"


def sweep(name: str, last: int = 20) -> str:
    return f"motion: {{inputs: {{{name}.theta: {{from: 0, to: {last}, step: 5}}}}}}\n"


def dyad(mark: str, kind: str, base: str, points: tuple[tuple[float, float], ...]) -> str:
    rod, rocker = f"b{mark}", f"k{mark}"
    ends = ((base, rod), (rod, rocker), ("ground", rocker))
    return "".join(
        joint(f"{name}{mark}", letter, two, *at, 0)
        for name, letter, two, at in zip("PMD", kind, ends, points, strict=True)
    )


PLACES = (((1, 0), (3, 3), (5, 0)), ((4, 2), (7, 4), (8, 0)), ((6, 5), (10, 6), (11, 1)))


def chain(kinds: tuple[str, ...], on: str) -> str:
    """A crank, and dyads each on the rocker before it; the last on the link `on`."""
    text = head(["c0", *(f"{letter}{k}" for k in range(3) for letter in "bk")])
    text += joint("A0", "R", ("ground", "c0"), 0, 0, 0)
    for k, base in enumerate(("c0", "k0", on)):
        text += dyad(str(k), kinds[k], base, PLACES[k])
    return text + sweep("A0")


def sizes(text: str) -> list[int]:
    return [len(block.unknowns) for block in mk.loads(text).graph.blocks]


@pytest.mark.parametrize("on", ["b1", "k1"])
@pytest.mark.parametrize("first", KINDS)
def test_what_holds_a_dyad_in_its_plane_changes_nothing(first: str, on: str) -> None:
    names = ["D0.theta", "D1.theta", "D2.theta", "D2.theta_dot"]
    wanted = mk.loads(chain(("RRR",) * 3, on)).analyze(names)
    for others in product(KINDS, repeat=2):
        kinds = (first, *others)
        if kinds[1] == "SSR" and on == "b1":
            continue
        text = chain(kinds, on)
        assert sorted(sizes(text)) == sorted(UNKNOWNS[kind] for kind in kinds), kinds
        found = mk.loads(text).analyze(names)
        assert set(found["row.status"].tolist()) == {"ok"}, kinds
        for name in names:
            assert np.abs(found[name] - wanted[name]).max() < 1e-9, (kinds, name)


def wheels(count: int, rods: int, angle: float, longer: float = 0.0) -> str:
    """Wheels in a row coupled by equal rods side by side, `longer` than they are drawn apart."""
    x, y = 3 * math.cos(math.radians(angle)), 3 * math.sin(math.radians(angle))
    links = [f"w{k}" for k in range(count + 1)]
    text = joint("A", "R", ("ground", "w0"), 0, 0, 0)
    for k in range(count):
        text += joint(f"D{k}", "R", ("ground", f"w{k + 1}"), 10 * k + 10, 0, 0)
        for n in range(rods):
            rod, pin = f"r{k}_{n}", [10 * k + 10 + x, y, 0.5 * n]
            links.append(rod)
            text += joint(f"P{rod}", "S", (f"w{k}", rod), 10 * k + x, y, 0.5 * n)
            at = f"{{{rod}: {[pin[0] + longer, *pin[1:]]}, w{k + 1}: {pin}}}"
            text += joint(f"Q{rod}", "S", (rod, f"w{k + 1}"), at)
    return head(links) + text + sweep("A", 40)


@pytest.mark.parametrize("longer", [0.0, 1e-8, 1e-3])
@pytest.mark.parametrize("count", [1, 2, 4, 8 if TIMES > 1 else 6])
def test_rods_beside_each_other(count: int, longer: float) -> None:
    names = [f"D{k}.theta" for k in range(count)]
    wanted = mk.loads(wheels(count, 1, 30, longer)).analyze(names)
    for rods in (2, 3):
        text = wheels(count, rods, 30, longer)
        assert sizes(text) == [1] * count
        found = mk.loads(text).analyze(names)
        assert found["row.status"].tolist() == wanted["row.status"].tolist() == ["ok"] * 9
        for name in names:
            assert np.abs(found[name] - wanted[name]).max() < 1e-9


@pytest.mark.parametrize("count", [1, 2, 4, 8 if TIMES > 1 else 6])
def test_a_flat_drawing_does_not_tell_the_rank(count: int) -> None:
    assert sizes(wheels(count, 2, 0)) == [1] * count


@pytest.mark.parametrize("driven", ["A0", "D0"])
def test_nor_does_a_drawing_in_a_dead_centre(driven: str) -> None:
    """Crank and rod in line: driven at the rocker it is a dead centre."""
    links = ["c0", "b0", "k0", "r", "b1", "k1", "b2", "k2"]
    text = head(links) + joint("A0", "R", ("ground", "c0"), 0, 0, 0)
    text += dyad("0", "RRR", "c0", ((1, 0), (3, 0), (3.2, 2)))
    text += joint("rp", "S", ("c0", "r"), 1, 0, 0) + joint("rq", "S", ("r", "k0"), 3, 0, 0)
    text += dyad("1", "CSR", "c0", ((-0.5, 0.6), (-2, 2), (-3, 0)))
    text += dyad("2", "RRR", "k1", ((-2.5, 1), (-4, 2), (-5, 0)))
    # the rod r and its equal b0 hold k0 together
    assert sorted(sizes(text + sweep(driven))) == [2, 2, 3]


def quartered(kinds: tuple[str, str], order: random.Random) -> str:
    """Wheels on two equal rods a quarter apart, as on a locomotive, written in any order."""
    links, joints = ["w", "v"], [joint("D", "R", ("ground", "v"), 3, 0, 0)]
    for k, (kind, (x, y)) in enumerate(zip(kinds, ((0.92, 0.39), (-0.39, 0.92)), strict=True)):
        links.append(f"r{k}")
        joints.append(joint(f"P{k}", kind[0], ("w", f"r{k}"), x, y, 0.3 * k))
        joints.append(joint(f"Q{k}", kind[1], (f"r{k}", "v"), 3 + x, y, 0.3 * k))
    order.shuffle(links)
    order.shuffle(joints)
    text = head(links) + joint("A", "R", ("ground", "w"), 0, 0, 0) + "".join(joints)
    return text + "motion: {inputs: {A.theta: {from: 0, to: 720, step: 10}}}\n"


@pytest.mark.parametrize("second", ["RR", "RS", "SR", "SS", "RC"])
@pytest.mark.parametrize("first", ["RR", "RS", "SR", "SS", "RC"])
def test_one_rod_holds_where_the_other_is_in_line(first: str, second: str) -> None:
    """The wheels turn alike for ever, though either rod alone has two branch points a turn."""
    for seed in range(4):
        found = mk.loads(quartered((first, second), random.Random(seed))).analyze(["D.theta"])
        assert set(found["row.status"].tolist()) == {"ok"}
        off = np.remainder(found["D.theta"] - found["A.theta"] + 180.0, 360.0) - 180.0
        assert np.abs(off).max() < 1e-9


def test_a_plate_on_three_cranks() -> None:
    """Two of its cranks alone are a parallelogram, with branch points where they are in line."""
    feet = ((0.0, 0.0), (2.0, 0.0), (0.7, 1.5))
    text = head(["c0", "c1", "c2", "plate"]) + joint("A0", "R", ("ground", "c0"), 0, 0, 0)
    for k, (x, y) in enumerate(feet):
        if k:
            text += joint(f"A{k}", "R", ("ground", f"c{k}"), x, y, 0)
        text += joint(f"B{k}", "RRS"[k], (f"c{k}", "plate"), x + 0.4, y + 0.3, 0)
    found = mk.loads(text + sweep("A0", 360)).analyze(["A1.theta", "A2.theta"])
    assert set(found["row.status"].tolist()) == {"ok"}
    for name in ("A1.theta", "A2.theta"):
        off = np.remainder(found[name] - found["A0.theta"] + 180.0, 360.0) - 180.0
        assert np.abs(off).max() < 1e-9


def test_an_equal_dyad_beside_one_of_other_joints() -> None:
    text = head(["c0", *(f"{letter}{k}" for k in range(3) for letter in "bk")])
    text += joint("A0", "R", ("ground", "c0"), 0, 0, 0)
    text += dyad("0", "CSR", "c0", PLACES[0])
    text += dyad("1", "RRR", "b0", ((2, 3), (7, 4), (8, 0)))
    text += dyad("2", "RRR", "b0", ((2, 3), (7, 4), (8, 0)))
    assert sizes(text + sweep("A0")) == [3, 2, 2]
    found = mk.loads(text + sweep("A0")).analyze(["D1.theta", "D2.theta"])
    assert found["row.status"].tolist() == ["ok"] * 5
    assert np.abs(found["D1.theta"] - found["D2.theta"]).max() < 1e-9


DRAWN_FLAT = {"parallelogram"}
"""Drawn in a branch point."""


@pytest.mark.parametrize("path", SWEPT, ids=lambda path: path.stem)
def test_inputs_hold_a_mechanism_and_one_less_does_not(path: Path) -> None:
    """Of every pair, in mechanisms of which all rows are solved. What couplings hold beside pairs
    is not looked at."""
    problem = mk.load(path).problem
    mechanism = problem.solved_mechanism
    whole = reduce(mechanism)
    if mechanism.couplings or not is_drawn_assembled(mechanism) or path.stem in DRAWN_FLAT:
        return
    for left_out in range(-1, len(problem.driven)):
        driven = [name for k, name in enumerate(problem.driven) if k != left_out]
        numbers = {(j, mechanism.joints[j].freedom_number(c)) for j, c in driven}
        rates = Rates(lambda link: GROUND, numbers, *middle_and_size(mechanism))
        connections = connections_of(mechanism, whole, driven)
        still = rates.still(set(whole.links), connections, {"ground"})
        assert (still == set(whole.links)) == (left_out < 0), left_out
