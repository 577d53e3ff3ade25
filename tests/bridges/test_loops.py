"""Loops of robot files: closed by equality constraints, or by words of the command line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import imported_robot
from mechkin_cli.cli.bridges import export, import_
from mechkin_cli.diagnostics import InvalidFile, UsageError

HEAD = """\
<mujoco model="four bar"><compiler angle="radian"/><option gravity="0 -9.81 0"/><worldbody>
 <body name="crank"><joint name="A"/><inertial pos="0.05 0 0" mass="1" diaginertia="1 1 1"/>
  <body name="rod" pos="0.1 0 0"><joint name="B"/>
   <inertial pos="0.1 0.1 0" mass="1" diaginertia="1 1 1"/></body></body>
 <body name="rocker" pos="0.4 0 0"><joint name="D" REF/>
  <inertial pos="0 0.1 0" mass="1" diaginertia="1 1 1"/></body>
</worldbody><equality>
"""
TAIL = "</equality></mujoco>"
CLOSED = {
    "ball": '<connect body1="rod" body2="rocker" anchor="0.3 0.2 0"/>',
    "hinge": '<connect body1="rod" body2="rocker" anchor="0.3 0.2 0"/>'
    '<connect body1="rod" body2="rocker" anchor="0.3 0.2 0.1"/>',
}
"""The rod ends at (0.4, 0.2), above the rocker's joint."""


@pytest.mark.parametrize("how", CLOSED)
@pytest.mark.parametrize("ref", ["", 'ref="0.3"'])
def test_a_four_bar_closed_by_connect(how: str, ref: str) -> None:
    """Lengths 0.1, sqrt(0.09 + 0.04), 0.2 and 0.4: the loop's own cosines give the rocker."""
    found = imported_robot(HEAD.replace("REF", ref) + CLOSED[how] + TAIL, "four_bar.xml")
    assert "A.theta: {at: 0}" in found.text
    start = 0.3 if ref else 0.0
    rows = mk.loads(found.text.replace("{at: 0}", "{from: 0, to: 0.8, count: 5}")).analyze()
    assert rows.complete
    crank = 0.1 * np.array([np.cos(rows["A.theta"]), np.sin(rows["A.theta"])]).T
    rocker = np.pi / 2.0 + rows["D.theta"] - start
    end = np.array([0.4 + 0.2 * np.cos(rocker), 0.2 * np.sin(rocker)]).T
    assert np.allclose(np.linalg.norm(end - crank, axis=1), np.sqrt(0.13), atol=1e-12)
    assert rows["D.theta"][0] == pytest.approx(start, abs=1e-12)


def test_equality_of_joints_couples_or_holds_them() -> None:
    equal = (
        '<joint joint1="D" joint2="A" polycoef="0.1 -2 0 0 0"/>'
        '<joint joint1="A" polycoef="0.5"/><joint joint1="B" polycoef="0"/>'
    )
    rows = mk.loads(imported_robot(HEAD.replace("REF", 'ref="0.3"') + equal + TAIL, "x").text)
    row = rows.analyze()
    assert row["A.theta"][0] == 0.5
    # about ref: D - 0.3 = 0.1 - 2 A
    assert row["D.theta"][0] == pytest.approx(0.3 + 0.1 - 1.0, abs=1e-15)


def test_what_is_left_out_is_named() -> None:
    more = '<actuator><motor name="m" joint="A"/></actuator><contact><pair/></contact>'
    found = imported_robot(
        HEAD.replace("REF", 'armature="1"') + "</equality>" + more + "</mujoco>", "x"
    )
    told = " ".join(note.message for note in found.notes)
    for words in ("actuator: m", "contact: pair", "armature of joints: D"):
        assert words in told
    assert "# Left out: actuator: m." in found.text


def test_higher_polynomials_are_refused_with_their_line() -> None:
    equal = '\n<joint joint1="D" joint2="A" polycoef="0 1 2 0 0"/>'
    with pytest.raises(InvalidFile, match=r"x:9:1.*higher order"):
        imported_robot(HEAD.replace("REF", "") + equal + TAIL, "x")


ARM = """\
<robot name="bars">
 <link name="base"/><link name="crank"/><link name="rod"/><link name="tip"/>
 <link name="rocker"/><link name="end"/>
 <joint name="A" type="continuous"><parent link="base"/><child link="crank"/>
  <axis xyz="0 0 1"/></joint>
 <joint name="B" type="continuous"><parent link="crank"/><child link="rod"/>
  <origin xyz="0.1 0 0"/><axis xyz="0 0 1"/></joint>
 <joint name="D" type="continuous"><parent link="base"/><child link="rocker"/>
  <origin xyz="0.4 0 0"/><axis xyz="0 0 1"/></joint>
 <joint name="t" type="fixed"><parent link="rod"/><child link="tip"/>
  <origin xyz="0.3 0.2 0"/></joint>
 <joint name="e" type="fixed"><parent link="rocker"/><child link="end"/>
  <origin xyz="0 0.2 0"/></joint>
</robot>
"""


def test_a_loop_of_a_urdf_is_closed_on_request(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("bars.urdf").write_text(ARM, encoding="utf-8")
    assert import_(Path("bars.urdf"), close=["tip:end:R"]) == 0
    model = mk.load("bars.yaml")
    assert "type: R, links: [tip, end]" in Path("bars.yaml").read_text(encoding="utf-8")
    rows = model.analyze()
    assert rows.complete
    assert rows["D.theta"][0] == pytest.approx(0.0, abs=1e-14)
    # and on to MuJoCo
    capsys.readouterr()
    assert export(Path("bars.yaml"), "mjcf", out=Path("out")) == 0
    assert capsys.readouterr().out == f"{Path('out', 'bars.xml')}\n"


@pytest.mark.parametrize(
    ("pair", "words"),
    [("tip", "expected two links"), ("tip:ent", "did you mean end"), ("tip:tip", "itself")],
)
def test_pairs_that_close_nothing(pair: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        imported_robot(ARM, "bars.urdf", (pair,))


def test_a_mechanism_that_cannot_be_read_is_told_of_the_file_it_comes_from(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("car.csv").write_text("A, 1, 2\n", encoding="utf-8")
    Path("car.yaml").write_text(
        "format: 1\nplane: xy\npoints: {A: {link: rod, at: [1, 2]}}\n", encoding="utf-8"
    )
    assert import_(Path("car.csv"), Path("out.yaml"), template="car.yaml") == 3
    assert "car.csv:1:1: error" in capsys.readouterr().err
    assert not Path("out.yaml").exists()
