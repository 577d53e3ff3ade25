"""Loads are of one kind wherever nothing but their wrench and their plan depends on it.

What else depends on the kind is a property of its class in `mechanism/model.py` (`reads_rates`,
`has_potential`, `dissipates`, `acts_at`, `ends`), so that a new kind is one class, its record in
the plan and its wrench.
"""

from __future__ import annotations

import ast
from pathlib import Path
from typing import get_args

import pytest
from architecture.package import FILES, ROOT, of_every, told_apart, tree

from mechkin_cli.mechanism.model import Load

KINDS = {kind.__name__ for kind in get_args(Load)}
MAY_ASK = {
    "balances/dense.py": "wrenches",
    "bridges/mjcf_export.py": "what MuJoCo has for each",
    "idle/idle.py": "what acts on a link that moves idly",
    "live/load_arrows.py": "how the arrows of each are computed in a page",
    "plan/plan.py": "records of the plan",
    "plan/programs.py": "values of the plan",
    "view/arrows.py": "where the arrows of each are drawn",
}


@of_every(FILES)
def test_no_other_module_asks_for_a_kind(path: Path) -> None:
    questions = list(told_apart(tree(path), KINDS))
    assert bool(questions) == (str(path.relative_to(ROOT)) in MAY_ASK), questions


@pytest.mark.parametrize("source", ["isinstance(x, Damper | Spring)", "type(x) is LinkLoad"])
def test_what_would_be_found(source: str) -> None:
    assert list(told_apart(ast.parse(source), KINDS))
