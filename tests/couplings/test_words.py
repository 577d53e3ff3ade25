"""Words and keys that people first write for couplings: each is answered with a form that runs."""

from __future__ import annotations

import pytest

import mechkin_cli as mk
from mechkin_cli.schema.coupling_words import ELSEWHERE

TWO = """\
format: 1
units: {length: mm, angle: deg}
links: {one: {}, two: {}, slider: {}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, two], point: POINT, axis: AXIS}
  S: {type: P, links: [ground, slider], point: [0, -20, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 0, to: 30, step: 10}}}
"""
PARALLEL = ("[90, 0, 0]", "[0, 0, 1]")
PASSING = ("[100, 0, 0]", "[0, 1, 0]")
MEETING = ("[50, 0, 80]", "[1, 0, 0]")


def drawn(how: tuple[str, str]) -> str:
    """Two wheels and a slide."""
    return TWO.replace("POINT", how[0]).replace("AXIS", how[1])


SUN_AND_PLANET = """\
format: 1
units: {length: mm, angle: deg}
links: {sun: {}, arm: {}, planet: {}}
joints:
  S: {type: R, links: [ground, sun], point: [0, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}
  P: {type: R, links: [arm, planet], point: [30, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {S.theta: {from: 0, to: 30, step: 10}}}
"""
DIFFERENTIAL = """\
format: 1
units: {length: mm, angle: deg}
links: {c: {}, l: {}, r: {}}
joints:
  case: {type: R, links: [ground, c], point: [0, 0, 0], axis: [0, 0, 1]}
  left: {type: R, links: [ground, l], point: [0, 0, 0], axis: [0, 0, 1]}
  right: {type: R, links: [ground, r], point: [0, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {case.theta: {from: 0, to: 30, step: 10}, left.theta: {from: 0, to: 60, step: 20}}}
"""
HOME = {
    "gear": (drawn(PARALLEL), "B.theta", -15.0),
    "worm": (drawn(PASSING), "B.theta", -0.75),
    "bevel": (drawn(MEETING), "B.theta", 15.0),
    "planetary": (SUN_AND_PLANET, "C.theta", 9.0),
    "differential": (DIFFERENTIAL, "right.theta", 0.0),
    "rack": (drawn(PARALLEL), "S.s", 3.141592653589793 * 20.0 / 6.0),
    "belt": (drawn(PARALLEL), "B.theta", 18.0),
    "cam": (drawn(PARALLEL), "S.s", 10.0 * (1.0 - 0.75**0.5)),
    "backlash": (drawn(PARALLEL), "B.theta", 15.0),
    "tie": (drawn(PARALLEL), "B.theta", 15.0),
}
"""A word, a drawing with the joints of its advice, and where a coordinate is at the last row."""


def advised(word: str) -> str:
    """The first `couplings:` of a word's advice, to the brace that closes it."""
    text = "{" + ELSEWHERE[word].partition("couplings: {")[2]
    depth = 0
    for at, each in enumerate(text):
        depth += (each == "{") - (each == "}")
        if depth == 0:
            return text[: at + 1]
    raise AssertionError(text)


@pytest.mark.parametrize("word", HOME)
def test_what_is_advised_runs(word: str) -> None:
    text, name, last = HOME[word]
    written = advised(word)
    if "slider" in text:
        # what the coupling leaves free is held
        free = [f", {one}: {{at: 0}}" for one in ("S.s", "B.theta") if one != name]
        text = text.replace("step: 10}}", "step: 10}" + "".join(free) + "}")
    rows = mk.loads(f"{text}couplings: {written}\n").analyze()
    assert set(rows["row.status"]) == {"ok"}
    assert abs(rows[name][-1]) == pytest.approx(abs(last), rel=1e-12, abs=1e-12)


COUPLINGS = {
    "{type: gears, joints: [A, B], teeth: [20, 40]}": "write type: gear",
    "{type: ring, joints: [A, B], teeth: [20, 40]}": "internal: true",
    "{type: worm, joints: [A, B], teeth: [1, 40]}": "a worm is a gear",
    "{type: differential, joints: [A, B, S]}": "a differential is a coupling of three",
    "{type: cam, joints: [A, S]}": "type: function",
    "{type: tie, joints: [A, B]}": "type: linear",
    "{type: gear, joints: [A, B], ratio: 2}": "teeth: [20, 40]",
    "{type: gear, joints: [A, B], z: [20, 40]}": "teeth: [20, 40]",
    "{type: gear, wheels: [A, B], teeth: [20, 40]}": "joints: [A, B]",
    "{type: gear, links: [one, two], teeth: [20, 40]}": "joints: [A, B]",
    "{type: gear, joints: [A, B], teeth: [20, 40], alpha: 20 deg}": "pressure_angle: 20 deg",
    "{type: gear, joints: [A, B], teeth: [20, 40], beta: 20 deg}": "helix: 15 deg",
    "{type: gear, joints: [A, B], teeth: [20, 40], m: 2}": "module: 2 mm",
    "{type: gear, joints: [A, B], teeth: [20, 40], eta: 0.9}": "efficiency: 0.9",
    "{type: rack, joints: [A, S], radius: 3, friction: 0.1}": "efficiency: 0.9",
    "{type: gear, joints: [A, B], teeth: [20, 40], ring: true}": "internal: true",
    "{type: rack, joints: [A, S], teeth: 20}": "radius: 20 mm",
    "{type: rack, pinion: A, radius: 3}": "joints: [A, S]",
    "{type: belt, joints: [A, B], diameters: [3, 4]}": "radii: [30 mm, 50 mm]",
    "{type: belt, joints: [A, B], radii: [3, 4], tension: 3}": "pretension: 200 N",
    "{type: chain, joints: [A, B], radii: [3, 4]}": "pitch: 12.7 mm",
    "{type: function, of: A.theta, gives: S.s, formula: 3}": "the key is value",
    "{type: table, of: A.theta, gives: S.s, file: a.csv}": "over: A.theta",
    "{type: rope, path: [P, Q]}": "type: cable",
    "{type: cable, points: [P, Q]}": "path: [P, {pulley: A",
    "{type: cable, path: [P, Q], length: 3}": "its length is that of the drawing",
    "{type: cable, path: [P, Q], tension: 3}": "K.tension",
    "{type: cable, path: [P, Q], falls: 4}": "path: [a, b, a, b, a]",
    "{type: linear, of: A.theta, gives: B.theta}": "terms: {A.theta: 1, B.theta: 2}",
    "{type: belt, joints: [A, B], radii: [3, 4], outside: B}": "in brackets: [B]",
    "{type: cable, path: P}": "in brackets: [P]",
    "{type: cable, path: [P, {pulley: A, radius: 3, swivel: true}]}": "in brackets: [x, y, z]",
}


@pytest.mark.parametrize("written", COUPLINGS)
def test_a_coupling_by_another_word(written: str) -> None:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(f"{drawn(PARALLEL)}couplings: {{K: {written}}}\n")
    hints = [each.hint or "" for each in caught.value.diagnostics]
    assert any(COUPLINGS[written] in each for each in hints), hints


def test_a_number_for_the_name_of_a_point_is_shown() -> None:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(f"{drawn(PARALLEL)}couplings: {{K: {{type: cable, path: [1, a b]}}}}\n")
    told = [each.message for each in caught.value.diagnostics]
    assert [text.partition(";")[0] for text in told] == [
        "couplings.K.path#1: '1' is not a name",
        "couplings.K.path#2: 'a b' is not a name",
    ]
