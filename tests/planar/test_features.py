"""What a file may ask for works in a plane as in space: values of both forms are equal."""

from __future__ import annotations

import copy
import json
from typing import Any

import numpy as np
import pytest
from planar.space import in_space

import mechkin_cli as mk

Data = dict[str, Any]
NEAR = 1e-12


def four_bar() -> Data:
    """Its closing joint, A or B, turns and is no input."""
    return {
        "format": 1,
        "name": "four-bar",
        "plane": "xy",
        "units": {"length": "m", "angle": "rad", "mass": "kg", "force": "N"},
        "parameters": {"r": "0.4 m"},
        "links": {
            "crank": {"mass": 0.5, "center_of_mass": [0, 0.2], "inertia": 0.02},
            "coupler": {"mass": 1.25, "center_of_mass": [0.5, 0.75], "inertia": 0.3},
            "rocker": {"mass": 0.75, "center_of_mass": [1.3, 0.4], "inertia": 0.11},
        },
        "joints": {
            "O": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]},
            "A": {"type": "R", "links": ["crank", "coupler"], "point": [0, "r"]},
            "B": {"type": "R", "links": ["coupler", "rocker"], "point": [1.2, 0.9]},
            "C": {"type": "R", "links": ["ground", "rocker"], "point": [1.3, 0]},
        },
        "points": {
            "pen": {"link": "coupler", "at": [0.7, 1]},
            "post": {"link": "ground", "at": [1.3, 2]},
        },
        "directions": {"arrow": {"link": "coupler", "vector": [1, 2]}},
        "motion": {
            "inputs": {
                "O.theta": {
                    "from": 0,
                    "to": 1,
                    "count": 9,
                    "rate": "2 rad/s",
                    "acceleration": "1 rad/s^2",
                    "jerk": "3 rad/s^3",
                }
            }
        },
        "loads": [{"type": "gravity", "g": [0, -9.81]}],
    }


def both(data: Data) -> tuple[mk.Model, mk.Model]:
    return mk.loads(json.dumps(data)), mk.loads(json.dumps(in_space(data)))


def same(data: Data, names: list[str], near: float = NEAR) -> mk.Analysis:
    flat, deep = (model.analyze() for model in both(data))
    for name in names:
        one, other = flat[name], deep[name]
        assert np.isfinite(one).all(), name
        size = max(1.0, float(np.max(np.abs(other))))
        assert np.max(np.abs(one - other)) <= near * size, name
    return flat


JOINTS = ("O", "A", "B", "C")
FORCES = [f"{joint}.force.{axis}" for joint in JOINTS for axis in "xy"]
MOTION = [f"{joint}.theta{order}" for joint in JOINTS for order in ("", "_dot", "_ddot", "_dddot")]


def test_what_users_see_of_vectors() -> None:
    flat, deep = (model.analyze() for model in both(four_bar()))
    for name in ("A.force", "pen.position", "pen.velocity", "pen.jerk", "arrow", "A.point"):
        assert flat[name].shape == (9, 2)
        assert flat[name] == pytest.approx(deep[name][:, :2], abs=1e-11)
    for name in ("coupler.omega", "coupler.alpha", "A.moment", "C.moment_about_origin"):
        assert flat[name].shape == (9,)
        assert flat[name] == pytest.approx(deep[f"{name}.z"], abs=1e-11)
    assert flat["norm(A.force)"] == pytest.approx(np.hypot(*flat["A.force"].T), rel=1e-15)
    assert flat["cross(A.point, A.force)"] == pytest.approx(
        flat["A.moment_about_origin"], abs=1e-12
    )
    for name in ("shaking_force", "inertia_force"):
        assert flat[f"ground.{name}"].shape == (9, 2)
    assert flat["ground.shaking_moment"].shape == (9,)
    assert flat["dot(pen.velocity, [0, 1])"] == pytest.approx(flat["pen.velocity.y"], rel=0)
    assert flat["A.force.per_acceleration"].shape == (9, 2)


def test_forces_that_space_leaves_open_are_numbers() -> None:
    flat, deep = (model.analyze() for model in both(four_bar()))
    assert np.isfinite(flat["norm(A.force)"]).all()
    assert np.isnan(deep["norm(A.force)"]).all()


def test_all_derivatives_to_the_third() -> None:
    same(four_bar(), [*MOTION, *FORCES, "O.effort", "O.theta.reduced_inertia"], 1e-11)


