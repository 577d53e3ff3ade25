"""A note stands at each parameter that nothing uses, and nowhere else."""

from __future__ import annotations

import random

import pytest
from references import FILE_OF

import mechkin_cli as mk

FILE = """\
format: 1
name: arm with a as its name
source: "b, page 3"
parameters: {PARAMETERS}
links: {arm: {}}
joints: {O: {type: R, links: [ground, arm], point: [POINT, 0, 0], axis: [0, 0, 1]}}
points: {p: {link: arm, at: [1, 0, 0]}}
motion: {inputs: {O.theta: {from: 0, to: ANGLE, count: 3}}}
"""


def noted(text: str, parameters: dict[str, str] | None = None) -> list[str]:
    """The parameters that are told to be unused, in their order."""
    model = mk.loads(text, "arm.yaml", parameters or {})
    found = [one for one in model.diagnostics if one.code == "unused-parameter"]
    assert all(one.severity == "note" and one.place is not None for one in found)
    lines = text.splitlines()
    places = [one.place for one in found if one.place is not None]
    rest = [lines[place.line - 1][place.column - 1 :] for place in places]
    return [words.partition(":")[0] for words in rest]


def file(parameters: str, point: str = "0", angle: str = "90", more: str = "") -> str:
    text = FILE.replace("PARAMETERS", parameters).replace("POINT", point)
    return text.replace("ANGLE", angle) + more


@pytest.mark.parametrize(
    ("text", "unused"),
    [
        (file("a: 1 m", "a"), []),
        (file("a: 1 m"), ["a"]),
        (file("a: 1 m, b: 2*a", "b"), []),
        (file("a: 1 m, b: 2*a"), ["a", "b"]),
        (file("c: 3*b, b: 2*a, a: 1 m", "a"), ["c", "b"]),
        (file("a: 30 deg", angle="3*a"), []),
        (file("a: 2", more="quantities: {title: a*O.theta}\n"), []),
        (file("a: 2", more="tables: [{name: t, columns: [{label: x, value: O.theta*a}]}]\n"), []),
        (file("a: 2", more="tables: [{name: t, columns: [a*O.theta]}]\n"), []),
        (file("x: 2", more="tables: [{name: t, columns: [{label: x, value: O.theta}]}]\n"), ["x"]),
        (file("a: 2 N*m", more="loads: [{type: torque, joint: O, value: a*sin(O.theta)}]\n"), []),
        (file("a: 2 s", more="view: {speed: a}\n"), []),
        (file("a: 20 deg", more="assembly: {near: {O.theta: a}}\n"), []),
        (file("arm_length: 1, arm: 2".replace("arm: 2", "ar: 2")), ["arm_length", "ar"]),
    ],
)
def test_what_is_noted(text: str, unused: list[str]) -> None:
    assert noted(text) == unused


def test_it_is_said_who_uses_it() -> None:
    first, second = mk.loads(file("a: 1 m, b: 2*a")).diagnostics
    assert first.message == "nothing uses the parameter a but b, which nothing uses"
    assert second.message == "nothing uses the parameter b"


def test_a_value_from_outside_changes_nothing() -> None:
    text = file("a: 1 m, b: 2*a", "b")
    assert noted(text, {"b": "3 m"}) == []
    assert noted(text, {"a": "3 m"}) == []
    assert noted(file("a: 1 m, b: 2*a"), {"b": "3 m"}) == ["a", "b"]


@pytest.mark.parametrize("path", list(FILE_OF.values()), ids=lambda path: path.stem)
def test_no_mechanism_kept_here_has_one(path: object) -> None:
    model = mk.load(str(path))
    assert "unused-parameter" not in {one.code for one in model.diagnostics}


@pytest.mark.parametrize("seed", range(40))
def test_random_parameters_are_used_as_far_as_they_are_reached(seed: int) -> None:
    dice = random.Random(seed)
    names = [f"v{number}" for number in range(12)]
    uses = {
        name: dice.sample(names[:at], min(at, dice.randint(0, 2))) for at, name in enumerate(names)
    }
    roots = dice.sample(names, dice.randint(1, 4))
    texts = {name: " + ".join(["1 m", *uses[name]]) for name in names}
    reached: set[str] = set()
    while more := [n for n in roots if n not in reached]:
        reached.update(more)
        roots = [used for name in more for used in uses[name]]
    order = dice.sample(names, len(names))
    firsts = [name for name in reached if not any(name in uses[n] for n in reached)]
    # what nobody reached uses is what the file itself has to name
    written = ", ".join(f"{name}: {texts[name]}" for name in order)
    assert noted(file(written, " + ".join(sorted(firsts)))) == [
        n for n in order if n not in reached
    ]
