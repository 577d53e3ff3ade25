"""Mechanisms in plain numbers for scripts of other libraries (`scripts/sweep.py`), and the same
table as a mechanism file.

A problem is a tree of hinges and slides with axes and points as drawn, spots on its links, pairs of
spots that coincide (of which `kept` components are independent), pairs that keep a length, and the
rows: driven joints, then lengths, with rates and accelerations. SI.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import mechkin_cli as mk
from benchmarks.scenes import texts

if TYPE_CHECKING:
    from mechkin_cli.mechanism.vectors import Vector
    from mechkin_cli.model.model import Model

GROUND = -1
ORDERS = ("", "_dot", "_ddot")
POINT_ORDERS = ("position", "velocity", "acceleration")
ALL = (0, 1, 2)


class Script(NamedTuple):
    """The problem of a mechanism, and the text of its file with the same table."""

    problem: dict[str, Any]
    text: str


def scripts() -> dict[str, Callable[[], Script]]:
    """By the mechanism's name."""
    return {"RCSR": rcsr, "7R": sevenr, "Stewart": stewart}


def rcsr() -> Script:
    """The crank, the cylinder as a hinge and a slide, the rocker; a ball closes the loop."""
    tree = _Tree("RCSR")
    crank = tree.joint("O1", "R")
    turned = tree.joint("O2", "R", crank)
    coupler = tree.joint("O2", "P", turned, name="O2 slide")
    rocker = tree.joint("O4", "R")
    ball = tree.joints["O3"]
    tree.pair(coupler, ball.on_first.o, rocker, ball.on_second.o)
    near = tree.model.problem.assembly.near
    for number, name in ((turned, "O2.theta"), (coupler, "O2.s"), (rocker, "O4.theta")):
        tree.start[number] = near[name]
        tree.told(number, name)
    return tree.script([crank])


def sevenr() -> Script:
    """Seven hinges one after the other; three spots hold the last link to the ground."""
    tree, last = _Tree("7R"), GROUND
    for k in range(1, 8):
        last = tree.joint(f"J{k}", "R", last)
        if k > 1:
            tree.told(last, f"J{k}.theta")
    x, y, z = tree.joints["J7"].on_first.o
    for spot, kept in (((x, y, z), ALL), ((x + 1, y, z), (1, 2)), ((x, y + 1, z), (2,))):
        tree.pair(last, spot, GROUND, spot, kept)
    return tree.script([0])


def stewart() -> Script:
    """The platform on three slides and three hinges; six legs keep driven lengths."""
    tree, last = _Tree("Stewart"), GROUND
    axes = np.eye(3)
    centre = (0.0, 0.0, float(tree.model.problem.parameters["h"].value))  # type: ignore[arg-type]
    for kind in "PR":
        for k, axis in enumerate(axes):
            last = tree.add(f"{kind}{'xyz'[k]}", kind, last, axis, centre)
    for k in range(1, 7):
        foot, head = (tree.joints[f"{end}{k}"].on_first.o for end in "AB")
        tree.length(f"L{k}.s", foot, last, head)
    tree.points("tool", last)
    return tree.script([])


class _Tree:
    """Collects a problem from a known mechanism."""

    def __init__(self, name: str) -> None:
        self.name, self.text = name, texts()[name]()
        self.model: Model = mk.loads(self.text)
        self.joints = self.model.problem.mechanism.joints
        self.tree: list[dict[str, Any]] = []
        self.start: dict[int, float] = {}
        self.spots: list[dict[str, Any]] = []
        self.pairs: list[list[int]] = []
        self.kept: list[list[int]] = []
        self.lengths: list[list[int]] = []
        self.leg_inputs: list[str] = []
        self.outputs: list[dict[str, Any]] = []

    def joint(self, joint: str, kind: str, parent: int = GROUND, name: str = "") -> int:
        frame = self.joints[joint].on_first
        return self.add(name or joint, kind, parent, frame.z, frame.o)

    def add(self, name: str, kind: str, parent: int, axis: Any, point: Any) -> int:
        at = {"axis": _numbers(axis), "point": _numbers(point)}
        self.tree.append({"name": name, "kind": kind, "parent": parent, **at})
        return len(self.tree) - 1

    def spot(self, joint: int, place: Any) -> int:
        self.spots.append({"joint": joint, "place": _numbers(place)})
        return len(self.spots) - 1

    def pair(
        self, one: int, on_one: Any, other: int, on_other: Any, kept: Sequence[int] = ALL
    ) -> None:
        self.pairs.append([self.spot(one, on_one), self.spot(other, on_other)])
        self.kept.append(list(kept))

    def length(self, driven: str, foot: Vector, joint: int, head: Vector) -> None:
        self.lengths.append([self.spot(GROUND, foot), self.spot(joint, head)])
        self.leg_inputs.append(driven)

    def told(self, joint: int, name: str) -> None:
        for order, suffix in enumerate(ORDERS):
            self.outputs.append({"label": name + suffix, "joint": joint, "order": order})

    def points(self, name: str, joint: int) -> None:
        spot = self.spot(joint, self.model.problem.mechanism.points[name].vector)
        for order, words in enumerate(POINT_ORDERS):
            for axis, letter in enumerate("xyz"):
                label = f"{name}.{words}.{letter}"
                self.outputs.append({"label": label, "spot": spot, "axis": axis, "order": order})

    def script(self, driven: list[int]) -> Script:
        motion = {item.name: item for item in self.model.problem.motion.inputs}
        names = [f"{self.tree[k]['name']}.theta" for k in driven] + self.leg_inputs
        rest = np.zeros(len(names))
        for k, (one, other) in enumerate(self.lengths):
            span = np.subtract(self.spots[other]["place"], self.spots[one]["place"])
            rest[len(driven) + k] = np.linalg.norm(span)
        values, rates, accelerations = (
            np.array([getattr(motion[name], order) for name in names]).T
            for order in ("values", "rates", "accelerations")
        )
        problem = {
            "name": self.name,
            "joints": self.tree,
            "start": [self.start.get(k, 0.0) for k in range(len(self.tree))],
            "spots": self.spots,
            "pairs": self.pairs,
            "kept": self.kept,
            "lengths": self.lengths,
            "driven": driven,
            "rows": (values + rest).tolist(),
            "rates": rates.tolist(),
            "accelerations": accelerations.tolist(),
            "outputs": self.outputs,
        }
        columns = ", ".join(output["label"] for output in self.outputs)
        text = self.text.partition("\ntables:")[0].rstrip()
        return Script(problem, f"{text}\ntables: [{{name: motion, columns: [{columns}]}}]\n")


def _numbers(values: Any) -> list[float]:
    return [float(value) for value in values]
