"""The dense system of reactions against what the transposed blocks give.

The equations are assembled from poses and accelerations of the links alone, so that agreement says
something of both. `coefficients:` writes them as tables.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from mechanisms.actuated import platform
from mechanisms.runs import model
from oracle import document, to_text
from references import FILE_OF, committed

import mechkin_cli as mk
from mechkin_cli.balances.dense import borne_wrenches, row_motion
from mechkin_cli.balances.newton_euler import arranged, dense_system, solved
from mechkin_cli.building.tables import unknown_names
from mechkin_cli.diagnostics import InvalidFile

LIMIT = 1e-11
SOURCES = {
    "rcsr": 24,
    "rcsr_csr": 40,
    "rchch": 34,
    "sevenr": 50,
    "rprhrrr": 50,
    "rrrrrrh": 50,
    "rprrhc": 42,
    "pphchp": 42,
    "rcrcr": 34,
    "phchc": 34,
}
"""Unknowns that the dissertation counts."""
OTHERS = ("rccc", "rssr", "swash_plate", "rsgc", "cspc", "csgc", "hooke", "slider_crank", "bricard")
WIDE = ("five_link_suspension", "stewart")


@cache
def analysis(name):
    return model(name).analyze()


def wrench(run, name, row):
    """What the first link of a joint exerts on the second (6,), about the origin, in SI."""
    parts = (
        run.result.quantity(f"{name}.{word}").value for word in ("force", "moment_about_origin")
    )
    return np.array([getattr(part, axis)[row] for part in parts for axis in "xyz"])


def told(unknowns, values, name):
    """The same from the dense solution."""
    found = np.zeros(6)
    for unknown, value in zip(unknowns, values, strict=True):
        if unknown.joint == name and not unknown.name.endswith(".effort"):
            found += value * np.array([*unknown.wrench.force, *unknown.wrench.moment])
    return found


@pytest.mark.parametrize("name", SOURCES)
@pytest.mark.parametrize("row", [0, 7])
def test_its_solution_is_the_reactions(name, row):
    run = analysis(name)
    system = dense_system(run.result, row)
    assert len(system.equations) == len(system.unknowns) == SOURCES[name]
    values = solved(system)
    joints = run.result.problem.mechanism.joints
    expected = {joint: wrench(run, joint, row) for joint in joints}
    for part in (slice(0, 3), slice(3, 6)):
        largest = max(np.max(np.abs(found[part])) for found in expected.values())
        for joint, found in expected.items():
            error = np.abs(told(system.unknowns, values, joint) - found)[part]
            assert np.max(error) <= LIMIT * largest, joint
    for unknown, value in zip(system.unknowns, values, strict=True):
        if unknown.name.endswith(".effort"):
            effort = run.result.quantity(unknown.name).value[row]
            assert abs(value - effort) <= LIMIT * max(abs(effort), largest)


def balance(run, row):
    """The largest resultant on a moving link, in parts of the largest wrench: mechkin's reactions
    and efforts with the dense system's loads, gravity and inertia."""
    problem, motion = run.result.problem, row_motion(run.result, row)
    system = dense_system(run.result, row)
    borne = borne_wrenches(run.result, motion, row)
    total = {name: np.array([*w.force, *w.moment]) for name, w in borne.items()}
    holding = [joint for joint in problem.mechanism.joints.values() if not joint.type.is_free]
    parts = [(joint, wrench(run, joint.name, row)) for joint in holding]
    for unknown in system.unknowns:
        if unknown.name.endswith(".effort"):
            unit = np.array([*unknown.wrench.force, *unknown.wrench.moment])
            value = run.result.quantity(unknown.name).value[row]
            parts.append((problem.mechanism.joints[unknown.joint], value * unit))
    for joint, found in parts:
        total[joint.second] = total[joint.second] + found
        total[joint.first] = total[joint.first] - found
    largest = max(np.max(np.abs(found)) for _, found in parts)
    return max(np.max(np.abs(total[name])) for name in problem.mechanism.links) / largest


