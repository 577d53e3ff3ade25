"""URDF trees stand where their own chains of origins and axes put them, whatever their joints."""

from __future__ import annotations

import os
import random
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import imported_robot
from mechkin_cli.cli.bridges import import_

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
COUNT = 7
TYPES = ("revolute", "continuous", "prismatic", "planar", "floating", "fixed")
ONE = TYPES[:3]
PLACES = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])


def turn(axis: Any, angle: float) -> Any:
    """Rodrigues, as a displacement."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    found = np.eye(4)
    found[:3, :3] += np.sin(angle) * across + (1 - np.cos(angle)) * across @ across
    return found


def shift(way: Any) -> Any:
    found = np.eye(4)
    found[:3, 3] = way
    return found


class Joint:
    """A joint of a random tree, between link `parent` and the link of its own number."""

    def __init__(self, dice: random.Random, number: int) -> None:
        self.number, self.parent = number, dice.randrange(max(0, number - 3), number)
        self.kind = dice.choice(TYPES)
        self.place, self.angles, self.axis = (
            [round(dice.uniform(-2, 2), 3) for _ in range(3)] for _ in range(3)
        )
        self.leader: int | None = None
        self.ratio, self.offset = dice.uniform(-2, 2), dice.uniform(-1, 1)
        self.value = [dice.uniform(-1, 1) for _ in range(6)]
        roll, pitch, yaw = self.angles
        x, y, z = np.eye(3)
        self.origin = shift(self.place) @ turn(z, yaw) @ turn(y, pitch) @ turn(x, roll)

    def text(self) -> str:
        place, angles, axis = (" ".join(map(repr, v)) for v in (self.place, self.angles, self.axis))
        mimic = (
            f'<mimic joint="j{self.leader}" multiplier="{self.ratio!r}" offset="{self.offset!r}"/>'
            if self.leader
            else ""
        )
        return (
            f'<joint name="j{self.number}" type="{self.kind}"><parent link="l{self.parent}"/>'
            f'<child link="l{self.number}"/><origin xyz="{place}" rpy="{angles}"/>'
            f'<axis xyz="{axis}"/><limit lower="-9" upper="9"/>{mimic}</joint>'
        )

    def inputs(self) -> dict[str, float]:
        words = {
            "revolute": ["theta"],
            "continuous": ["theta"],
            "prismatic": ["s"],
            "planar": ["x", "y", "theta"],
            "floating": ["x", "y", "z", "rz", "ry", "rx"],
        }.get(self.kind, [])
        return (
            {}
            if self.leader
            else {f"j{self.number}.{w}": v for w, v in zip(words, self.value, strict=False)}
        )

    def moved(self, home: Any, x: Any) -> Any:
        """Its displacement; `home` is its frame in the drawing, `x` a planar one's first way."""
        axis, v = np.array(self.axis) / np.linalg.norm(self.axis), self.value
        if self.kind in ("revolute", "continuous"):
            return turn(axis, v[0])
        if self.kind == "prismatic":
            return shift(v[0] * axis)
        back = np.eye(4)
        back[:3, :3] = home[:3, :3].T
        if self.kind == "planar":
            way = back[:3, :3] @ x
            return shift(v[0] * way + v[1] * np.cross(axis, way)) @ turn(axis, v[2])
        if self.kind == "floating":
            ex, ey, ez = np.eye(3)
            own = shift(v[:3]) @ turn(ez, v[3]) @ turn(ey, v[4]) @ turn(ex, v[5])
            return back @ own @ back.T
        return np.eye(4)


