"""The same mechanism written otherwise: answers change exactly as each transform documents."""

from __future__ import annotations

import random
from functools import cache

import pytest
from oracle import (
    document,
    in_other_units,
    mirrored,
    moved,
    mp,
    newton_euler,
    random_loop,
    read,
    renamed,
    reordered,
    rotation_matrix,
    solve,
    swapped_links,
)
from oracle.vectors import add, apply, cross, scale
from references import RCSR

SOURCES = ("RCSR", "RHCRRR", "PRSRR", "rcsr.yaml")
CLOSE = mp.mpf("1e-33")


@cache
def original(source: str):
    return document(RCSR if source == "rcsr.yaml" else random_loop(random.Random(source), source))


def answers(data):
    """The first row: (solution, reactions)."""
    mechanism = read(data)
    found = solve(mechanism, mechanism.row(0), mechanism.near)
    return found, newton_euler(mechanism, found)


@cache
def expected(source: str):
    return answers(original(source))


def close(values, wanted):
    if not isinstance(wanted, list):
        values, wanted = [values], [wanted]
    size = max(1, *map(abs, wanted))
    return all(abs(a - b) < CLOSE * size for a, b in zip(values, wanted, strict=True))


def coordinates(found):
    return {name: x for name, x in found.coordinates.items() if not name.endswith(".rotation")}


@pytest.mark.parametrize("source", SOURCES)
def test_moved(source):
    turn, shift = rotation_matrix(3, -1, 2, 1), [mp.mpf(7), mp.mpf(-4), mp.mpf("0.5")]
    found, loads = answers(moved(original(source), turn, shift))
    before, loads_before = expected(source)
    for name, x in coordinates(before).items():
        assert close(found[name], x)
    for name, effort in loads_before.effort.items():
        assert close(loads.effort[name], effort)
    for name in before.mechanism.points:
        place, *rates = before.point(name)
        assert close(found.point(name)[0], add(apply(turn, place), shift))
        for k, rate in enumerate(rates, start=1):
            assert close(found.point(name)[k], apply(turn, rate))
    for name, force in loads_before.force.items():
        turned = apply(turn, force)
        moment = apply(turn, loads_before.moment_about_origin[name])
        assert close(loads.force[name], turned)
        assert close(loads.moment[name], apply(turn, loads_before.moment[name]))
        assert close(loads.moment_about_origin[name], add(moment, cross(shift, turned)))


@pytest.mark.parametrize("source", SOURCES)
def test_mirrored(source):
    found, loads = answers(mirrored(original(source)))
    before, loads_before = expected(source)

    def polar(v):
        return [-v[0], v[1], v[2]]

    for name, x in coordinates(before).items():
        assert close(found[name], -x if ".theta" in name else x)
    for name, effort in loads_before.effort.items():
        assert close(loads.effort[name], -effort if name.endswith(".theta") else effort)
    for name in before.mechanism.points:
        for value, wanted in zip(found.point(name), before.point(name), strict=True):
            assert close(value, polar(wanted))
    for link in before.mechanism.links:
        assert close(found.omega(link), scale(polar(before.omega(link)), -1))
    for name, force in loads_before.force.items():
        assert close(loads.force[name], polar(force))
        for moment in ("moment", "moment_about_origin"):
            wanted = getattr(loads_before, moment)[name]
            assert close(getattr(loads, moment)[name], scale(polar(wanted), -1))


@pytest.mark.parametrize(
    ("source", "swapped"),
    [
        ("PRSRR", "J1"),
        ("RHCRRR", "J2"),
        ("RHCRRR", "J3"),
        ("RHCRRR", "J6"),
        ("rcsr.yaml", "O1"),
        ("rcsr.yaml", "O3"),
    ],
)
def test_swapped_links(source, swapped):
    found, loads = answers(swapped_links(original(source), swapped))
    before, loads_before = expected(source)
    for name, x in coordinates(before).items():
        assert close(found[name], -x if name.startswith(swapped + ".") else x)
    for name, effort in loads_before.effort.items():
        assert close(loads.effort[name], -effort if name.startswith(swapped) else effort)
    for name, force in loads_before.force.items():
        sign = -1 if name == swapped else 1
        moment = loads_before.moment_about_origin[name]
        assert close(loads.force[name], scale(force, sign))
        assert close(loads.moment_about_origin[name], scale(moment, sign))


@pytest.mark.parametrize("source", SOURCES)
def test_renamed_and_reordered(source):
    joints = {name: f"joint_{name}" for name in original(source)["joints"]}
    links = {name: f"body_{name}" for name in original(source)["links"]}
    found, loads = answers(reordered(renamed(original(source), joints | links), seed=5))
    before, loads_before = expected(source)
    for name, x in coordinates(before).items():
        joint, coordinate = name.split(".")
        assert close(found[f"{joints[joint]}.{coordinate}"], x)
    for name, force in loads_before.force.items():
        assert close(loads.force[joints[name]], force)


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize(
    "units",
    [
        {"length": "mm", "angle": "rad", "mass": "t", "force": "N"},
        {"length": "in", "angle": "turn", "mass": "lbm", "force": "lbf"},
    ],
)
def test_in_other_units(source, units):
    """Both files mean the same: rates in rad/s, lengths and forces by the ratio of the bases."""
    found, loads = answers(in_other_units(original(source), units))
    before, loads_before = expected(source)

    def si(solution, unit):
        return 1 / solution.mechanism.units.value(unit)

    for name, x in coordinates(before).items():
        unit = "m" if ".s" in name else "rad"
        assert close(found[name] * si(found, unit), x * si(before, unit))
    for name, effort in loads_before.effort.items():
        unit = "N" if name.endswith(".s") else "N*m"
        assert close(loads.effort[name] * si(found, unit), effort * si(before, unit))
    for name, force in loads_before.force.items():
        wanted = scale(force, si(before, "N"))
        assert close(scale(loads.force[name], si(found, "N")), wanted)
