"""Overconstrained mechanisms whose inputs cannot move as they are driven: named, with a cure."""

from __future__ import annotations

import pytest

import mechkin_cli as mk

TRIANGLE = """
format: 1
links: {a: {}, b: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [1, 1, 0], axis: [0, 0, 1]}
  C: {type: R, links: [ground, b], point: [2, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 10, step: 1}}}
"""
FOUR_BAR = """
format: 1
links: {a: {}, b: {}, c: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [1, 1, 0], axis: [0, 0, 1]}
  C: {type: R, links: [b, c], point: [2, 1.5, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, c], point: [3, 0, 0], axis: [0, 0, 1]}
motion:
  inputs:
    A.theta: {from: 0, to: 10, step: 1}
    D.theta: {from: 0, to: 10, step: 1}
"""


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        (TRIANGLE, "input-locked", "A.theta is locked"),
        (FOUR_BAR, "inputs-dependent", "A.theta, D.theta are not independent"),
    ],
)
def test_what_cannot_move_is_named(text: str, code: str, words: str) -> None:
    result = mk.loads(text).analyze([])
    (found,) = result.diagnostics
    assert (found.code, found.severity) == (code, "error")
    assert words in found.message
    assert found.hint
    assert list(result["row.status"])[1:] == ["branch-lost"] * 10


def test_a_triangle_that_does_not_close_says_how_far() -> None:
    open_triangle = TRIANGLE.replace("point: [1, 1, 0]", "point: {a: [1, 1, 0], b: [1.1, 1, 0]}")
    (found,) = mk.loads(open_triangle).analyze([]).diagnostics
    assert found.code == "not-assembled"
    assert "must be exact" in (found.hint or "")


@pytest.mark.parametrize("inputs", ["", "motion: {inputs: {A.theta: {from: 0, to: 5, step: 1}}}"])
def test_freedoms_of_a_plane_chain_that_nothing_drives_are_told(inputs: str) -> None:
    """Four links and five: a freedom is left that the conditions of their planes hide."""
    chain = FOUR_BAR[: FOUR_BAR.index("motion:")]
    if inputs:
        chain = chain.replace(
            "D: {type: R, links: [ground, c], point: [3, 0, 0]",
            "D: {type: R, links: [c, d], point: [3, 0.5, 0]",
        )
        chain = chain.replace("c: {}}", "c: {}, d: {}}")
        chain += "  E: {type: R, links: [ground, d], point: [4, 0, 0], axis: [0, 0, 1]}\n"
    result = mk.loads(chain + inputs).analyze([])
    (found,) = [d for d in result.diagnostics if d.code == "undriven-freedom"]
    assert "not driven" in found.message
    assert "add inputs" in (found.hint or "")
    assert result["row.status"][0] == "rank-unclear"
