"""Robot files made at random, and read by MuJoCo, which is asked where their bodies are and what
their joints need."""

from __future__ import annotations

import random
import re
from typing import Any

import mujoco
import numpy as np

import mechkin_cli as mk
from mechkin_cli.bridges import imported_robot

MARKS = ((0.0, 0.0, 0.0), (0.3, -0.2, 0.1), (-0.1, 0.4, 0.2))
"""Places in the drawing that every body carries."""


def numbers(dice: random.Random, count: int, size: float = 1.0) -> str:
    return " ".join(f"{dice.uniform(-size, size):.4f}" for _ in range(count))


def urdf(seed: int) -> str:
    """A tree of seven links with every type of joint that has coordinates or none."""
    dice = random.Random(seed)
    kinds = ["revolute", "continuous", "prismatic", "fixed", "revolute", "prismatic"]
    dice.shuffle(kinds)
    text = [
        '<robot name="tree"><mujoco><compiler fusestatic="false"/></mujoco>',
        '<link name="l0"/>',
    ]
    for number, kind in enumerate(kinds, 1):
        text.append(
            f'<link name="l{number}"><inertial><origin xyz="{numbers(dice, 3, 0.2)}" '
            f'rpy="{numbers(dice, 3)}"/><mass value="{dice.uniform(0.5, 2):.3f}"/>'
            '<inertia ixx="0.03" iyy="0.04" izz="0.05" ixy="0.002" ixz="-0.003" iyz="0.001"/>'
            "</inertial></link>"
        )
        text.append(
            f'<joint name="j{number}" type="{kind}"><parent link="l{dice.randrange(number)}"/>'
            f'<child link="l{number}"/>'
            f'<origin xyz="{numbers(dice, 3)}" rpy="{numbers(dice, 3, 3)}"/>'
            f'<axis xyz="{numbers(dice, 3)}"/><dynamics damping="{dice.uniform(0, 1):.3f}"/>'
            '<limit lower="-9" upper="9" effort="1" velocity="1"/></joint>'
        )
    return "\n".join([*text, "</robot>"])


def mjcf(seed: int) -> str:
    """A tree whose bodies have several joints, ways to be turned, classes and geoms."""
    dice = random.Random(seed)
    angle = dice.choice(["degree", "radian"])
    turns = [
        lambda: f'euler="{numbers(dice, 3)}"',
        lambda: f'quat="{numbers(dice, 4)}"',
        lambda: f'axisangle="{numbers(dice, 4)}"',
        lambda: f'xyaxes="{numbers(dice, 6)}"',
        lambda: f'zaxis="{numbers(dice, 3)}"',
    ]
    geoms = [
        lambda: f'type="capsule" fromto="{numbers(dice, 6)}" size="0.05"',
        lambda: f'type="box" size="0.1 0.2 0.3" pos="{numbers(dice, 3)}" {dice.choice(turns)()}',
        lambda: f'type="ellipsoid" size="0.1 0.2 0.3" {dice.choice(turns)()} mass="1.5"',
        lambda: f'type="cylinder" size="0.1 0.2" pos="{numbers(dice, 3)}" {dice.choice(turns)()}',
        lambda: 'type="sphere" size="0.2"',
    ]
    inertials = [
        lambda: '<inertial pos="0.1 0 0" mass="2" fullinertia="0.3 0.4 0.5 0.02 0.01 -0.03"/>',
        lambda: (
            f'<inertial pos="0 0 0.1" {dice.choice(turns)()} mass="1" diaginertia="0.3 0.4 0.5"/>'
        ),
        lambda: "".join(f"<geom {dice.choice(geoms)()}/>" for _ in range(2)),
    ]
    sets = (
        ["hinge"],
        ["slide"],
        ["hinge", "slide"],
        ["slide", "slide", "hinge"],
        ["hinge"] * 2,
        [],
    )
    bodies = []
    for number in range(5):
        kinds = dice.choice(sets)
        axes, places = ([numbers(dice, 3, 0.8) for _ in kinds] for _ in range(2))
        if dice.random() < 0.5 and len(kinds) > 1:
            # one pair of several freedoms: E, C, or U where no ref is in its way
            axes = ["1 0 0", "0 1 0", "0 0 1"] if len(kinds) == 3 else axes
            axes = axes[:1] * 2 if kinds == ["hinge", "slide"] else axes
            places = places[:1] * 3
        refs = dice.choice([["0"] * 3, ["0.4", "0", "-0.3"]])
        joints = "".join(
            f'<joint name="q{number}.{k}" type="{kind}" axis="{axes[k]}" '
            f'pos="{places[k]}" ref="{refs[k]}"/>'
            for k, kind in enumerate(kinds)
        )
        bodies.append(
            f'<frame pos="0 0 0.1"><body name="b{number}" pos="{numbers(dice, 3)}" '
            f"{dice.choice(turns)()}>{joints}{dice.choice(inertials)()}"
        )
    ends = "</body></frame>" * len(bodies)
    return (
        f'<mujoco><compiler angle="{angle}" eulerseq="{dice.choice(["xyz", "ZYX", "zxz"])}"/>'
        '<default><geom density="700"/><joint damping="0.2"/></default>'
        f"<worldbody>{''.join(bodies)}{ends}</worldbody></mujoco>"
    )