@pytest.mark.parametrize("name", [*OTHERS, *WIDE])
def test_links_are_in_equilibrium(name):
    """Where it is not square: redundant constraints, idle freedoms, legs."""
    run = analysis(name)
    assert balance(run, run.rows // 2) <= LIMIT


LOADS = [
    {"type": "gravity", "g": ["10", "-20", "-386.09"]},
    {"type": "force", "link": "coupler", "point": ["1", "2", "3"], "force": ["5", "-7", "9"]},
    {
        "type": "force",
        "link": "rocker",
        "point": ["3", "1", "0"],
        "force": ["5", "-7", "9"],
        "axes": "link",
    },
    {
        "type": "torque",
        "link": "coupler",
        "torque": ["5", "20 lbm*in^2/s^2*O1.theta/(1 rad)", "9"],
        "axes": "link",
    },
    {
        "type": "torque",
        "joint": "O2",
        "value": "-3 lbm*in^2/s^2 - 40 lbm*in^2/s*O4.theta_dot/(1 rad)",
    },
    {"type": "force", "joint": "O2", "value": "17"},
    {"type": "spring", "between": ["pm1", "pm3"], "stiffness": "12", "free": "2", "preload": "3"},
    {"type": "spring", "joint": "O2", "coordinate": "s", "stiffness": "4", "free": "-9"},
    {"type": "damper", "between": ["pm2", "pm3"], "damping": "30"},
    {"type": "damper", "joint": "O4", "coordinate": "theta", "damping": "25"},
]


@pytest.mark.parametrize("load", LOADS, ids=[f"{n}-{load['type']}" for n, load in enumerate(LOADS)])
def test_every_load_counts(load):
    data = document(FILE_OF["rcsr"])
    data.pop("coefficients")
    run = mk.loads(to_text(data | {"loads": [load]}), "rcsr").analyze([], tables=["table_18"])
    assert balance(run, 5) <= LIMIT
    without = mk.loads(to_text(data | {"loads": []}), "rcsr").analyze([], tables=["table_18"])
    borne = [borne_wrenches(one.result, row_motion(one.result, 5), 5) for one in (run, without)]
    assert borne[0] != borne[1]


def test_an_error_is_seen():
    """The drive's sign turned round upsets the balance of the crank."""
    run = analysis("rcsr")
    system = dense_system(run.result, 3)
    values = np.array(solved(system))
    rest = np.array(system.coefficients) @ values - np.array(system.right)
    assert np.max(np.abs(rest)) <= LIMIT * np.max(np.abs(values))
    values[-1] *= -1
    rest = np.array(system.coefficients) @ values - np.array(system.right)
    assert np.max(np.abs(rest)) > 1e-3 * np.max(np.abs(values))


def test_the_table_is_the_system():
    """Coefficients times values are the right side, in the file's units."""
    for stem, name in (("rcsr", "table_14"), ("rcsr_csr", "table_24"), ("rchch", "table_32")):
        rows, unknowns = committed(stem, name), committed(stem, f"{name}_unknowns")
        labels = [row["unknown"] for row in unknowns]
        assert list(rows[0]) == ["i", "equation", *labels, "right side"]
        assert len(rows) == len(labels) == SOURCES[stem]
        values = [float(row["value"]) for row in unknowns]
        largest = max(map(abs, values))
        for row in rows:
            left = sum(float(row[n]) * v for n, v in zip(labels, values, strict=True))
            assert abs(left - float(row["right side"])) <= 1e-9 * largest


def test_values_stand_in_the_reaction_tables():
    """O3 along B, C and B x C, as Table XVIII has it at the same row."""
    unknowns = {
        row["unknown"]: float(row["value"]) for row in committed("rcsr", "table_14_unknowns")
    }
    printed = committed("rcsr", "table_18")[0]
    for unknown, label in (("O3.F B", "FB"), ("O3.F C", "FC"), ("O3.F B x C", "FD")):
        assert abs(unknowns[unknown] - float(printed[label])) <= 1e-9
    assert abs(unknowns["O1.theta.effort reversed"] - float(printed["MIN"])) <= 1e-9


WRONG = {
    "row: 28": "the sweep has 27 rows",
    "along: {O2: [B, C]}": "O2 is not a ball of the mechanism",
    "along: {O3: [B, E]}": "there is no direction E",
    "along: {O3: [B]}": "",
    "equations: [crank, O9]": "there is no O9 here",
    "equations: [O1, -O1]": "O1 is named twice",
    "unknowns: [O1.F, O3.M]": "there is no O3.M here",
    "unknowns: [-O2.FA]": "there is no O2.FA here",
    "unknowns: [O1.F, O1.F]": "O1.F is named twice",
    "unknowns: [O1 F]": "a name, with - where signs turn round",
    "name: table_15": "another table is written to table_15",
}


@pytest.mark.parametrize("text", WRONG)
def test_what_cannot_be_is_told_with_its_place(text):
    written = FILE_OF["rcsr"].read_text(encoding="utf-8")
    head = written[: written.index("coefficients:")]
    name = "" if text.startswith("name") else "name: table_14, "
    with pytest.raises(InvalidFile) as error:
        mk.loads(f"{head}coefficients:\n  - {{{name}{text}}}\n", str(FILE_OF["rcsr"]))
    (found,) = error.value.diagnostics
    assert WRONG[text] in found.message
    assert found.place is not None
    assert found.place.line == head.count("\n") + 2


@pytest.mark.parametrize("name", [*SOURCES, *OTHERS, *WIDE])
def test_every_unknown_can_be_named(name):
    """Those that a file may order are those of the system."""
    run = analysis(name)
    groups = [unknown.group for unknown in dense_system(run.result, 0).unknowns]
    assert set(unknown_names(run.result.problem)) == set(groups)


def test_order_and_signs_change_nothing_else():
    """Any order of links, joints and unknowns, any signs: the same system and solution."""
    run = analysis("rcsr_csr")
    usual = dense_system(run.result, 3)
    values = dict(zip([u.name for u in usual.unknowns], solved(usual), strict=True))
    draw = np.random.default_rng(28)
    owners = list(dict.fromkeys(name.partition(":")[0] for name, _ in usual.equations))
    groups = list(dict.fromkeys(unknown.group for unknown in usual.unknowns))
    largest = max(map(abs, values.values()))
    for _ in range(50):
        chosen = [
            [
                f"{'-' if draw.random() < 0.5 else ''}{names[k]}"
                for k in draw.permutation(len(names))[: draw.integers(len(names) + 1)]
            ]
            for names in (owners, groups)
        ]
        system = arranged(usual, *chosen)
        assert len(set(system.equations)) == len(usual.equations)
        found = list(dict.fromkeys(u.group for u in system.unknowns))
        named = [text.removeprefix("-") for text in chosen[1]]
        assert [group.removesuffix(" reversed") for group in found][: len(named)] == named
        for unknown, value in zip(system.unknowns, solved(system), strict=True):
            name = unknown.name.removesuffix(" reversed")
            sign = 1.0 if name == unknown.name else -1.0
            assert (sign < 0.0) == (f"-{unknown.group.removesuffix(' reversed')}" in chosen[1])
            assert abs(sign * value - values[name]) <= LIMIT * largest


def test_a_joint_written_the_other_way_round():
    """Its reactions change their sign, all others and the count stay."""
    data = document(FILE_OF["sevenr"])
    data.pop("coefficients")
    turned = data | {"joints": data["joints"] | {}}
    turned["joints"]["J3"] = data["joints"]["J3"] | {"links": ["three", "two"]}
    found = {}
    for name, text in (("as it is", data), ("turned", turned)):
        run = mk.loads(to_text(text), "sevenr").analyze(tables=[])
        system = dense_system(run.result, 4)
        names = [unknown.name for unknown in system.unknowns]
        found[name] = dict(zip(names, solved(system), strict=True))
    largest = max(abs(value) for value in found["as it is"].values())
    assert set(found["turned"]) == set(found["as it is"])
    for name, value in found["as it is"].items():
        # the axis along which FA3 counts is that of the drawing
        sign = -1.0 if name.startswith("J3.") else 1.0
        assert abs(found["turned"][name] - sign * value) <= LIMIT * largest, name


def test_what_holds_idle_freedoms_has_no_coefficients():
    text = FILE_OF["rcsr"].read_text(encoding="utf-8") + "\nidle: hold\n"
    with pytest.raises(InvalidFile, match="where idle freedoms are held"):
        mk.loads(text, str(FILE_OF["rcsr"]))


def test_responses_alone_have_no_coefficients():
    text = FILE_OF["rcsr_response"].read_text(encoding="utf-8")
    with pytest.raises(InvalidFile, match="the file has responses alone"):
        mk.loads(f"{text}\ncoefficients: [{{name: t}}]\n", str(FILE_OF["rcsr_response"]))


def test_loads_of_responses_do_not_count_in_the_sweep():
    data = document(FILE_OF["rcsr"])
    data.pop("coefficients")
    start = {"start": {"O1.theta": "150"}, "time": {"from": "0", "to": "1", "step": "1"}}
    load = {"type": "torque", "joint": "O4", "value": "10"}
    other = {"type": "torque", "joint": "O2", "value": "70", "runs": ["r"]}
    data |= {"responses": {"r": start}, "loads": [load, other]}
    run = mk.loads(to_text(data), "rcsr").analyze([], tables=["table_18"])
    assert balance(run, 5) <= LIMIT
    assert abs(run["O1.effort"][0] - analysis("rcsr")["O1.effort"][0]) <= 1e-12


UNIVERSAL = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links:
  arm: {mass: 2, center_of_mass: [0.4, 0.1, 0.2], inertia: {xx: 0.1, yy: 0.2, zz: 0.2, xy: 0.01}}
joints:
  J: {type: U, links: [ground, arm], point: [0.1, 0, 0.2], axis: [0, 0, 1], axis2: [1, 0, AXIS]}
motion:
  inputs:
    J.theta1: {from: 0, to: 2, count: 5, rate: 3 rad/s, acceleration: 1}
    J.theta2: {at: 0.5, rate: 2 rad/s}
loads:
  - {type: gravity, g: [1, 2, -9.81]}
  - {type: spring, joint: J, coordinate: theta2, stiffness: 3, free: 0.2}
"""


@pytest.mark.parametrize("axis", ["0", "0.7"])
def test_the_two_turns_of_a_universal_joint(axis):
    run = mk.loads(UNIVERSAL.replace("AXIS", axis), "u").analyze(["J.force", "J.theta1.effort"])
    assert balance(run, 3) <= LIMIT


def test_efforts_that_act_at_actuators():
    data = document(FILE_OF["sevenr"])
    data.pop("coefficients")
    data |= {"actuators": ["J3.theta"], "tables": []}
    run = mk.loads(to_text(data), "sevenr").analyze(["J3.effort"], tables=[])
    system = dense_system(run.result, 4)
    assert [u.name for u in system.unknowns if u.rank == 4] == ["J3.theta.effort"]
    assert balance(run, 4) <= LIMIT
    assert abs(solved(system)[-1] - run.result.quantity("J3.effort").value[4]) <= 1e-9


def test_a_pose_that_is_driven():
    """Its drive pulls at the platform; or the legs do."""
    inputs = "    pose.z: {from: -0.01, to: 0.01, count: 3, rate: 0.5}\n" + "".join(
        f"    pose.{name}: {{at: 0.02, rate: 0.3}}\n" for name in ("x", "y", "rz", "ry", "rx")
    )
    legs = "actuators: [" + ", ".join(f"L{k}.s" for k in range(1, 7)) + "]\n"
    for actuators in ("", legs):
        run = mk.loads(platform(inputs, actuators), "p").analyze([])
        assert balance(run, 1) <= LIMIT


def test_joints_that_rub_have_no_coefficients():
    data = document(FILE_OF["rcsr"])
    rub = {"type": "friction", "joint": "O1", "coefficient": "0.1", "radius": "0.2"}
    with pytest.raises(InvalidFile, match="where joints rub"):
        mk.loads(to_text(data | {"loads": [rub]}), "rcsr")