@pytest.mark.parametrize("joint", JOINTS)
def test_springs_dampers_and_friction_at_any_pin(joint: str) -> None:
    """Also at that which closes the loop, whose angle is then read off the frames."""
    data = four_bar()
    data["loads"] += [
        {"type": "damper", "joint": joint, "coordinate": "theta", "damping": 0.5},
        {"type": "friction", "joint": joint, "coefficient": 0.2, "radius": 0.03},
    ]
    names = [*MOTION, *FORCES, "O.effort"]
    flat = same(data, [*names, f"{joint}.friction_power", f"{joint}.normal_load"])
    assert flat[f"{joint}.friction_moment"].shape == (9,)
    data["loads"].append(
        {"type": "spring", "joint": joint, "coordinate": "theta", "stiffness": 3, "free": 0.2}
    )
    same(data, names)


def test_springs_between_points_and_laws() -> None:
    data = four_bar()
    data["loads"] += [
        {"type": "spring", "between": ["pen", "post"], "stiffness": 40, "free": 0.5},
        {"type": "damper", "between": ["pen", "post"], "damping": 4},
        {"type": "torque", "joint": "C", "value": "-2 N*m*sin(B.theta) - 1 N*s*pen.velocity.x"},
        {"type": "torque", "link": "coupler", "torque": "1 N*m"},
        {"type": "force", "link": "coupler", "point": [1, 1], "force": [2, 3], "axes": "link"},
    ]
    same(data, [*MOTION, *FORCES, "O.effort"], 1e-11)


def test_a_driven_point_of_a_plane() -> None:
    """A five-bar by its tip; the other file holds the tip with a ball in a groove."""
    data = four_bar()
    data["links"]["arm"] = {"mass": 0.4, "center_of_mass": [0.9, 1.3], "inertia": 0.05}
    data["joints"]["B"] = {"type": "R", "links": ["coupler", "arm"], "point": [0.6, 1.2]}
    data["joints"]["D"] = {"type": "R", "links": ["arm", "rocker"], "point": [1.2, 0.9]}
    data["points"]["tip"] = {"link": "coupler", "at": [0.6, 1.2]}
    data["motion"]["inputs"] = {
        "tip.position.x": {"from": 0.55, "to": 0.65, "count": 5, "rate": "0.2 m/s"},
        "tip.position.y": {"with": "1.2 m + 0.5*(tip.position.x - 0.6 m)"},
    }
    names = [name for name in MOTION if "dddot" not in name]
    flat = same(data, [*names, *FORCES, "tip.position.x.effort"], 1e-11)
    assert mk.loads(json.dumps(data)).mobility().count == 2
    assert flat["tip.position"][:, 0] == pytest.approx(np.linspace(0.55, 0.65, 5), abs=1e-14)
    one = copy.deepcopy(data)
    del one["motion"]["inputs"]["tip.position.y"]
    one["motion"]["inputs"]["O.theta"] = {"at": 0}
    same(one, [*names, "tip.position.y", "tip.position.x.effort"], 1e-11)


def test_responses_follow_the_same_equations() -> None:
    data = four_bar()
    del data["motion"]
    data["responses"] = {
        "swing": {
            "start": {"C.theta": -0.1},
            "time": {"from": 0, "to": 1, "step": 0.1},
            "tolerance": 1e-12,
        }
    }
    data["loads"].append({"type": "damper", "joint": "B", "coordinate": "theta", "damping": 0.3})
    flat, deep = (model.respond("swing") for model in both(data))
    for name in ("A.theta", "B.theta", "C.theta_dot", "O.theta_ddot", "A.force.x", "C.force.y"):
        assert np.isfinite(flat[name]).all()
        assert flat[name] == pytest.approx(deep[name], abs=2e-10)
    assert np.max(np.abs(flat["row.energy_error"])) < 1e-12


