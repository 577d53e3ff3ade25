"""Masses of MJCF as MuJoCo itself makes them of geoms, inertials and what the compiler demands."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import imported_robot

mujoco = pytest.importorskip("mujoco")

SHAPES = (
    'type="sphere" size=".1"',
    'type="capsule" size=".1 .2"',
    'type="cylinder" size=".1 .2"',
    'type="box" size=".1 .2 .3"',
    'type="ellipsoid" size=".1 .2 .3"',
    'type="capsule" size=".1" fromto="0 0 0 1 2 3"',
    'type="box" size=".1 .3" fromto="0 0 0 1 2 3"',
    'type="ellipsoid" size=".1 .3 .2" fromto="0 0 0 1 2 3"',
)
INERTIAL = '<inertial pos="0 0 1" mass="1" diaginertia="1 1 1.9"/>'
GEOMS = '<geom size=".1" group="4"/><geom size=".3" pos="0 1 0" group="1"/>'


def body(content: str, compiler: str = "", default: str = "") -> str:
    return (
        f'<mujoco><compiler angle="degree" {compiler}/>{default}<worldbody><body name="b">'
        f'<joint name="j"/>{content}</body></worldbody></mujoco>'
    )


def agree(text: str) -> None:
    """Mass, mass centre and inertia of the body are those of MuJoCo."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    ours = mk.loads(imported_robot(text, "b.xml").text).problem.mechanism.links["b"]
    assert ours.mass == pytest.approx(model.body_mass[1], rel=1e-12)
    assert np.allclose(ours.center_of_mass, data.xipos[1], rtol=0, atol=1e-12)
    axes = data.ximat[1].reshape(3, 3)
    true = axes @ np.diag(model.body_inertia[1]) @ axes.T
    xx, yy, zz, xy, xz, yz = ours.inertia
    found = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    assert np.abs(found - true).max() < 1e-12 * np.abs(true).max()


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("more", ["", ' mass="2"', ' shellinertia="true"'])
def test_geoms(shape: str, more: str) -> None:
    text = body(f"<geom {shape}{more}/>")
    if "shell" in more and "ellipsoid" in shape:
        assert "# Left out: masses of shells of geoms of type ellipsoid" in (
            imported_robot(text, "b.xml").text
        )
    else:
        agree(text)


@pytest.mark.parametrize(
    "compiler",
    [
        'settotalmass="3"',
        'boundmass="50"',
        'boundinertia="5"',
        'balanceinertia="true"',
        'inertiagrouprange="0 2"',
        'inertiafromgeom="true"',
        'inertiafromgeom="false"',
    ],
)
@pytest.mark.parametrize("content", [INERTIAL, INERTIAL + GEOMS, GEOMS])
def test_what_the_compiler_demands(compiler: str, content: str) -> None:
    if content == GEOMS and "false" in compiler:
        content += INERTIAL
    agree(body(content, compiler))


def test_inertia_of_no_real_body_is_balanced() -> None:
    agree(body(INERTIAL.replace("1 1 1.9", "1 1 2.5"), 'balanceinertia="true"'))


@pytest.mark.parametrize("given", ['quat="1 2 3 4"', 'euler="10 20 30"', 'axisangle="1 2 3 40"'])
@pytest.mark.parametrize("own", ['quat="4 -3 2 1"', 'euler="50 60 70"', ""])
def test_an_orientation_of_its_own_replaces_that_of_the_class(given: str, own: str) -> None:
    box = 'type="box" size=".1 .2 .3"'
    agree(body(f"<geom {own}/>", default=f"<default><geom {box} {given}/></default>"))


def test_sections_of_defaults_and_options_add_up() -> None:
    text = body(
        "<geom/>",
        default='<default><geom size=".3"/></default><default><geom density="5"/></default>'
        '<option gravity="1 0 0"/><option gravity="0 2 0"/>',
    )
    agree(text)
    assert "g: [0, 2, 0]" in imported_robot(text, "b.xml").text
    without = text.replace(
        "</default><option", "</default><option><flag gravity='disable'/></option><option"
    )
    assert "gravity" not in imported_robot(without, "b.xml").text
    assert mujoco.MjModel.from_xml_string(without).opt.disableflags


@pytest.mark.parametrize("more", ["", ' shellinertia="true"'])
def test_a_vanishing_geom_is_refused(more: str) -> None:
    with pytest.raises(mk.InvalidFile, match="the capsule is too small to have a mass"):
        imported_robot(body(f'<geom type="capsule" size="1e-320 1e-320"{more}/>'), "b.xml")
