"""What leaves the plane is one error, at its place, with what to write instead."""

from __future__ import annotations

import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile

GOOD = """\
format: 1
name: four-bar
plane: xy
links:
  crank: {mass: 1, center_of_mass: [0, 1], inertia: 2}
  rod: {}
  rocker: {}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0]}
  A: {type: R, links: [crank, rod], point: [0, 1]}
  B: {type: R, links: [rod, rocker], point: [3, 2]}
  C: {type: R, links: [ground, rocker], point: [3, 0]}
points: {p: {link: rod, at: [1, 1]}}
directions: {d: {link: rod, vector: [1, 0]}}
motion: {inputs: {O.theta: {from: 0, to: 10, step: 5, rate: 1 rad/s}}}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: force, link: rod, point: [1, 1], force: [1, 0]}
  - {type: torque, link: rod, torque: 1}
  - {type: friction, joint: A, coefficient: 0.1, radius: 1 cm}
tables: [{name: t, columns: [O.theta, norm(A.force)]}]
"""
CASES = {
    "another plane": ("plane: xy", "plane: xz", "plane", "plane: xy"),
    "a point": ("point: [0, 1]}", "point: [0, 1, 0]}", "joints.A.point", "[x, y]"),
    "a point per link": (
        "point: [0, 1]}",
        "point: {crank: [0, 1, 2], rod: [0, 1]}}",
        "joints.A.point.crank",
        "[x, y]",
    ),
    "an axis of R": ("point: [0, 1]}", "point: [0, 1], axis: [0, 0, 1]}", "joints.A", "normal"),
    "a ball": ("A: {type: R", "A: {type: S", "joints.A.type", "pair in space"),
    "a cylinder": ("A: {type: R", "A: {type: C", "joints.A.type", "pair in space"),
    "a screw": ("A: {type: R", "A: {type: H", "joints.A.type", "pair in space"),
    "a groove": ("A: {type: R", "A: {type: Sg", "joints.A.type", "Ps"),
    "a plane pair": ("A: {type: R", "A: {type: E", "joints.A.type", "pair in space"),
    "a pose": ("A: {type: R", "A: {type: F", "joints.A.type", "P along x"),
    "a mass centre": ("center_of_mass: [0, 1]", "center_of_mass: [0, 1, 0]", "links.crank", "[x"),
    "a tensor": ("inertia: 2", "inertia: {zz: 2}", "links.crank.inertia", "about the normal"),
    "a named point": ("at: [1, 1]", "at: [1, 1, 0]", "points.p.at", "[x, y]"),
    "a direction": ("vector: [1, 0]", "vector: [1, 0, 0]", "directions.d.vector", "[x, y]"),
    "gravity": ("g: [0, -9.81]", "g: [0, 0, -9.81]", "loads#1.g", "[x, y]"),
    "a force": ("force: [1, 0]}", "force: [1, 0, 0]}", "loads#2.force", "[x, y]"),
    "its point": ("point: [1, 1], force", "point: [1, 1, 0], force", "loads#2.point", "[x, y]"),
    "a torque": ("torque: 1}", "torque: [0, 0, 1]}", "loads#3.torque", "about the normal"),
    "axes of a torque": ("torque: 1}", "torque: 1, axes: link}", "loads#3", "normal"),
    "a collar": ("radius: 1 cm}", "radius: 1 cm, collar: 2 cm}", "loads#4", "normal"),
    "a width": ("radius: 1 cm}", "radius: 1 cm, width: 2 cm}", "loads#4", "leave it out"),
    "idle: hold": ("plane: xy", "plane: xy\nidle: hold", "", "leave it out"),
    "the dense system": (
        "plane: xy",
        "plane: xy\ncoefficients: [{name: dense, row: 1}]",
        "",
        "six equations",
    ),
    "a chain": (
        "points: {p",
        "chain: [{joint: K, type: R, link: ground, theta: 0, s: 0, alpha: 0, a: 1}]\npoints: {p",
        "",
        "joints:",
    ),
    "a column's z": ("norm(A.force)]", "A.force.z]", ".z", "not computed"),
    "a moment's z": ("norm(A.force)]", "A.moment.z]", ".z", "leave out .z"),
    "a pin's axis": ("norm(A.force)]", "A.axis.x]", "A.axis.x", "normal"),
    "a screw axis": ("norm(A.force)]", "rod.screw_axis.x]", "screw_axis", "omega"),
    "a vector of space": ("norm(A.force)]", '"dot(A.force, [1, 0, 0])"]', "dot", "have two"),
    "a pose as input": (
        "{O.theta: {from: 0, to: 10, step: 5, rate: 1 rad/s}}",
        "{p.position.z: {from: 0, to: 10, step: 5}}",
        "p.position.z",
        "x and y",
    ),
}


def test_the_file_itself_is_good() -> None:
    assert (mk.loads(GOOD).analyze()["row.status"] == "ok").all()


@pytest.mark.parametrize("name", list(CASES))
def test_one_error_at_its_place(name: str) -> None:
    before, after, where, cure = CASES[name]
    assert GOOD.count(before) == 1
    text = GOOD.replace(before, after)
    with pytest.raises(InvalidFile) as caught:
        mk.loads(text)
    errors = [d for d in caught.value.diagnostics if d.severity == "error"]
    (error,) = errors
    assert where in error.message
    assert error.hint is not None
    assert cure in error.hint
    assert error.place is not None
    line = GOOD[: GOOD.index(before)].count("\n") + 1
    assert line <= error.place.line <= line + after.count("\n")
    assert error.place.column >= 1


def test_errors_inside_one_number_stand_where_they_are_written() -> None:
    """The inertia is several numbers in space, and still one text."""
    text = GOOD.replace("inertia: 2", "inertia: 2 kg*mm")
    with pytest.raises(InvalidFile) as caught:
        mk.loads(text)
    (error,) = caught.value.diagnostics
    assert error.place is not None
    assert text.splitlines()[error.place.line - 1][error.place.column - 1 :].startswith("2 kg")


def test_a_plane_file_without_its_key_is_told_of_it() -> None:
    with pytest.raises(InvalidFile) as caught:
        mk.loads(GOOD.replace("plane: xy\n", ""))
    assert any("plane: xy" in (d.hint or "") for d in caught.value.diagnostics)


def test_nothing_is_detected() -> None:
    """A file in space whose links all move in a plane stays one in space."""
    text = """\
format: 1
links: {a: {}, b: {}, c: {}}
joints:
  O: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: R, links: [a, b], point: [0, 1, 0], axis: [0, 0, 1]}
  B: {type: R, links: [b, c], point: [3, 2, 0], axis: [0, 0, 1]}
  C: {type: R, links: [ground, c], point: [3, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {O.theta: {from: 0, to: 10, step: 5}}}
"""
    model = mk.loads(text)
    assert model.mobility().count == -2
    assert model.analyze()["A.force"].shape == (3, 3)
