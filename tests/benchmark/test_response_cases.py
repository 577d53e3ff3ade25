"""Responses on the bench: their equations, their exact motions, and that errors are true ones."""

from __future__ import annotations

import os
import sys
from functools import cache
from importlib.util import find_spec

import numpy as np
import pytest

from benchmarks.responses import pendulum
from benchmarks.responses.cases import RUN, Case, cases
from benchmarks.responses.extrapolation import extrapolated
from benchmarks.responses.table import OWN, response_table, summary
from benchmarks.responses.tree import Tree
from mechkin_cli.bench.report import ReportTable

NAMES = ("double pendulum", "three hinges in space", "RCSR", "stiff spring and damper")
TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


@cache
def measured(name: str) -> ReportTable:
    """A case at three tolerances."""
    return response_table(1, (1e-4, 1e-8, 1e-12), [name])


@cache
def known() -> dict[str, Case]:
    return {case.name: case for case in cases()}


def test_the_cases_are_named() -> None:
    assert tuple(known()) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_equations_have_mechkins_accelerations_in_every_row(name: str) -> None:
    case = known()[name]
    found = case.model(1e-12).respond(RUN, tables=[]).result
    parts = [
        np.array([np.asarray(found.quantity(n + order).value, float) for n in case.names])
        for order in ("", "_dot", "_ddot")
    ]
    for row in range(found.rows):
        y = np.concatenate([parts[0][:, row], parts[1][:, row]])
        own = case.rates(0.0, y)[len(case.names) :]
        size = max(1.0, np.abs(parts[2][:, row]).max())
        assert np.abs(own - parts[2][:, row]).max() < 1e-9 * size


@pytest.mark.parametrize("name", [each for each in NAMES if TIMES > 1 or "hinges" not in each])
def test_a_tighter_tolerance_comes_nearer_to_the_exact_motion(name: str) -> None:
    """Three hinges, which take longest, with `MECHKIN_RANDOM=2`."""
    table = measured(name)
    own = [row["error"] for row in table.rows if row["method"] == OWN]
    assert own[0] > own[1] > own[2]  # type: ignore[operator]
    assert own[2] < 1e-10  # type: ignore[operator]
    for row in table.rows:
        assert row["milliseconds"] > 0.0  # type: ignore[operator]
        assert row["ratio"] > 0.0  # type: ignore[operator]
        assert np.isfinite(row["error"])  # type: ignore[arg-type]
    for method in {str(row["method"]) for row in table.rows} - {OWN}:
        errors = [row["error"] for row in table.rows if row["method"] == method]
        assert errors[-1] < 1e-3 * errors[0]  # type: ignore[operator]


def test_extrapolation_is_exact_to_its_numbers() -> None:
    """x'' = -x over a turn."""
    moments = np.linspace(0.0, 6.0, 7)
    found = extrapolated(lambda y: np.array([y[1], -y[0]]), [1.0, 0.0], moments, 1)
    assert np.abs(found[0] - np.cos(moments.astype(np.longdouble))).max() < 1e-16


def test_the_exact_motion_of_the_pendulum_is_that_of_the_dense_equations() -> None:
    """Another formula, in other steps."""
    own = known()["double pendulum"].tree
    assert own is not None
    tree = Tree(own.mechanism, own.carried, (0.0, 0.0), (), np.longdouble)
    start, few = [*pendulum.START, 0.0, 0.0], pendulum.moments()[:4]
    found = extrapolated(lambda y: np.concatenate([y[2:], tree.rates(y[:2], y[2:])]), start, few, 9)
    assert np.abs(found[:2] - pendulum.exact_motion()[:, :4]).max() < 1e-15


def test_errors_are_seen() -> None:
    """A link that is a millionth heavier in the equations alone is an error of that size."""
    case = known()["three hinges in space"]
    tree = case.tree
    assert tree is not None
    body = tree.bodies[2]
    y = case.start
    before = case.rates(0.0, y)
    tree.bodies[2] = body._replace(mass=body.mass * (1 + 1e-6))  # type: ignore[union-attr]
    try:
        off = np.abs(case.rates(0.0, y) - before).max()
    finally:
        tree.bodies[2] = body
    assert 1e-8 < off < 1e-4


def test_libraries_that_are_missing_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("scipy.integrate", "pinocchio", "mujoco"):
        monkeypatch.setitem(sys.modules, name, None)
    table = response_table(1, (1e-4,), ["double pendulum"])
    assert [row["method"] for row in table.rows] == [OWN]
    for name in ("scipy", "pinocchio", "mujoco"):
        assert f"{name} is left out: it is not installed." in table.notes
    assert summary(table.rows) == []


def test_the_page_tells_the_fastest_other() -> None:
    rows = [
        {"case": "A", "method": OWN, "ratio": 1.0},
        {"case": "A", "method": "scipy", "ratio": 8.0},
        {"case": "A", "method": "MuJoCo", "ratio": 0.5},
        {"case": "B", "method": "scipy", "ratio": 20.0},
    ]
    (said,) = summary(rows)
    assert "A 0.500, B 20.0 times as fast" in said


@pytest.mark.skipif(find_spec("scipy") is None, reason="scipy is not installed")
def test_another_is_held_against_what_is_as_exact() -> None:
    table = measured("RCSR")
    own = {row["setting"]: row for row in table.rows if row["method"] == OWN}
    for row in table.rows:
        if row["method"] == OWN:
            assert row["ratio"] == 1.0
            continue
        beside = row["milliseconds"] / row["ratio"]  # type: ignore[operator]
        (setting,) = (s for s, r in own.items() if abs(r["milliseconds"] / beside - 1.0) < 1e-9)  # type: ignore[operator]
        assert own[setting]["error"] <= row["error"]  # type: ignore[operator]