def test_modes_ranges_variants_errors_and_proofs() -> None:
    flat, deep = both(four_bar())
    one, other = flat.modes(), deep.modes()
    assert len(one.modes) == len(other.modes) == 2
    names = ["O.theta"]
    for mode, also in zip(one.modes, other.modes, strict=True):
        for name in (*names, "C.theta"):
            assert mode.coordinates[name] == pytest.approx(also.coordinates[name], abs=1e-12)
    ends = [str(model.ranges().circuits) for model in (flat, deep)]
    assert ends[0].count("Circuit") == ends[1].count("Circuit")
    wanted = ["B.theta", "O.effort"]
    for name in wanted:
        varied, also = (m.vary({"r": [0.38, 0.42]}, wanted)[name] for m in (flat, deep))
        assert varied == pytest.approx(also, abs=1e-11)
    assert flat.vary({"r": [0.38]}, ["A.force"])["A.force"].shape == (1, 9, 2)
    run = flat.analyze(["O.theta", "A.force", "C.force", "O.effort"])
    assert run.errors.digits >= 13
    assert (flat.certify().status == "proven").all()
    low, high = flat.certify().enclosure("A.force")
    assert low.shape == (9, 2)
    assert (low <= high).all()
    assert flat.analyze()["A.force"] == pytest.approx((low + high) / 2, rel=1e-13)


def test_a_weld_or_a_slide_that_closes_a_loop() -> None:
    """A slider-crank whose guide closes its loop, and the same through a weld."""
    data = four_bar()
    data["links"]["foot"] = {"mass": 1, "center_of_mass": [1.3, 0], "inertia": 0.1}
    data["joints"]["C"] = {
        "type": "P",
        "links": ["foot", "rocker"],
        "point": [1.3, 0],
        "axis": [3, -1],
    }
    data["joints"]["B"] = {"type": "W", "links": ["coupler", "rocker"]}
    data["joints"]["D"] = {"type": "R", "links": ["ground", "foot"], "point": [1.3, 0]}
    # all turns are driven or sprung, so that only slide and weld are left to close at
    data["loads"] += [
        {"type": "spring", "joint": name, "coordinate": "theta", "stiffness": 1}
        for name in ("A", "D")
    ]
    names = ["A.theta", "C.s", "C.s_dot", "C.s_ddot", "D.theta_ddot", "O.effort"]
    forces = ["C.force.x", "C.force.y", "D.force.x", "A.force.y", "B.force.x"]
    flat = same(data, [*names, *forces], 1e-11)
    closed = [c.joint.name for c in flat.result.graph.closings]
    assert closed in (["C"], ["B"])
    deep = mk.loads(json.dumps(in_space(data))).analyze()
    for joint in ("B", "C"):
        word = "moment" if joint == "C" else "moment_about_origin"
        assert flat[f"{joint}.{word}"] == pytest.approx(deep[f"{joint}.{word}.z"], rel=1e-11)
    del data["joints"]["C"]
    data["joints"]["C"] = {
        "type": "Ps",
        "links": ["rocker", "ground"],
        "point": [1.3, 0],
        "slot": [1, 0],
    }
    del data["joints"]["D"], data["links"]["foot"]
    data["loads"].pop()
    same(data, ["A.theta", "C.s_ddot", "O.effort", "B.force.x"], 1e-11)


def test_grublers_count() -> None:
    """3(n - 1) - 2j, and what a third equal bar takes."""
    data = four_bar()
    found = mk.loads(json.dumps(data)).mobility()
    assert (found.count, found.mobility, found.redundant) == (1, 1, ())
    data["links"] = {"crank": {}, "coupler": {}, "rocker": {}, "third": {}}
    places = {"O": [0, 0], "A": [0, 1], "B": [3, 1], "C": [3, 0], "D": [1, 0], "E": [1, 1]}
    ends = [["ground", "crank"], ["crank", "coupler"], ["coupler", "rocker"], ["ground", "rocker"]]
    ends += [["ground", "third"], ["third", "coupler"]]
    data["joints"] = {
        name: {"type": "R", "links": links, "point": at}
        for (name, at), links in zip(places.items(), ends, strict=True)
    }
    data["loads"] = []
    found = mk.loads(json.dumps(data)).mobility()
    assert (found.count, found.mobility) == (0, 1)
    assert sum(group.number for group in found.redundant) == 1
    assert "moments about x" not in str(found.redundant)


def test_undriven_freedoms_are_counted_in_the_plane() -> None:
    data = four_bar()
    data["links"]["more"] = {}
    data["joints"]["C"]["links"] = ["more", "rocker"]
    data["joints"]["E"] = {"type": "R", "links": ["ground", "more"], "point": [1.6, 0]}
    with pytest.raises(mk.MechkinError) as caught:
        mk.loads(json.dumps(data)).analyze()
    assert "one free coordinate is not driven" in str(caught.value)
    data["motion"]["inputs"]["E.theta"] = {"at": 0}
    same(data, ["A.theta", "B.theta_ddot", "O.effort", "E.effort"], 1e-11)


