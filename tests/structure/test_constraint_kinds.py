"""A kind of constraint that the package does not know: its class is all that structure needs."""

from __future__ import annotations

import pytest

import mechkin_cli as mk
from mechkin_cli.mechanism import Constraint, Mechanism
from mechkin_cli.record import dataclass
from mechkin_cli.session.assembled_places import solver_graph
from mechkin_cli.structure import UnsolvableGraph

CRANKS = """
format: 1
name: two cranks
units: {length: mm, angle: rad}
links: {a: {}, b: {}, c: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, b], point: [80, 0, 0], axis: [0, 0, 1]}
  C: {type: P, links: [b, c], point: [80, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 0, to: 1, count: 3}, B.theta: {with: 0}, C.s: {with: 0}}}
"""


@dataclass(frozen=True)
class Coupling(Constraint):
    """One equation between the turns of two links, without a link of its own."""

    @property
    def name(self) -> str:
        """Apart from its joint's."""
        return "teeth"

    @property
    def kind(self) -> str:
        """Of gears."""
        return "gears"


@pytest.fixture
def mechanism(monkeypatch: pytest.MonkeyPatch) -> Mechanism:
    """Two cranks on ground, coupled."""
    plain = mk.loads(CRANKS).problem.mechanism
    coupling = Coupling(plain.joints["B"], "a", "b")
    monkeypatch.setattr("mechkin_cli.mechanism.model.find_constraints", lambda *_: (coupling,))
    return Mechanism(plain.name, plain.links, plain.joints)


def test_it_closes_a_loop_and_takes_a_freedom(mechanism: Mechanism) -> None:
    graph = solver_graph(mechanism, [("A", "theta"), ("C", "s")])
    assert [closing.label for closing in graph.closings] == ["teeth (gears)"]
    ((block),) = graph.blocks
    assert [graph.edges[k].joint.name for k, _ in block.unknowns] == ["B"]
    assert block.equations == 1
    loop = [(graph.edges[k].joint.name, sign) for k, sign in graph.loops[0]]
    assert loop == [("B", 1), ("A", -1)]


def test_it_carries_nothing(mechanism: Mechanism) -> None:
    """What it leaves free is not driven; a freedom that it takes may not be driven, too."""
    with pytest.raises(UnsolvableGraph, match=r"C\.s"):
        solver_graph(mechanism, [("A", "theta")])
    with pytest.raises(UnsolvableGraph):
        solver_graph(mechanism, [("A", "theta"), ("B", "theta"), ("C", "s")])
