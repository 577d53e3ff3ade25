"""Models that MuJoCo reads: its own constraints keep the mechanism where mechkin has it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import ExportOptions, exported
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.units import LENGTH

mujoco = pytest.importorskip("mujoco")

MECHANISMS = Path(__file__).parents[2] / "mechanisms"


def model_of(model: mk.Model, **options: Any) -> tuple[Any, Any]:
    (content,) = exported(model, "mjcf", ExportOptions(**options)).files.values()
    read = mujoco.MjModel.from_xml_string(content.decode())
    data = mujoco.MjData(read)
    mujoco.mj_forward(read, data)
    return read, data


@pytest.mark.parametrize(
    "name",
    [
        "classics/rssr",
        "classics/stewart",
        "classics/sarrus",
        "couplings/cylinder_boom",
        "couplings/geared_five_bar",
        "dissertation/rprrhc",
        "plane/planar_shaper",
        "three_link_paper/cspc",
    ],
)
def test_a_mechanism_stays_where_it_is(name: str) -> None:
    """The drawing is closed, and after 100 steps under gravity all points are where they were."""
    read, data = model_of(mk.load(MECHANISMS / f"{name}.yaml"))
    assert data.nefc > 0
    assert np.abs(data.efc_pos).max() < 1e-12
    before = data.xpos.copy(), data.site_xpos.copy()
    for _ in range(100):
        mujoco.mj_step(read, data)
    assert np.abs(data.xpos - before[0]).max() < 1e-6
    assert np.abs(data.site_xpos - before[1]).max(initial=0.0) < 1e-6


@pytest.mark.parametrize(("name", "row"), [("rcsr", 20), ("rchch", 9)])
def test_a_mechanism_moves_as_mechkin_says(name: str, row: int) -> None:
    """Its input is moved to the next row, by MuJoCo's constraints alone."""
    model = mk.load(MECHANISMS / "dissertation" / f"{name}.yaml")
    read, data = model_of(model, rows=(row,))
    (driven,) = model.problem.motion.inputs
    drive = read.equality(f"{driven.name}.drive").id
    way = driven.values[row] - driven.values[row - 1]
    # the drive is a spring as any constraint: it follows, and comes to rest
    for part in np.linspace(0.0, 1.0, 4000):
        read.eq_data[drive, 0] = part * way
        mujoco.mj_step(read, data)
    for _ in range(4000):
        data.qvel[:] = 0.0
        mujoco.mj_step(read, data)
    rows, units = model.analyze(), model.problem.units
    for point in model.problem.mechanism.points:
        place = rows[f"{point}.position"][row] * units.factor(LENGTH)
        assert np.abs(data.site(point).xpos - place).max() < 1e-6, point


def test_coordinates_have_their_names_and_values() -> None:
    model = mk.load(MECHANISMS / "dissertation" / "rchch.yaml")
    _, data = model_of(model, rows=(3,))
    rows = model.analyze()
    seen = 0
    for joint in model.problem.mechanism.joints.values():
        for name in (joint.name, *joint.coordinates):
            full = joint.coordinates[0] if name == joint.name else name
            try:
                found = float(data.joint(name).qpos[0])
            except KeyError:
                continue
            unit = 1.0 if rows.unit(full) != "deg" else np.pi / 180.0
            scale = 0.0254 if rows.unit(full) == "in" else unit
            assert found == pytest.approx(rows[full][2] * scale, abs=1e-12)
            seen += 1
    assert seen >= 6


def test_springs_between_points_and_on_coordinates_pull_as_they_should() -> None:
    """The acceleration of a released slider: (preload + k (d - free))/m, from both springs."""
    text = """\
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links: {block: {mass: 2, center_of_mass: [0, 0, 0], inertia: {xx: 1, yy: 1, zz: 1}}}
joints: {P: {type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}
points: {a: {link: ground, at: [-1, 0, 0]}, b: {link: block, at: [0, 0, 0]}}
loads:
  - {type: spring, between: [a, b], stiffness: 10, free: 0.9, preload: 2}
  - {type: spring, joint: P, coordinate: s, stiffness: 30, free: 0.2, preload: 1}
  - {type: force, link: block, point: [0, 0, 0], force: [1, 0, 0]}
responses: {fall: {start: {P.s: 0, P.s_dot: 0}, time: {from: 0, to: 0.1, step: 0.1}}}
"""
    model = mk.loads(text)
    _, data = model_of(model)
    pull = (2.0 + 10.0 * 0.1) + (1.0 + 30.0 * (0.0 - 0.2))
    assert data.qacc[0] == pytest.approx(-pull / 2.0, abs=1e-9)
    notes = " ".join(map(str, exported(model, "mjcf", ExportOptions()).notes))
    assert "forces and torques: block" in notes


@pytest.mark.parametrize(
    ("name", "words"), [("tackle", "is a cable"), ("gear_play", "one with backlash")]
)
def test_what_mjcf_cannot_express_is_refused(name: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        exported(mk.load(MECHANISMS / "couplings" / f"{name}.yaml"), "mjcf", ExportOptions())


def test_other_formats_are_refused() -> None:
    with pytest.raises(UsageError, match="no such format; known are dxf, gltf, loads, mjcf"):
        exported(mk.load(MECHANISMS / "classics/rssr.yaml"), "step", ExportOptions())
