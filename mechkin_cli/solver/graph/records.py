"""What a solver graph consists of: tree edges, closings, blocks; the error where there is none."""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.diagnostics import Diagnostic, MechkinError
from mechkin_cli.mechanism.legs import Leg
from mechkin_cli.mechanism.model import Joint


class UnsolvableGraph(MechkinError):
    """The mechanism's graph cannot be solved as it is driven; `diagnostic` says why, `joints`
    where. Where too little is driven, `missing` counts the freedoms left and `candidates` are
    coordinates that could be driven."""

    def __init__(
        self,
        diagnostic: Diagnostic,
        joints: tuple[str, ...] = (),
        missing: int = 0,
        candidates: tuple[str, ...] = (),
    ) -> None:
        self.diagnostic = diagnostic
        self.joints = joints
        self.missing = missing
        self.candidates = candidates
        super().__init__(str(diagnostic))


class TreeEdge(NamedTuple):
    """A joint of the tree: it carries `child`; `forward` where the child is the joint's second
    link.

    The body of a leg is `hung`: two points place it, it has no freedom of its own.
    """

    joint: Joint
    parent: str
    child: str
    hung: bool = False

    @property
    def forward(self) -> bool:
        """Whether the tree passes the joint from its first link to its second."""
        return self.child == self.joint.second

    @property
    def freedoms(self) -> int:
        """Unknown or driven freedoms."""
        return 0 if self.hung else self.joint.type.freedoms


class Closing(NamedTuple):
    """A closing joint; `loop` holds the tree edges on the way to its second (+1) and first link
    (-1).

    Of a leg it is the sphere at the end; the ways lead to the links that the leg joins, and its
    slide counts -1.
    """

    joint: Joint
    loop: tuple[tuple[int, int], ...]
    leg: Leg | None = None

    @property
    def equations(self) -> int:
        """Number of closing equations."""
        return 1 if self.leg else self.joint.type.equations


class Block(NamedTuple):
    """Closing joints (by index) that are solved together for unknown coordinates (edge,
    freedom); the last `charts` of its equations are those of a chart (`charted`)."""

    closings: tuple[int, ...]
    unknowns: tuple[tuple[int, int], ...]
    equations: int
    charts: int = 0


class SolverGraph(NamedTuple):
    """Tree edges in placing order (edge k carries link k), closings in block order, blocks.

    `inputs` are (edge, freedom), `driven` the same as (joint, coordinate).
    """

    edges: tuple[TreeEdge, ...]
    closings: tuple[Closing, ...]
    blocks: tuple[Block, ...]
    inputs: tuple[tuple[int, int], ...]
    driven: tuple[tuple[str, str], ...]


def is_redundant(graph: SolverGraph) -> bool:
    """Whether some loop has more closing equations than unknowns (redundant constraints)."""
    return any(block.equations > len(block.unknowns) for block in graph.blocks)