@pytest.mark.parametrize("seed", range(6 * TIMES))
def test_random_trees(seed: int) -> None:
    dice = random.Random(seed)
    joints = [Joint(dice, number) for number in range(1, COUNT)]
    single = [joint for joint in joints if joint.kind in ONE]
    for one, other in zip(single[1::2], single[::2], strict=False):
        one.leader = other.number
        one.value[0] = one.ratio * other.value[0] + one.offset
    links = [f'<link name="l{number}"/>' for number in range(COUNT)]
    parts = [*links, *(joint.text() for joint in joints)]
    dice.shuffle(parts)
    text = "\n".join(["<robot>", *(f"\t{part}" for part in parts), "</robot>"])
    found = imported_robot(text, "tree.urdf").text
    homes, frames = [np.eye(4)], [np.eye(4)]
    for joint in joints:
        homes.append(homes[joint.parent] @ joint.origin)
        written = re.search(rf"  j{joint.number}:.*?x: \[([^]]*)\]", found, re.DOTALL)
        x = np.array(list(map(float, written[1].split(",")))) if joint.kind == "planar" else None  # type: ignore[index]
        moved = joint.moved(homes[-1], x)
        frames.append(frames[joint.parent] @ joint.origin @ moved)
    points = (
        "".join(
            f"  p{number}_{k}: {{link: l{number}, at: {list((home @ [*place, 1])[:3])}}}\n"
            for number, home in enumerate(homes[1:], 1)
            for k, place in enumerate(PLACES)
        )
        .replace("np.float64(", "")
        .replace(")", "")
    )
    driven = {name: value for joint in joints for name, value in joint.inputs().items()}
    assert set(re.findall(r"^    ([\w.]+): \{(?:at|from)", found, re.MULTILINE)) == set(driven)
    motion = "".join(f"    {name}: {{at: {value!r}}}\n" for name, value in driven.items())
    found = re.sub(r"(  inputs:[^\n]*\n)(?:    .*\n)+", lambda m: m[1] + motion, found)
    rows = mk.loads(found.replace("\npoints:\n", f"\npoints:\n{points}")).analyze()
    for number, frame in enumerate(frames[1:], 1):
        for k, place in enumerate(PLACES):
            place_here = rows[f"p{number}_{k}.position"][0]
            assert np.abs(place_here - (frame @ [*place, 1])[:3]).max() < 1e-9, number


def test_what_is_called_otherwise_is_told() -> None:
    text = (
        '<robot name="r"><link name="base"/><link name="left/arm"/><link name="left arm"/>'
        '<joint name="1st" type="floating"><parent link="base"/><child link="left/arm"/>'
        '<dynamics damping="1"/></joint><joint name="k" type="revolute"><parent link="left/arm"/>'
        '<child link="left arm"/></joint></robot>'
    )
    found = imported_robot(text, "arm.urdf")
    assert [note.message for note in found.notes] == [
        "renamed: left/arm is left_arm, left arm is left_arm_2, 1st is _1st",
        "left out: damping of floating and planar joints: 1st",
    ]
    assert "# Renamed: left/arm is left_arm," in found.text


def test_names_that_mean_something_else_in_a_mechanism_file() -> None:
    words = ["null", "~", "true", "ground", "pi", "theta"]
    links = "".join(f'<link name="{word}"/>' for word in ["base", *words])
    joints = "".join(
        f'<joint name="{word}" type="planar"><parent link="base"/><child link="{word}"/></joint>'
        for word in words
    )
    found = imported_robot(f"<robot>{links}{joints}</robot>", "arm.urdf")
    assert mk.loads(found.text).analyze().complete
    assert len(mk.loads(found.text).problem.mechanism.joints) == len(words)


def test_a_robot_that_does_not_move_is_refused() -> None:
    with pytest.raises(mk.InvalidFile, match=r"r\.urdf:1:1: .* nothing that moves; add a joint"):
        imported_robot('<robot name="r"><link name="base"/></robot>', "r.urdf")


def test_tabs_may_indent_a_file(tmp_path: Path) -> None:
    """As in many robot files; YAML alone has none of them."""
    file = tmp_path / "arm.urdf"
    file.write_text(
        '<robot name="r">\n\t<link name="a"/>\n\t<link name="b"/>\n\t<joint name="j" '
        'type="continuous">\n\t\t<parent link="a"/>\n\t\t<child link="b"/>\n\t</joint>\n</robot>\n'
    )
    assert import_(file, out=tmp_path / "arm.yaml") == 0
    assert mk.load(tmp_path / "arm.yaml").analyze().complete
