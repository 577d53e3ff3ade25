"""Every law with every key missing, and with keys and values it cannot have: place and cure."""

from __future__ import annotations

import re
from itertools import combinations

import pytest
import yaml

import mechkin_cli as mk

HEAD = """format: 1
links: {a: {}}
joints: {O: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
motion:
  time: {from: 0, to: 2, step: 0.5}
"""
LAWS = {
    "constant-rate": {"at": 0, "rate": 1},
    "constant-acceleration": {"at": 0, "acceleration": 1},
    "polynomial": {"coefficients": [0, "1 rad/s"]},
    "expression": {"value": "1 rad/s*time"},
    "harmonic": {"from": 0, "to": 1},
    "cycloidal": {"from": 0, "to": 1},
    "3-4-5": {"from": 0, "to": 1},
    "4-5-6-7": {"from": 0, "to": 1},
    "modified-sine": {"from": 0, "to": 1},
    "modified-trapezoid": {"from": 0, "to": 1},
    "sequence": {"segments": [{"for": 1, "to": 2, "law": "cycloidal"}, {"for": 1, "law": "dwell"}]},
    "table": {"file": "law.csv"},
}
ODD = ["", "x y", [], {}, [[]], {"type": "harmonic"}, "nan", 10**400]
MISSING = [
    (law, left_out)
    for law, keys in LAWS.items()
    for count in range(1, len(keys) + 1)
    for left_out in combinations(keys, count)
]


def refusal(motion: object) -> tuple[mk.Diagnostic, ...]:
    text = (
        HEAD + f"  inputs: {{O.theta: {yaml.safe_dump(motion, default_flow_style=True).strip()}}}"
    )
    with pytest.raises(mk.InvalidFile) as refused:
        mk.loads(text.replace("\n...", ""), "f.yaml")
    for found in refused.value.diagnostics:
        assert found.place is not None
        assert found.place.line >= 5
    return refused.value.diagnostics


@pytest.mark.parametrize(("law", "left_out"), MISSING)
def test_each_missing_key_is_named(law: str, left_out: tuple[str, ...]) -> None:
    motion = {"law": law} | {k: v for k, v in LAWS[law].items() if k not in left_out}
    found = refusal(motion)
    named = {re.search(r"the key (\w+) is missing", d.message)[1] for d in found}  # type: ignore[index]
    assert named == set(left_out)
    assert all(d.hint and d.hint.startswith("add ") for d in found)


@pytest.mark.parametrize("value", ODD, ids=lambda value: repr(value)[:20])
@pytest.mark.parametrize("law", LAWS)
def test_odd_values_are_refused_at_their_place(law: str, value: object) -> None:
    for key in LAWS[law]:
        refusal({"law": law} | LAWS[law] | {key: value})


@pytest.mark.parametrize("law", LAWS)
def test_a_key_of_no_law_is_refused(law: str) -> None:
    (found,) = refusal({"law": law, "speed": 3} | LAWS[law])
    assert found.code == "unknown-key"
    assert found.hint


@pytest.mark.parametrize("value", ["", "harmonics", 3, [], ["harmonic"], {}, {"type": "harmonic"}])
def test_what_is_no_law_is_told_the_laws(value: object) -> None:
    (found,) = refusal({"law": value} | LAWS["harmonic"])
    assert found.code in ("unknown-word", "empty-value")
    assert found.hint or "harmonic" in found.message


@pytest.mark.parametrize("law", [name for name in LAWS if name != "table"])
def test_the_laws_themselves_are_right(law: str) -> None:
    text = (
        HEAD
        + "  inputs:\n    O.theta: "
        + yaml.safe_dump({"law": law} | LAWS[law], default_flow_style=True, width=1000)
    )
    assert mk.loads(text, "f.yaml").problem.motion.rows == 5
