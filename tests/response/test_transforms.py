"""The same motion written otherwise: the same answers, to the tolerance of the integration."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracle import document, in_other_units, moved, mp, renamed, reordered, rotation_matrix, to_text
from references import RCSR
from response.motions import off, respond

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths

SAME = 1e-9
NAMES = ("O1.theta", "O2.theta", "O2.s", "O4.theta")
RATES = tuple(f"{name}_dot" for name in NAMES)
FORCES = ("O4.force", "O3.force", "O2.moment")


def spring_driven() -> dict[str, Any]:
    """RCSR with the dimensions of its response, under its weight, a torque and a damper."""
    data = document(RCSR)
    for key in ("motion", "tables", "loads", "assembly", "coefficients"):
        data.pop(key, None)
    data["parameters"] |= {"alpha1": "10 deg", "alpha4": "20 deg"}
    data["parameters"] |= {"P1": "5 in", "P2": "10 in", "P3": "5 in", "P4": "10 in"}
    data["assembly"] = {
        "near": {"O2.theta": "174.5 deg", "O2.s": "-9.862 in", "O4.theta": "152.6 deg"}
    }
    data["loads"] = [{"type": "gravity", "g": ["0", "-40", "15"]}]
    data["responses"] = {
        "run": {
            "start": {"O1.theta": "20 deg", "O1.theta_dot": "-0.5 rad/s"},
            "efforts": {"O1.theta": "-100 lbm*in^2/s^2 - 30 lbm*in^2/s*O1.theta_dot"},
            "time": {"from": "0 s", "to": "1 s", "step": "0.25 s"},
            "tolerance": "1e-13",
        }
    }
    return data


def base() -> Any:
    return respond(to_text(spring_driven()))


@pytest.fixture(scope="module", name="original")
def _original() -> Any:
    return base()


def check(found: Any, original: Any, names: tuple[str, ...] = NAMES + RATES) -> None:
    for name in names:
        assert off(found[name], original[name]) < SAME, name


def test_the_original_moves_enough_to_tell(original: Any) -> None:
    assert np.ptp(original["O1.theta"]) > 5
    assert np.ptp(original["O4.theta"]) > 20


def test_other_units(original: Any) -> None:
    units = {"length": "mm", "angle": "rad", "mass": "kg", "force": "N", "time": "ms"}
    found = respond(to_text(in_other_units(spring_driven(), units)))
    assert off(found["time"], 1000 * original["time"]) < SAME
    assert off(found["O2.s"], 25.4 * original["O2.s"]) < SAME
    assert off(found["O2.s_dot"], 0.0254 * original["O2.s_dot"]) < SAME
    for name in ("O1.theta", "O2.theta", "O4.theta"):
        assert off(found[name], np.radians(original[name])) < SAME
        assert off(found[f"{name}_dot"], original[f"{name}_dot"]) < SAME
    # lbm in / s^2 in newtons
    force = 0.45359237 * 0.0254
    assert off(found["O4.force"], force * original["O4.force"]) < SAME * 10


def test_a_drawing_that_is_turned_and_shifted(original: Any) -> None:
    rotation = rotation_matrix(3, -1, 2, 5)
    found = respond(to_text(moved(spring_driven(), rotation, [mp.mpf(7), mp.mpf(-3), mp.mpf(2)])))
    check(found, original)
    turn = np.array(rotation, dtype=float)
    for name in FORCES:
        assert off(found[name], original[name] @ turn.T) < 10 * SAME, name


def test_other_names(original: Any) -> None:
    names = {"O1": "zeta", "O2": "Alpha", "O3": "b3", "O4": "a", "coupler": "x9", "crank": "y"}
    found = respond(to_text(renamed(spring_driven(), names)))
    for name in NAMES + RATES:
        joint, rest = name.split(".")
        assert off(found[f"{names[joint]}.{rest}"], original[name]) < SAME


@pytest.mark.parametrize("seed", [1, 2])
def test_another_order(seed: int, original: Any) -> None:
    check(respond(to_text(reordered(spring_driven(), seed))), original)


@pytest.mark.parametrize("coordinate", ["O4.theta", "O2.s"])
def test_another_coordinate_of_the_start(coordinate: str, original: Any) -> None:
    data = spring_driven()
    unit, rate = ("in", "in/s") if coordinate == "O2.s" else ("deg", "rad/s")
    value, speed = original[coordinate][0], original[f"{coordinate}_dot"][0]
    data["responses"]["run"]["start"] = {
        coordinate: f"{float(value)!r} {unit}",
        f"{coordinate}_dot": f"{float(speed)!r} {rate}",
    }
    data["assembly"]["near"] = {
        name: f"{float(original[name][0])!r} {'in' if name == 'O2.s' else 'deg'}" for name in NAMES
    }
    check(respond(to_text(data)), original)


def restarted(original: Any, row: int, sign: float) -> dict[str, Any]:
    """The file that starts at a row, its rate times a sign."""
    data = spring_driven()
    run = data["responses"]["run"]
    run["start"] = {
        "O1.theta": f"{float(original['O1.theta'][row])!r} deg",
        "O1.theta_dot": f"{float(sign * original['O1.theta_dot'][row])!r} rad/s",
    }
    data["assembly"]["near"] = {
        name: f"{float(original[name][row])!r} {'in' if name == 'O2.s' else 'deg'}"
        for name in NAMES
    }
    return data


def test_two_pieces(original: Any) -> None:
    data = restarted(original, 2, 1)
    data["responses"]["run"]["time"] = {"from": "0.5 s", "to": "1 s", "step": "0.25 s"}
    found = respond(to_text(data))
    for name in NAMES + RATES:
        assert off(found[name], original[name][2:]) < SAME, name


def test_time_runs_back() -> None:
    """Without what damps, reversed velocities lead back to the start."""
    data = spring_driven()
    data["responses"]["run"]["efforts"] = {"O1.theta": "-100 lbm*in^2/s^2"}
    there = respond(to_text(data))
    back = restarted(there, -1, -1)
    back["responses"]["run"]["efforts"] = data["responses"]["run"]["efforts"]
    found = respond(to_text(back))
    for name in NAMES:
        assert off(found[name], there[name][::-1]) < SAME, name
        assert off(found[f"{name}_dot"], -there[f"{name}_dot"][::-1]) < SAME, name


def test_rows_elsewhere(original: Any) -> None:
    """Rows between others, and rows denser than steps, change no row beyond the tolerance."""
    data = spring_driven()
    data["responses"]["run"]["time"]["step"] = "0.005 s"
    found = respond(to_text(data))
    for name in NAMES + RATES:
        assert off(found[name][::50], original[name]) < SAME, name


def test_two_copies_move_as_one(original: Any) -> None:
    data = spring_driven()
    other = renamed(
        spring_driven(),
        {
            name: f"{name}_b"
            for key in ("links", "joints", "points", "directions", "parameters")
            for name in data[key]
        },
    )
    for key in ("links", "joints", "points", "directions", "parameters"):
        data[key] |= other[key]
    data["assembly"]["near"] |= other["assembly"]["near"]
    for key in ("start", "efforts"):
        data["responses"]["run"][key] |= other["responses"]["run"][key]
    # the copy starts elsewhere, so the steps are not those of one alone
    data["responses"]["run"]["start"]["O1_b.theta"] = "25 deg"
    found = respond(to_text(data))
    check(found, original)


def test_a_part_that_carries_nothing(original: Any) -> None:
    """A link without mass, welded on."""
    data = spring_driven()
    data["links"]["plate"] = {}
    data["joints"]["weld"] = {"type": "W", "links": ["rocker", "plate"]}
    check(respond(to_text(data)), original)


def with_bodies(data: dict[str, Any], factor: float) -> dict[str, Any]:
    """The file with masses and inertias times a factor."""
    for body in data["links"].values():
        body["mass"] = repr(factor * float(body["mass"]))
        for key, value in body["inertia"].items():
            if key != "axes":
                body["inertia"][key] = repr(factor * float(value))
    return data


def test_twice_the_masses_and_efforts_move_alike(original: Any) -> None:
    data = with_bodies(spring_driven(), 2.0)
    data["responses"]["run"]["efforts"] = {
        "O1.theta": "-200 lbm*in^2/s^2 - 60 lbm*in^2/s*O1.theta_dot"
    }
    found = respond(to_text(data))
    check(found, original)
    for name in (*FORCES, "row.work", "row.kinetic_energy"):
        assert off(found[name], 2 * original[name]) < 10 * SAME, name


def test_twice_as_fast_under_four_times_the_forces(original: Any) -> None:
    """Loads times four, what is viscous and rates times two: the same way in half the time."""
    data = spring_driven()
    data["loads"] = [{"type": "gravity", "g": ["0", "-160", "60"]}]
    data["responses"]["run"] |= {
        "start": {"O1.theta": "20 deg", "O1.theta_dot": "-1 rad/s"},
        "efforts": {"O1.theta": "-400 lbm*in^2/s^2 - 60 lbm*in^2/s*O1.theta_dot"},
        "time": {"from": "0 s", "to": "0.5 s", "step": "0.125 s"},
    }
    found = respond(to_text(data))
    check(found, original, NAMES)
    for name in RATES:
        assert off(found[name], 2 * original[name]) < SAME, name
    for name in FORCES:
        assert off(found[name], 4 * original[name]) < 10 * SAME, name


def test_a_link_in_two_halves(original: Any) -> None:
    """Half of each body is a link of its own, welded on."""
    data = with_bodies(spring_driven(), 0.5)
    for name in list(data["links"]):
        data["links"][f"{name}_b"] = data["links"][name]
        data["joints"][f"weld_{name}"] = {"type": "W", "links": [name, f"{name}_b"]}
    check(respond(to_text(data)), original)


@pytest.mark.parametrize("joint", ["O2", "O4"])
def test_a_joint_written_from_the_other_side(joint: str, original: Any) -> None:
    data = spring_driven()
    data["joints"][joint]["links"].reverse()
    near = data["assembly"]["near"]
    for name in near:
        if name.startswith(joint):
            near[name] = f"-({near[name]})"
    found = respond(to_text(data))
    for name in NAMES + RATES:
        sign = -1 if name.startswith(joint) else 1
        assert off(sign * found[name], original[name]) < SAME, name
    assert off(-found[f"{joint}.force"], original[f"{joint}.force"]) < 10 * SAME


def test_what_nothing_reads_changes_no_bit(original: Any) -> None:
    data = spring_driven()
    data["points"]["unused"] = {"link": "coupler", "at": ["1", "2", "3"]}
    data["parameters"]["unused_too"] = "3 in"
    data["directions"] = {**data["directions"], "off": {"link": "crank", "vector": ["1", "0", "0"]}}
    data["tables"] = [{"name": "t", "columns": ["time", "unused.position.x"]}]
    found = respond(to_text(data))
    for name in (*NAMES, *RATES, *FORCES, "row.work", "row.energy_error"):
        assert np.array_equal(found[name], original[name]), name


@pytest.mark.parametrize("lanes", [2, 4, 8])
def test_lanes_and_threads_change_no_bit(lanes: int, original: Any) -> None:
    if lanes not in widths():
        pytest.skip("the machine has no lanes of this width")
    found = mk.loads(to_text(spring_driven())).respond("run", lanes=lanes, threads=2)
    for name in (*NAMES, *RATES, *FORCES, "row.work", "row.energy_error"):
        assert np.array_equal(found[name], original[name]), name
