"""Branch points are located and named: a parallelogram may cross over where it lies flat."""

from __future__ import annotations

import pytest
from mechanisms.runs import edited

import mechkin_cli as mk
from mechkin_cli.diagnostics import Diagnostic

FLAT = """
format: 1
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [crank, coupler], point: [0, 1, 0]}}
  C: {{type: S, links: [coupler, rocker], point: [3, 1, 0]}}
  D: {{type: R, links: [ground, rocker], point: [3, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{from: {first}, to: {last}, step: 10}}}}}}
"""


def place(diagnostics: tuple[Diagnostic, ...]) -> float:
    (found,) = [d for d in diagnostics if d.code == "branch-point"]
    assert found.measured is not None
    return float(found.measured.split("=")[1].split()[0])


@pytest.mark.parametrize(("first", "last", "flat"), [(0, 200, 90), (0, -200, -90), (45, 101, 90)])
def test_a_parallelogram_on_spheres(first: int, last: int, flat: float) -> None:
    result = mk.loads(FLAT.format(first=first, last=last)).analyze([])
    assert abs(place(result.diagnostics) - flat) < 1e-9
    for theta, status in zip(result["A.theta"], result["row.status"], strict=True):
        assert status == ("branch-lost" if theta * flat >= flat * flat else "ok")


def test_an_overconstrained_parallelogram() -> None:
    inputs = {"A.theta": {"from": 20, "to": 340, "step": 20}}
    result = edited("parallelogram", [], motion={"inputs": inputs})
    assert abs(place(result.diagnostics) - 180) < 1e-9
    assert list(result["row.status"]) == ["ok"] * 8 + ["branch-lost"] * 9
