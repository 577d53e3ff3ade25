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


def linkage(crank: str, coupler: str, driven: str, far: str = "[3, 0, 0]") -> str:
    """A plane four-bar with U and S, so that it has as many equations as unknowns."""
    return f"""
format: 1
links: {{a: {{}}, b: {{}}, c: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: U, links: [a, b], point: {crank}, axis: [0, 0, 1], axis2: [1, 0.1, 0]}}
  C: {{type: S, links: [b, c], point: {coupler}}}
  D: {{type: R, links: [c, ground], point: {far}, axis: [0, 0, 1]}}
motion: {{inputs: {{{driven}.theta: {{from: 0, to: 10, step: 1}}}}}}
"""


BLAMED = {"input-locked", "inputs-dependent", "undriven-freedom"}


@pytest.mark.parametrize(
    ("place", "text"),
    [
        ("dead centre", linkage("[1, 0.5, 0]", "[2, 1, 0]", "D")),
        ("flat parallelogram", linkage("[1, 0, 0]", "[4, 0, 0]", "A")),
        ("flat parallelogram", linkage("[1, 0, 0]", "[4, 0, 0]", "D")),
        ("folded rhombus", linkage("[1, 0, 0]", "[0, 0, 0]", "A", "[1, 0, 0]")),
        ("folded kite", linkage("[1, 0, 0]", "[3, 0, 0]", "A", "[1, 0, 0]")),
    ],
)
def test_no_input_is_blamed_for_a_special_place_at_the_start(place: str, text: str) -> None:
    """All of them have one freedom, which the input drives on one way out at least."""
    result = mk.loads(text).analyze([])
    codes = {diagnostic.code for diagnostic in result.diagnostics}
    assert not codes & BLAMED, place
    assert result["row.status"][0] == "rank-unclear"
    assert list(result["row.status"])[1:] == ["branch-lost"] * 10


PLANES = """
format: 1
links: {L1: {}, L2: {}, L3: {}}
joints:
  A: {type: R, links: [ground, L1], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: E, links: [L1, L2], point: [1, 0, 0.5], normal: [0, 0, 1], x: [1, 0, 0]}
  C: {type: E, links: [L2, L3], point: [1, 1, 0.5], normal: [1, 0, 0], x: [0, 1, 0]}
  D: {type: P, links: [ground, L3], point: [0, 2, 0], axis: [1, 2, 1]}
motion: {inputs: {A.theta: {from: 0, to: 20, step: 5}}}
"""


def test_a_freedom_hidden_by_special_axes_is_named_undriven() -> None:
    """As many equations as unknowns, but the axes make some of them depend on others."""
    model = mk.loads(PLANES)
    found = model.mobility()
    assert found.mobility == 2 + len(found.idle)
    (fault,) = [d for d in model.analyze([]).diagnostics if d.code == "undriven-freedom"]
    assert fault.severity == "error"
    assert "not driven" in fault.message
    assert "add inputs" in (fault.hint or "")
