"""Random loops and chains whose joints rub, against dense Newton-Euler equations from event to
event (`oracle.dynamics.rubbing`).

    python -m random_families.rubbing_loops 0:100 [--motion-alone]

from `tests/` prints how each ended, its error and evaluations, and counts those that are lost,
wrong or slow. The exit code is 1 if any is.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from typing import Any, NamedTuple

import numpy as np
from oracle.document import document, to_text
from oracle.dynamics.rubbing import Rubbed, Undecided
from random_families.response.drawing import drawing

import mechkin_cli as mk

_RADIUS = {"R": True, "P": False, "C": True, "H": True, "S": True, "Sp": False, "Sg": False}
"""Joints that rub, and whether by a radius."""
_SLOW, _WRONG = 50_000, 1e-9
"""Evaluations within which all ends that does not creep, twenty times the usual most; errors."""
_TOLD = ("ok", "friction-undecided", "singular-inertia")
"""How a motion may end: another word is wrong here, as nothing crosses a branch."""


class Judged(NamedTuple):
    """How a motion ended, after how many evaluations, its largest error in rad, m and s (nan
    where it is not known), and what the reference says."""

    word: str
    evaluations: int
    error: float
    remark: str

    @property
    def fault(self) -> str:
        if self.word not in _TOLD:
            return "lost"
        if self.error > _WRONG:
            return "wrong"
        return "slow" if self.evaluations > _SLOW else ""


def rubbing_loop(seed: int) -> str | None:
    """The text of a mechanism; None where none of its joints rubs."""
    data, rng = document(drawing(seed)), random.Random(seed + 10**6)
    names = [name for name, joint in data["joints"].items() if joint["type"] in _RADIUS]
    rng.shuffle(names)
    for name in names[: rng.randint(1, min(4, len(names))) if names else 0]:
        static = round(rng.uniform(0.01, 0.2), 3)
        load: dict[str, Any] = {"type": "friction", "joint": name, "coefficient": str(static)}
        if rng.random() >= 0.5:
            sliding = str(round(static * rng.uniform(0.6, 1), 4))
            load["coefficient"] = {"static": str(static), "sliding": sliding}
        if _RADIUS[data["joints"][name]["type"]]:
            load["radius"] = str(round(rng.uniform(0.02, 0.2), 3))
        data["loads"].append(load)
    response = data["responses"]["run"]
    response["time"] = {"from": "0", "to": "1.2", "count": "13"}
    if rng.random() < 0.5:
        rates = [key for key in response["start"] if key.endswith("_dot")]
        response["start"].update(dict.fromkeys(rates, "0"))
    return to_text(data) if names else None


def judge(text: str, motion_alone: bool = False) -> Judged:
    """The response of a text against the reference, or only how it ends."""
    found = mk.loads(text).respond()
    evaluations = found.result.report.evaluations
    moves = np.isfinite(np.array(found["row.kinetic_energy"], dtype=float))
    word = "ok" if moves.all() else str(found["row.status"][-1])
    if word != "ok" or motion_alone:
        return Judged(word, evaluations, np.nan, "")
    reference = Rubbed(text, found.run)
    try:
        nodes = reference.run()
    except Undecided as reason:
        return Judged(word, evaluations, np.nan, str(reason))
    motion, error = reference.motion, 0.0
    for row, (state, turns) in enumerate(nodes):
        motion.turns = turns
        at = motion.posture(state)
        rows = motion.counted @ motion.drawn.relations.jacobian(at)
        rates = rows @ np.hstack([at.v, at.w])[:-1].ravel()
        values = motion.counted @ motion.relations(state)
        for name, value, rate in zip(motion.drawn.coordinates, values, rates, strict=True):
            unit = np.pi / 180 if found.unit(name) == "deg" else 1.0
            for have, want in ((unit * found[name][row], value), (found[f"{name}_dot"][row], rate)):
                error = max(error, abs(float(have) - want) / max(1.0, abs(want)))
    return Judged(word, evaluations, error, f"{reference.events} events")


def main() -> int:
    first, last = map(int, sys.argv[1].split(":"))
    counts: Counter[str] = Counter()
    for seed in range(first, last):
        text = rubbing_loop(seed)
        if text is None:
            continue
        found = judge(text, "--motion-alone" in sys.argv)
        counts[found.word] += 1
        counts[found.fault] += 1
        print(seed, found.word, found.evaluations, f"{found.error:.1e}", found.remark)
    print({word: count for word, count in counts.items() if word})
    return 1 if any(counts[fault] for fault in ("lost", "wrong", "slow")) else 0


if __name__ == "__main__":
    sys.exit(main())
