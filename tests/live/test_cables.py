"""Cables on a changed page: rows in which they leave a pulley, or its plane, have the command's
verdict."""

from __future__ import annotations

import pytest
from couplings.test_spatial_cables import LEAVES
from live.test_cells import NODE, checked_run, compared, computed, with_values
from references import FILE_OF

from mechkin_cli import load, loads
from mechkin_cli.verdict import SWEEP
from mechkin_cli.view.scene import page_data

pytestmark = pytest.mark.skipif(NODE is None, reason="needs node")

ARC = """
format: 1
plane: xy
units: {length: m, angle: deg, force: N}
parameters: {r: 0.3 m}
links: {arm: {}, slide: {}}
joints:
  A: {type: R, links: [ground, arm], point: [1, 0]}
  S: {type: P, links: [ground, slide], point: [-2, 0], axis: [1, 0]}
points:
  o: {link: ground, at: [0, 0]}
  p: {link: arm, at: [2, 0]}
  q: {link: slide, at: [-2, 0]}
couplings: {K: {type: cable, path: [q, {pulley: o, radius: r, side: left}, p]}}
motion: {inputs: {A.theta: {from: -60, to: 60, count: 25, rate: 1 rad/s}}}
"""
"""Over the pulley's top while both ends hang below."""

PLANE = LEAVES.replace("motion:", "parameters: {r: 20 mm, low: -150 mm}\nmotion:")
PLANE = PLANE.replace("radius: 20", "radius: r").replace("100, 0, -150", "100, 0, low")
PLANE = PLANE.replace("values: [-30, 0, 30]", "values: [-30, -1e-6, 0, 0.1, 30]")


@pytest.mark.parametrize(
    ("text", "cases", "word"),
    [
        (ARC, [{"r": r} for r in (0.3, 0.01, 0.1, 0.2, 0.4)], "slack"),
        (PLANE, [{"r": 15.0}, {"low": -120.0}, {"r": 5.0, "low": -180.0}], "fleet-angle"),
    ],
    ids=["pulley", "plane"],
)
def test_rows_are_judged_as_the_command_judges_them(
    text: str, cases: list[dict[str, float]], word: str
) -> None:
    model = loads(text)
    data, _ = page_data([model.analyze()], modes=False)
    seen = set()
    for case, one in zip(cases, computed(data, cases), strict=True):
        assert one["end"] == "complete", (case, one["words"])
        wanted = with_values(model, case).analyze()
        assert compared(str(case), data["live"], one, wanted) > 1
        status = tuple(wanted["row.status"])
        assert {word, "ok"} == set(status)
        seen.add(status)
    assert len(seen) > 1 or word == "fleet-angle", "other rows with another pulley"


@pytest.mark.parametrize("stem", ["tackle", "cable_robot"])
def test_kept_cables_follow(stem: str) -> None:
    model = load(FILE_OF[stem])
    assert checked_run(stem, model, SWEEP, variants=6) > 20


def test_a_cable_is_drawn_over_the_pulley_as_large_as_it_is() -> None:
    data, _ = page_data([loads(ARC).analyze()], modes=False)
    wanted, _ = page_data([loads(ARC.replace("r: 0.3", "r: 0.2")).analyze()], modes=False)
    (found,) = computed(data, [{"r": 0.2}])
    assert found["drawn"]["cables"] == wanted["cables"] != data["cables"]


def test_a_cable_over_points_alone_follows() -> None:
    text = ARC.replace("{pulley: o, radius: r, side: left}", "o").replace(
        "[1, 0]}\n  S", "[e, 0]}\n  S"
    )
    model = loads(text.replace("r: 0.3 m", "e: 1 m").replace("at: [2, 0]", "at: [2*e, 0]"))
    data, _ = page_data([model.analyze()], modes=False)
    assert data["cables"][0]["beside"] == [0.0, 0.0, 0.0]
    assert checked_run("points", model, SWEEP, variants=3) > 1
