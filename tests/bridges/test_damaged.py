"""Damaged tables and robot files: each is imported, or refused with its place and a cure; none ends
in a traceback. `MECHKIN_RANDOM=40` tries some 2 000."""

from __future__ import annotations

import os
import random
import re

import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import imported_robot, with_hard_points
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place, UsageError
from mechkin_cli.templates import template_text

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

TABLE = """\
name,x [mm],y [mm],z [mm]
lower_ball,0,700,190
# a comment
"upper_ball",-12,660.5,465
wheel,0,760,3.1e2
"""

URDF = """\
<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="upper">
    <inertial><origin xyz="0 0 0.2" rpy="0.1 0 0"/><mass value="2"/>
      <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="fore"/><link name="tool"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.1" rpy="0.2 -0.3 0.4"/><axis xyz="0 1 0.5"/>
    <limit lower="-1" upper="2" effort="10" velocity="3"/><dynamics damping="0.5"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/>
    <origin xyz="0 0.05 0.4"/><axis xyz="1 0 0"/><mimic joint="shoulder" multiplier="-2"/></joint>
  <joint name="ram" type="prismatic"><parent link="fore"/><child link="tool"/></joint>
</robot>
"""

MJCF = """\
<mujoco model="four bar">
  <compiler angle="degree" eulerseq="xyz"/>
  <default>
    <default class="bar"><geom type="capsule" size="0.01" density="2000"/></default>
  </default>
  <worldbody>
    <body name="crank" childclass="bar"><joint name="A" axis="0 1 0" range="-170 170"/>
      <geom fromto="0 0 0 0 0 0.2"/>
      <body name="coupler" pos="0 0 0.2"><joint name="B" axis="0 1 0"/>
        <geom fromto="0 0 0 0.5 0 0.1"/><site name="tip" pos="0.5 0 0.1"/></body>
    </body>
    <body name="rocker" pos="0.5 0 0" euler="0 0 10"><joint name="D" axis="0 1 0" ref="3"/>
      <inertial pos="0 0 0.1" mass="1" diaginertia="1 1 1"/><site name="end" pos="0 0 0.3"/></body>
  </worldbody>
  <tendon><fixed name="t"><joint joint="A" coef="1"/><joint joint="D" coef="-2"/></fixed></tendon>
  <equality><connect site1="tip" site2="end"/><joint joint1="A" polycoef="0.1 0 0 0 0"/></equality>
</mujoco>
"""

HOSTILE = [
    *("nan", "inf", "-1e308", "1e999", "0", "-0", "", " ", '"', "<", ">", "&", "&amp;", "'", "/"),
    *("\x00", "\ufeff", "é", "\u2028", "-1", "1 2", "1,2", "0x10", "1_0", "base", "world", "A"),
    *("9" * 400, "x" * 300, "{", "}", "[", ":", "#", "\n", "\t", "%", "<!--", "]]>", "<?x"),
]


def damaged(text: str, dice: random.Random) -> str:
    """A text with one to three faults of many kinds."""
    for _ in range(dice.randint(1, 3)):
        words = [found.span() for found in re.finditer(r"[\w.+-]+", text)]
        kind = dice.randrange(7)
        at, end = dice.choice(words) if words else (0, 0)
        lines = text.split("\n")
        if kind == 0:
            text = text[:at] + dice.choice(HOSTILE) + text[end:]
        elif kind == 1:
            place = dice.randrange(len(text) + 1)
            text = text[:place] + dice.choice(HOSTILE) + text[place:]
        elif kind == 2:
            text = text[: dice.randrange(len(text) + 1)]
        elif kind == 3:
            text = text[:at] + text[end:]
        elif kind == 4 and len(lines) > 1:
            lines.insert(dice.randrange(len(lines)), dice.choice(lines))
            text = "\n".join(lines)
        elif kind == 5 and len(lines) > 1:
            lines.pop(dice.randrange(len(lines)))
            text = "\n".join(lines)
        else:
            other = dice.choice(words) if words else (0, 0)
            text = text[:at] + text[other[0] : other[1]] + text[end:]
    return text


@pytest.mark.parametrize("what", ["table", "urdf", "mjcf"])
def test_damaged_files_end_with_place_and_cure(what: str) -> None:
    source = {"table": TABLE, "urdf": URDF, "mjcf": MJCF}[what]
    ends = {"imported": 0, "refused": 0}
    for seed in range(17 * TIMES):
        text = damaged(source, random.Random(f"{what} {seed}"))
        diagnostics: tuple[Diagnostic, ...] = ()
        try:
            if what == "table":
                found = with_hard_points(text, "file", template_text("suspension"), "suspension")
            else:
                found = imported_robot(text, "file")
        except InvalidFile as error:
            diagnostics = error.diagnostics
        except UsageError as error:
            # a unit that is none
            diagnostics = (Diagnostic("usage", "error", str(error), Place("file", 1, 1), hint="-"),)
        if not diagnostics:
            mk.loads(found.text)
        for one in diagnostics:
            place = one.place or Place("", 0, 0)
            assert (place.file, place.line > 0, bool(one.hint)) == ("file", True, True), (seed, one)
        ends["refused" if diagnostics else "imported"] += 1
    assert min(ends.values()) > 0 or TIMES == 1, ends


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('<!DOCTYPE r [<!ENTITY a "b"><!ENTITY c "&a;&a;">]><robot name="&c;"/>', "document type"),
        ("<robot>" + "<a>" * 1000, "nested deeper"),
        ("<mujoco>" + "<a/>" * 30_000 + "</mujoco>", "elements at most"),
        ("<robot", "no XML"),
        ("", "no XML"),
        ("<svg/>", "is no robot"),
        ('<mujoco><worldbody/><include file="x.xml"/></mujoco>', "<include> is not read"),
    ],
)
def test_hostile_files_are_refused_early(text: str, words: str) -> None:
    with pytest.raises(InvalidFile, match=words):
        imported_robot(text, "file")
