"""A random mechanism with the oracle's answers for one row."""

from __future__ import annotations

from dataclasses import dataclass

from oracle import Mechanism, Reactions, Solution


@dataclass(frozen=True)
class Case:
    """A random mechanism as text, and what the oracle says about one row.

    `condition` is the largest over the smallest singular value of all constraints there.
    """

    text: str
    mechanism: Mechanism
    row: int
    solution: Solution
    reactions: Reactions
    condition: float

    @property
    def size(self) -> float:
        return float(self.mechanism.size)

    @property
    def types(self) -> str:
        return "-".join(joint.type for joint in self.mechanism.joints.values())
