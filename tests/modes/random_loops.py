"""Random single loops that close in a known pose, drawn in different ways, and their assemblies as
places of marks on the links."""

from __future__ import annotations

import random
from dataclasses import dataclass

import numpy as np

import mechkin_cli as mk
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.outputs import OutputPlan, Readout
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.search.search import Assemblies, assemblies
from mechkin_cli.session.assembled_places import solver_graph
from mechkin_cli.session.inputs import kernel_inputs
from mechkin_cli.session.kernel_run import Ask, RowInputs, run

FREEDOMS = {"R": 1, "P": 1, "C": 2, "S": 3, "Sg": 4, "Sp": 5}
MARKS = np.array([[0.3, 0.1, -0.2], [-0.4, 0.5, 0.1], [0.2, -0.3, 0.6]])
WORST_CONDITION = 1e4


def random_letters(rng: random.Random) -> list[str]:
    """Seven freedoms, R or P first, at most one sphere and three slides, so that the general loop
    has mobility one."""
    while True:
        letters = rng.choices(
            ["R", "P", "C", "S", "Sg", "Sp"], [4, 1, 2, 2, 1, 1], k=rng.randint(3, 7)
        )
        slides = sum(letters.count(pair) for pair in "PC")
        spheres = sum(letters.count(pair) for pair in ("S", "Sg", "Sp"))
        slides += letters.count("Sg") + 2 * letters.count("Sp")
        freedom = sum(FREEDOMS[pair] for pair in letters)
        if freedom == 7 and letters[0] in "RP" and spheres <= 1 and slides <= 3:
            return letters


def rotation(rng: random.Random) -> np.ndarray:
    q, r = np.linalg.qr([[rng.gauss(0, 1) for _ in range(3)] for _ in range(3)])
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


@dataclass
class Loop:
    """Pairs in the order of the loop, in the pose in which it closes; joint k is between link k and
    link k+1 (0 and the last are ground)."""

    letters: list[str]
    points: np.ndarray
    axes: np.ndarray
    squares: np.ndarray

    def text(
        self,
        turns: list[np.ndarray] | None = None,
        shifts: np.ndarray | None = None,
        order: int = 0,
    ) -> str:
        """The file with link k displaced by (turns[k], shifts[k]) in its drawing, its joints listed
        from number `order` on."""
        count = len(self.letters)
        turns = turns or [np.eye(3)] * count
        shifts = np.zeros((count, 3)) if shifts is None else shifts
        names = ["ground", *(f"L{k}" for k in range(1, count))]
        joints = []
        for k, letter in enumerate(self.letters):
            pair = (k, (k + 1) % count)

            def each(
                key: str, vector: np.ndarray, shifted: bool, pair: tuple[int, int] = pair
            ) -> str:
                places = (turns[i] @ vector + (shifts[i] if shifted else 0.0) for i in pair)
                texts = (f"{names[i]}: {v.tolist()}" for i, v in zip(pair, places, strict=True))
                return f"{key}: {{{', '.join(texts)}}}"

            keys = [each("point", self.points[k], True)]
            if letter in "RPC":
                keys += [each("axis", self.axes[k], False), each("zero", self.squares[k], False)]
            elif letter != "S":
                keys.append(each("normal" if letter == "Sp" else "groove", self.axes[k], False))
            links = ", ".join(names[i] for i in pair)
            joints.append(f"  J{k}: {{type: {letter}, links: [{links}], {', '.join(keys)}}}")
        marks = [
            f"  m{k}_{i}: {{link: {names[k]}, at: {(turns[k] @ mark + shifts[k]).tolist()}}}"
            for k in range(1, count)
            for i, mark in enumerate(MARKS)
        ]
        lines = [
            "format: 1",
            f"links: {{{', '.join(f'{name}: {{}}' for name in names[1:])}}}",
            "joints:",
            *joints[order:],
            *joints[:order],
            "points:",
            *marks,
            f"motion: {{inputs: {{J0.{'s' if self.letters[0] == 'P' else 'theta'}: {{at: 0}}}}}}",
        ]
        return "\n".join(lines) + "\n"


def random_loop(rng: random.Random) -> Loop:
    letters = random_letters(rng)
    points = np.array([[rng.uniform(-1, 1) for _ in range(3)] for _ in letters])
    frames = [rotation(rng) for _ in letters]
    return Loop(letters, points, np.array([f[0] for f in frames]), np.array([f[1] for f in frames]))


def search(text: str, closed_at: list[str] | None = None) -> tuple[Assemblies, np.ndarray]:
    """The random starts' assemblies alone, and their marks (assemblies, marks, 3)."""
    problem = mk.loads(text).problem
    graph = solver_graph(problem.mechanism, problem.motion.driven, closed_at)
    layout = Layout(problem.mechanism, graph)
    plan = build_plan(layout)
    inputs = kernel_inputs(problem, layout).values[:, 0]
    found = assemblies(layout, plan, inputs, thorough=False)
    plan = build_plan(layout)
    outputs = OutputPlan(layout, plan, problem.motion.driven)
    slots = [outputs.add_point(at, 0) for at in problem.mechanism.points.values()]
    if found.number == 0:
        return found, np.empty((0, len(slots), 3))
    values = np.repeat(inputs[:, None], found.number, axis=1)
    ask = Ask(readout=Readout(outputs.outputs, {}, slots))
    places = run(plan, RowInputs(values, found.states), ask).outputs
    assert places is not None
    return found, np.stack([places[s : s + 3] for s in slots]).transpose(2, 0, 1)


def home_marks(loop: Loop) -> np.ndarray:
    return np.tile(MARKS, (len(loop.letters) - 1, 1))


def same(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Largest difference of marks between all pairs: (ones, others)."""
    return np.abs(one[:, None] - other[None]).reshape(len(one), len(other), -1).max(axis=2)
