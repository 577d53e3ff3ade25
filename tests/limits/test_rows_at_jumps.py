"""Rows at the very moment at which a rest begins or ends, or a force of it jumps: they have what
the motion comes with, and are in balance (m a = forces, in closed form)."""

from __future__ import annotations

import numpy as np
import pytest
from limits.machines import on_a_platform

import mechkin_cli as mk

HARMONIC = (
    "{law: sequence, segments: [{for: 1 s, to: 0.5 m, law: harmonic}, {for: 1 s, law: dwell}, "
    "{for: 1 s, to: 2 m, law: harmonic}]}"
)


def columns(**parts: str) -> dict[str, np.ndarray]:
    table = mk.loads(on_a_platform(**parts), "limits").respond("run").tables[0]
    return {column.label: np.asarray(column.values) for column in table.columns}


def assert_balanced(found: dict[str, np.ndarray]) -> None:
    """The slide b with what its limit gives, and both slides with what drives them, at all rows."""
    a, b = found["D.s_ddot"], found["D.s_ddot"] + found["S.s_ddot"]
    assert 2.0 * (b + 8.0) == pytest.approx(found["S.effort"], abs=1e-11)
    assert 1.0 * (a + 8.0) == pytest.approx(found["D.effort"] - found["S.effort"], abs=1e-11)


@pytest.mark.parametrize("start", ["4", "1", "2.25"])
def test_a_fall_ends_in_a_rest_at_a_row(start: str) -> None:
    """sqrt(2 h / g) is 1, 0.5 and 0.75 s, the last of which is no row."""
    found = columns(start=start)
    landed = found["time"] > np.sqrt(2.0 * float(start) / 8.0)
    assert found["S.effort"] == pytest.approx(np.where(landed, 16.0, 0.0), abs=1e-11)
    assert_balanced(found)


def test_a_limit_does_not_pull_where_a_load_lifts() -> None:
    found = columns(load="if(time >= 2 s, 32 N, 0 N)")
    assert found["S.effort"] == pytest.approx([16, 16, 16, 16, 16, 0, 0], abs=1e-11)
    assert found["S.s_ddot"] == pytest.approx([0, 0, 0, 0, 0, 8, 8], abs=1e-11)


def test_the_acceleration_of_a_drive_jumps_beneath_a_rest() -> None:
    """Harmonic rises over h in T begin and end with -+ pi^2 h / (2 T^2)."""
    found = columns(drive=HARMONIC)
    half, two = np.pi**2 * 0.5 / 2.0, np.pi**2 * 1.5 / 2.0
    assert found["D.s_ddot"] == pytest.approx([half, 0, -half, 0, 0, 0, -two], abs=1e-9)
    assert_balanced(found)


@pytest.mark.parametrize("start", ["-1e-9", "1e-10", "1e-8", "1e-7", "1e-3"])
@pytest.mark.parametrize("bounce", ["0", "0.5"])
def test_the_condition_does_not_go_by_where_it_began(start: str, bounce: str) -> None:
    """Near the limit the mechanism's only length is that way."""
    found = columns(start=start, bounce=bounce)
    assert found["row.condition"] == pytest.approx(1.0)
    assert found["S.effort"][1:] == pytest.approx(16.0)


def test_what_rests_while_another_is_struck() -> None:
    """It came once, and rests since then."""
    text = """format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {low: {mass: 1, center_of_mass: [0, 0]}, high: {mass: 1, center_of_mass: [0, 0]}}
joints:
  A: {type: P, links: [ground, low], point: [0, 0], axis: [0, 1]}
  B: {type: P, links: [low, high], point: [0, 0], axis: [0, 1]}
loads: [{type: gravity, g: [0, -8]}]
limits: {A.s: {min: 0, restitution: 0}, B.s: {min: 0, restitution: 0.5}}
responses:
  run: {start: {A.s: 1, B.s: 1, B.s_dot: 2, A.s_dot: -1}, time: {from: 0, to: 3, step: 0.5}}
"""
    notes = [one.message for one in mk.loads(text, "two").respond("run").diagnostics]
    (said,) = [note for note in notes if note.startswith("A.s")]
    landed = (-1.0 + np.sqrt(1.0 + 16.0)) / 8.0
    assert said.startswith("A.s comes to its limit once at ")
    assert " s, and rests at it from " in said
    for place in (said.split(" at ")[1], said.split(" from ")[1]):
        assert float(place.split(" s")[0]) == pytest.approx(landed, abs=1e-9)


def test_what_begins_at_rest_does_not_come() -> None:
    text = on_a_platform(load="if(time >= 2 s, 32 N, 0 N)")
    (said,) = [
        one for one in mk.loads(text, "limits").respond("run").diagnostics if one.code == "rests"
    ]
    assert said.message == "S.s rests at its limit from 0 s on, and leaves it later"
    assert said.measured is None


def test_what_stands_at_its_limit_while_another_strikes() -> None:
    """Without any force: the lower slide is at its limit, and does not come to it; both limits give
    what stops 1 kg that comes with 2 m/s, and throws it back with half of that."""
    text = """format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {low: {mass: 1, center_of_mass: [0, 0]}, high: {mass: 1, center_of_mass: [0, 0]}}
joints:
  A: {type: P, links: [ground, low], point: [0, 0], axis: [0, 1]}
  B: {type: P, links: [low, high], point: [0, 0], axis: [0, 1]}
limits: {A.s: {min: 0, restitution: 0.5}, B.s: {min: 0, restitution: 0.5}}
responses: {run: {start: {A.s: 0, B.s: 1, B.s_dot: -2}, time: {from: 0, to: 1, step: 0.2}}}
"""
    found = mk.loads(text, "two").respond("run")
    impacts = {column.label: column.values for column in found.impacts.columns}
    assert impacts["time"][-1] == pytest.approx(0.5)
    for name in ("A.s.impulse", "B.s.impulse"):
        assert impacts[name][-1] == pytest.approx(3.0)
    assert found["A.s"] == pytest.approx(0.0, abs=1e-12)
    assert found["B.s_dot"][-1] == pytest.approx(1.0)
    notes = [one.message for one in found.diagnostics if one.message.startswith("A.s")]
    assert all("comes to its limit" not in note for note in notes)
    assert notes