def drawn(model: Any) -> Any:
    """MuJoCo's data of a model as it is drawn."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return data


def check(text: str, seed: int) -> int:
    """Compares places of bodies and what joints need at a random state; gives the number of
    coordinates."""
    dice = np.random.default_rng(seed)
    model = mujoco.MjModel.from_xml_string(text)
    for flag in (mujoco.mjtDisableBit.mjDSBL_CONTACT, mujoco.mjtDisableBit.mjDSBL_LIMIT):
        model.opt.disableflags |= flag
    found = imported_robot(text, "robot").text
    moving = {}
    links = re.findall(r"^  (\w+):", found.partition("\njoints:")[0], re.MULTILINE)
    bodies = [name for name in links if mujoco.mj_name2id(model, 1, name) >= 0]
    assert len(bodies) == model.nbody - 1 - ("urdf" in found.casefold())
    points = {f"{body}_mark{k}": (body, mark) for body in bodies for k, mark in enumerate(MARKS)}
    section = "points:\n" + "".join(
        f"  {name}: {{link: {body}, at: {list(mark)}}}\n" for name, (body, mark) in points.items()
    )
    head, sep, tail = found.partition("\npoints:\n")
    found = (
        f"{head}\n{section}{tail}"
        if sep
        else found.replace("\njoints:", f"\n{section}\njoints:", 1)
    )
    inputs = re.findall(r"^    ([\w.]+): \{(?:at|from)", found, re.MULTILINE)
    for name in inputs:
        moving[name] = dice.uniform(-0.5, 0.5, 3)
    motion = "".join(
        f"    {name}: {{at: {q!r} {u}, rate: {v!r} {u}/s, acceleration: {a!r} {u}/s^2}}\n"
        for name, (q, v, a) in ((n, map(float, m)) for n, m in moving.items())
        for u in ["m" if name.split(".")[-1] in ("s", "x", "y") else "rad"]
    )
    found = re.sub(r"(  inputs:[^\n]*\n)(?:    .*\n)+", lambda m: m[1] + motion, found)
    ours = mk.loads(found).analyze()
    home, data = drawn(model), mujoco.MjData(model)
    for name, (q, v, a) in moving.items():
        joint = own_joint(model, name)
        place, rate = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        data.qpos[place], data.qvel[rate], data.qacc[rate] = q, v, a
    mujoco.mj_inverse(model, data)
    for name, (body, mark) in points.items():
        number = mujoco.mj_name2id(model, 1, body)
        local = home.xmat[number].reshape(3, 3).T @ (mark - home.xpos[number])
        place = data.xpos[number] + data.xmat[number].reshape(3, 3) @ local
        assert np.abs(ours[f"{name}.position"][0] - place).max() < 1e-9, name
    for name in moving:
        joint = own_joint(model, name)
        effort = next(w for w in (f"{name}.effort", f"{name.split('.')[0]}.effort") if w in ours)
        needed = data.qfrc_inverse[model.jnt_dofadr[joint]]
        assert abs(ours[effort][0] - needed) < 1e-8 * max(1.0, abs(needed)), (
            name,
            needed,
            ours[effort],
        )
    return len(moving)


def own_joint(model: Any, coordinate: str) -> int:
    """MuJoCo's joint of a coordinate: of a pair with several by its order in the body."""
    owner, _, word = coordinate.partition(".")
    number = mujoco.mj_name2id(model, 3, owner)
    if number >= 0:
        return number
    for mark in (r".\1", ""):  # a name that had a dot, or that a body has, too
        number = mujoco.mj_name2id(model, 3, re.sub(r"_(\d+)$", mark, owner))
        if number >= 0 and word in ("theta", "s"):
            return number
    first = mujoco.mj_name2id(model, 3, f"{owner}.0")
    kinds = {"theta": 3, "s": 2}
    body = model.jnt_bodyid[first]
    own = [j for j in range(model.njnt) if model.jnt_bodyid[j] == body]
    if word in ("x", "y", "theta1", "theta2"):
        return own[{"x": 0, "y": 1, "theta1": 0, "theta2": 1}[word]]
    return next(j for j in own if model.jnt_type[j] == kinds[word])
