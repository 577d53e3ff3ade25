"""Quantities are made when they are asked for: each alone is what it is among all, and a run makes
few of them."""

from __future__ import annotations

from pathlib import Path

import pytest

import mechkin_cli as mk
from mechkin_cli.mechanism import Problem, response_problem
from mechkin_cli.mechanism.quantities import Catalogue
from tests.structure.networks import windows

FILES = sorted(p for p in Path("mechanisms").rglob("*.yaml") if p.parent.name != "studies")
"""Every kind of joint, coupling, load and response is in some of them."""


def problems(path: Path) -> list[Problem]:
    whole = mk.load(path).problem
    return [whole, *(response_problem(whole, one) for one in whole.responses.values())]


@pytest.mark.parametrize("path", FILES[::3], ids=lambda path: path.stem)
def test_each_quantity_alone_is_what_it_is_among_all(path: Path) -> None:
    for problem in problems(path):
        every = dict(problem.quantities())
        one_by_one = Catalogue(problem._quantities_of, problem._coordinates_of)
        assert [one_by_one[name] for name in every] == list(every.values())
        assert one_by_one.made == {name.partition(".")[0] for name in every}
        assert list(one_by_one) == list(every)
        assert len(one_by_one) == len(every)


def test_what_is_no_quantity_is_none() -> None:
    known = mk.load("mechanisms/dissertation/rcsr.yaml").problem.quantities()
    for name in (
        "",
        ".",
        "O2",
        "O2.",
        "O2.theta.",
        "nobody.theta",
        "ground",
        "ground.theta",
        "time",
    ):
        assert name not in known
        assert known.get(name) is None


@pytest.mark.parametrize("count", [4, 16])
def test_a_run_makes_the_quantities_of_what_it_reads(count: int) -> None:
    """As many in a machine of many loops as in one of few."""
    text = windows(count).text + f"tables: [{{name: m, columns: [O0.theta, O{count}.theta]}}]\n"
    run = mk.loads(text).analyze()
    assert run.complete
    known = run.result.problem.quantities()
    assert isinstance(known, Catalogue)
    assert known.made == {"O0", f"O{count}"}