def test_coupled_wheels_by_with() -> None:
    data = four_bar()
    data["links"]["wheel"] = {"mass": 1, "center_of_mass": [3, 0], "inertia": 0.5}
    data["joints"]["G"] = {"type": "R", "links": ["ground", "wheel"], "point": [3, 0]}
    data["motion"]["inputs"]["G.theta"] = {"with": "-2*O.theta", "drive": "tie"}
    same(data, [*MOTION, "G.theta_ddot", "O.effort", "A.force.x"], 1e-11)


def test_gravity_straight_down_is_along_minus_y() -> None:
    data = four_bar()
    data["loads"] = [{"type": "gravity", "g": "standard"}]
    there = copy.deepcopy(data)
    there["loads"] = [{"type": "gravity", "g": [0, -9.80665]}]
    one, other = (mk.loads(json.dumps(d)).analyze() for d in (data, there))
    assert (one["O.effort"] == other["O.effort"]).all()
    data["loads"] = [{"type": "gravity", "g": "standard", "direction": [1, 0]}]
    assert not (mk.loads(json.dumps(data)).analyze()["O.effort"] == one["O.effort"]).any()


VECTORS = [
    "pen.position",
    "pen.velocity",
    "A.force",
    "arrow",
    "[1, 2]",
    "2*pen.position - post.position",
]
SCALARS = ["coupler.omega", "A.moment", "C.theta", "ground.shaking_moment"]


def test_a_position_tells_what_the_rows_tell() -> None:
    """Vectors of two components, turns and moments of one, also where the branch ends."""
    model = mk.loads(json.dumps(four_bar()))
    run = model.analyze()
    names = [name for name in (*VECTORS, *SCALARS) if name in run]
    assert len(names) == 8
    rows = range(run.rows)
    for row in rows:
        found = model.solve({"O.theta": float(run["O.theta"][row])}, names)
        for name in names:
            assert np.shape(found[name]) == run[name][row].shape
            assert np.abs(found[name] - run[name][row]).max() < NEAR * 100
    beyond = four_bar()
    beyond["joints"]["C"]["point"] = [2.9, 0]
    beyond["joints"]["B"]["point"] = {"coupler": [1.2, 0.9], "rocker": [1.2, 0.9]}
    model = mk.loads(json.dumps(beyond))
    lost = next(
        found
        for angle in np.linspace(0.0, 6.2, 60)
        if (found := model.solve({"O.theta": float(angle)}, names)).status != "ok"
    )
    assert {name: np.shape(lost[name]) for name in names} == {
        name: run[name][0].shape for name in names
    }


def test_vectors_as_data_frames() -> None:
    pytest.importorskip("pandas")
    run = mk.loads(json.dumps(four_bar())).analyze()
    frame = run.to_pandas([*VECTORS, *SCALARS])
    labels = [f"{name}.{axis}" for name in VECTORS[:4] for axis in "xy"]
    labels += [f"({name}).{axis}" for name in VECTORS[4:] for axis in "xy"]
    assert list(frame.columns) == [*labels, *SCALARS]
    for label in frame.columns:
        assert np.array_equal(frame[label], run[label])
        assert frame.attrs["units"][label] == run.unit(label)


@pytest.mark.parametrize("reduce", ["max", "peak", ["min", "rms"], lambda rows: rows[:, 0], None])
def test_vectors_of_variants(reduce: Any) -> None:
    model = mk.loads(json.dumps(four_bar()))
    radii = [0.39, 0.4, 0.41]
    names = [*VECTORS, *SCALARS]
    found = model.vary({"r": radii}, names, reduce=reduce)
    alone = model.vary({"r": radii}, [f"({n}).{axis}" for n in VECTORS for axis in "xy"], reduce)
    for name in VECTORS:
        parts = [alone[f"({name}).{axis}"] for axis in "xy"]
        whole = found[name]
        axis = 2 if reduce is None else 1
        assert whole.shape[axis] == 2
        assert np.array_equal(np.moveaxis(whole, axis, 0), parts)
