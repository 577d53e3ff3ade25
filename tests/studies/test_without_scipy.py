"""What a plain installation draws, and what it says of what it cannot draw."""

from __future__ import annotations

import sys
from typing import Any

import pytest
from references import RCSR

import mechkin_cli as mk

KEEP = [{"of": "O4.theta", "as": "range"}]
EVENLY = {"P1": {"tolerance": "0.01 in"}}
NEEDING = [
    ({"P1": {"tolerance": "0.01 in"}}, "latin"),
    ({"P1": {"tolerance": "0.01 in"}}, "sobol"),
    ({"P1": {"deviation": "0.01 in"}}, "random"),
    ({"P1": {"tolerance": "0.01 in", "distribution": "normal"}}, "random"),
]


@pytest.fixture
def plain(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A model where scipy cannot be imported."""
    for name in [name for name in sys.modules if name.partition(".")[0] == "scipy"]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, "scipy.special", None)
    return mk.load(RCSR)


def study(vary: dict[str, Any], method: str) -> dict[str, Any]:
    """A study of eight samples."""
    return {"study": 1, "vary": vary, "sample": {"count": 8, "method": method}, "keep": KEEP}


def test_even_samples_need_nothing(plain: Any) -> None:
    assert len(plain.study(study(EVENLY, "random"))["P1"]) == 8


@pytest.mark.parametrize(("vary", "method"), NEEDING)
def test_others_say_what_to_install(plain: Any, vary: dict[str, Any], method: str) -> None:
    with pytest.raises(mk.InvalidFile, match=r"scipy.*pip install 'mechkin\[studies\]'"):
        plain.study(study(vary, method))


@pytest.mark.parametrize(("vary", "method"), NEEDING)
def test_with_scipy_they_are_drawn(vary: dict[str, Any], method: str) -> None:
    assert len(mk.load(RCSR).study(study(vary, method))["P1"]) == 8


def test_tolerances_say_it_too(plain: Any) -> None:
    bands, of = {"P1": "0.01 in"}, ["O4.theta"]
    for more in ({}, {"method": "sobol"}, {"method": "random", "distribution": "normal"}):
        with pytest.raises(mk.UsageError, match=r"scipy.*pip install 'mechkin\[studies\]'"):
            plain.tolerances(bands, of, samples=4, **more)
    assert plain.tolerances(bands, of, samples=4, method="random").samples == 4
