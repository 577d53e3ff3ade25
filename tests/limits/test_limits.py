"""Limits of coordinates: sweeps against the closed form of the four-bar, responses against that of
free fall."""

from __future__ import annotations

import random
from math import acos, atan2, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest

import mechkin_cli as mk

FOUR_BAR = """
format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{crank: {{}}, rod: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, rod], point: [{b[0]!r}, {b[1]!r}]}}
  C: {{type: R, links: [rod, rocker], point: [{c[0]!r}, {c[1]!r}]}}
  D: {{type: R, links: [ground, rocker], point: [{d!r}, 0]}}
limits: {limits}
motion: {{inputs: {{A.theta: {{from: 0, to: {turn!r}, count: 60}}}}}}
"""
SLIDE = """
format: 1
plane: xy
units: {length: m, angle: rad}
links: {block: {mass: 1, center_of_mass: [0, 0]}}
joints:
  S: {type: P, links: [ground, block], point: [0, 0], axis: [0, 1]}
loads: [{type: gravity, g: [0, -10]}]
"""


class Drawn:
    """A random four-bar, and how its rocker turns with its crank by the law of cosines."""

    def __init__(self, seed: int) -> None:
        rng = random.Random(seed)
        crank, rod, rocker = (rng.uniform(0.3, 2.0) for _ in range(3))
        self.d = rng.uniform(0.5, 2.0)
        while True:
            first = rng.uniform(-pi, pi)
            self.b = (crank * cos(first), crank * sin(first))
            away = hypot(self.b[0] - self.d, self.b[1])
            if abs(rod - rocker) + 0.05 < away < rod + rocker - 0.05:
                break
            crank, rod, rocker = (rng.uniform(0.3, 2.0) for _ in range(3))
        self.crank, self.rod, self.rocker, self.first = crank, rod, rocker, first
        self.side = rng.choice((-1.0, 1.0))
        self.start = self.angle(0.0)
        assert self.start is not None
        self.c = (self.d + rocker * cos(self.start), rocker * sin(self.start))
        self.turn = rng.uniform(0.2, 2.0 * pi)
        self.rng = rng

    def angle(self, turn: float) -> float | None:
        """The direction of the rocker where the crank has turned; None where it does not close."""
        x = self.crank * cos(self.first + turn) - self.d
        y = self.crank * sin(self.first + turn)
        away = hypot(x, y)
        cosine = (self.rocker**2 + away**2 - self.rod**2) / (2.0 * self.rocker * away)
        return atan2(y, x) + self.side * acos(cosine) if abs(cosine) < 1.0 else None

    def text(self, limits: str) -> str:
        return FOUR_BAR.format(b=self.b, c=self.c, d=self.d, turn=self.turn, limits=limits)


@pytest.mark.parametrize("seed", range(150))
def test_no_row_beyond_a_limit_is_ok(seed: int) -> None:
    drawn = Drawn(seed)
    low, high = -drawn.rng.uniform(0.0, 0.6), drawn.rng.uniform(0.0, 0.6)
    result = mk.loads(drawn.text(f"{{D.theta: [{low!r}, {high!r}]}}")).analyze()
    expected, previous = [], 0.0
    for turn in np.linspace(0.0, drawn.turn, 60):
        there = drawn.angle(float(turn))
        if there is None:
            break
        assert drawn.start is not None
        value = there - drawn.start
        value += 2.0 * pi * round((previous - value) / (2.0 * pi))
        previous = value
        expected.append(value)
    told = result["row.status"][: len(expected)]
    sure = np.abs(np.array([[v - low, v - high] for v in expected])).min(axis=1) > 1e-8
    for value, word in zip(np.array(expected)[sure], told[sure], strict=True):
        assert word == ("ok" if low < value < high else "beyond-limit")
    beyond = any(value < low - 1e-8 or value > high + 1e-8 for value in expected)
    assert beyond == any(d.code == "beyond-limit" for d in result.diagnostics)


def test_a_row_at_the_limit_of_an_input_is_ok_and_the_message_says_what_is_beyond() -> None:
    drawn = Drawn(3)
    result = mk.loads(drawn.text(f"{{A.theta: {{max: {drawn.turn!r}}}}}")).analyze()
    assert "beyond-limit" not in result["row.status"]
    half = drawn.turn / 2.0
    result = mk.loads(drawn.text(f"{{A.theta: {{max: {half!r}}}}}")).analyze()
    assert set(result["row.status"][30:]) == {"beyond-limit"}
    assert np.isfinite(result["D.theta"]).all()
    (note,) = (d for d in result.diagnostics if d.code == "beyond-limit")
    assert note.numbers[0].value == pytest.approx(drawn.turn)
    assert note.numbers[0].limit == half
    assert "rows 31 to 60" in note.message
    assert "A.theta" in note.message


def test_variants_go_by_their_own_limits() -> None:
    drawn = Drawn(3)
    text = drawn.text("{A.theta: {max: most}}") + "parameters: {most: 0.1 rad}\n"
    model = mk.loads(text)
    most = np.array([0.0, 0.5, 1.0]) * drawn.turn
    found = model.vary({"most": [f"{x!r} rad" for x in most.tolist()]}, ["D.theta"])
    turns = np.linspace(0.0, drawn.turn, 60)
    for x, words in zip(most, found.status, strict=True):
        assert [w == "beyond-limit" for w in words] == (turns > x + 1e-9).tolist()


def test_variants_of_a_length_go_by_the_limit_as_each_alone_does() -> None:
    drawn = Drawn(3)
    text = drawn.text("{D.theta: [-0.2 rad, 0.1 rad], A.theta: {max: 1.7}}")
    ground = f"point: [{drawn.d!r}, 0]"
    assert ground in text
    text = text.replace(ground, "point: [d, 0]") + f"parameters: {{d: {drawn.d!r} m}}\n"
    model = mk.loads(text)
    lengths = drawn.d * np.linspace(0.98, 1.02, 7)
    found = model.vary({"d": lengths}, ["A.theta"])
    assert "beyond-limit" in found.status
    assert "ok" in found.status
    for length, words in zip(lengths, found.status, strict=True):
        alone = mk.loads(text.replace(f"d: {drawn.d!r} m", f"d: {float(length)!r} m")).analyze()
        assert list(words) == list(alone["row.status"])


def test_one_position_says_that_it_is_beyond() -> None:
    drawn = Drawn(3)
    model = mk.loads(drawn.text(f"{{A.theta: {{max: {drawn.turn / 2.0!r}}}}}"))
    assert model.solve({"A.theta": 0.3 * drawn.turn}).status == "ok"
    assert model.solve({"A.theta": 0.7 * drawn.turn}).status == "beyond-limit"


def first_at(drawn: Drawn, ends: tuple[float, float], way: float) -> float | None:
    """The turn of the crank at which the rocker first comes to an end, by bisection; None where a
    whole turn or a dead centre is before it."""

    def off(turn: float, before: float) -> float | None:
        there = drawn.angle(turn)
        if there is None:
            return None
        assert drawn.start is not None
        value = there - drawn.start
        return value + 2.0 * pi * round((before - value) / (2.0 * pi))

    before, last = 0.0, 0.0
    for turn in np.linspace(0.0, way * 2.0 * pi, 4001)[1:]:
        value = off(float(turn), before)
        if value is None:
            return None
        if not ends[0] <= value <= ends[1]:
            low, high = last, float(turn)
            for _ in range(80):
                middle = 0.5 * (low + high)
                found = off(middle, before)
                assert found is not None
                low, high = (middle, high) if ends[0] <= found <= ends[1] else (low, middle)
            return high
        before, last = value, float(turn)
    return None


@pytest.mark.parametrize("seed", range(40))
def test_ranges_end_where_the_first_limit_is(seed: int) -> None:
    drawn = Drawn(seed)
    ends = -drawn.rng.uniform(0.05, 0.4), drawn.rng.uniform(0.05, 0.4)
    model = mk.loads(drawn.text(f"{{D.theta: [{ends[0]!r}, {ends[1]!r}]}}"))
    picked = model.modes().picked
    found = model.ranges()
    (own,) = (one for one in found.ranges if one.mode == picked)
    sides = [first_at(drawn, ends, way) for way in (-1.0, 1.0)]
    if sides == [None, None]:
        assert "limit" not in (own.lower.kind, own.upper.kind)
        return
    for end, side in zip((own.lower, own.upper), sides, strict=True):
        assert (end.kind == "limit") == (side is not None)
        if side is not None:
            assert end.value == pytest.approx(side, abs=1e-9)
    assert sum(d.code == "range-at-limit" for d in found.diagnostics) >= 1


def test_the_limit_of_the_input_ends_its_range_and_modes_beyond_one_are_named() -> None:
    drawn = Drawn(3)
    model = mk.loads(drawn.text("{A.theta: [-1, 2], D.theta: [-3, 0.3]}"))
    notes = [d for d in model.modes().diagnostics if d.code == "mode-beyond-limit"]
    assert [d.message for d in notes] == ["mode A stands beyond a limit of D.theta"]
    model = mk.loads(drawn.text("{A.theta: [-1, 2]}"))
    for one in model.ranges().ranges:
        assert (one.lower.kind, one.upper.kind) == ("limit", "limit")
        assert one.lower.value == pytest.approx(-1.0, abs=1e-12)
        assert one.upper.value == pytest.approx(2.0, abs=1e-12)


CRANK, ROD = 0.04, 0.12
SLIDER = """
format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{crank: {{}}, rod: {{}}, block: {{}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0]}}
  A: {{type: R, links: [crank, rod], point: [0.04, 0]}}
  B: {{type: R, links: [rod, block], point: [0.16, 0]}}
  S: {{type: P, links: [ground, block], point: [0.16, 0], axis: [1, 0]}}
limits: {limits}
motion: {{inputs: {{O.theta: {{from: 0, to: 1, count: 3}}}}}}
"""


def crank_at(slide: float) -> float:
    """The turn at which the block has slid so far, by the law of cosines."""
    x = CRANK + ROD + slide
    return acos((x * x + CRANK * CRANK - ROD * ROD) / (2.0 * x * CRANK))


@pytest.mark.parametrize(
    ("limits", "expected"),
    [
        # beyond it at the first row: it comes within on both sides
        ("{S.s: {max: -0.01}}", (crank_at(-0.01), 2.0 * pi - crank_at(-0.01))),
        ("{S.s: [-0.07, -0.01]}", (crank_at(-0.01), crank_at(-0.07))),
        # between two half degrees, beyond on either side of a dead centre
        ("{S.s: {max: -0.0799999}}", (crank_at(-0.0799999), 2.0 * pi - crank_at(-0.0799999))),
        ("{S.s: [-0.03000001, -0.03]}", (crank_at(-0.03), crank_at(-0.03000001))),
        # beyond its limit for less than half a degree
        ("{S.s: {min: -0.0799999}}", (-crank_at(-0.0799999), crank_at(-0.0799999))),
        # two limits, each of which holds at the first row or beside the other one's range
        ("{S.s: {max: -0.01}, O.theta: [-3, 1.5]}", (crank_at(-0.01), 1.5)),
        ("{S.s: {max: -0.01}, O.theta: [-3, 0.5]}", (-3.0, -crank_at(-0.01))),
        ("{O.theta: [1, 2]}", (1.0, 2.0)),
    ],
)
def test_ranges_are_the_nearest_within_all_limits(
    limits: str, expected: tuple[float, float]
) -> None:
    found = mk.loads(SLIDER.format(limits=limits)).ranges().ranges[0]
    assert (found.lower.kind, found.upper.kind) == ("limit", "limit")
    assert (found.lower.value, found.upper.value) == pytest.approx(expected, abs=1e-9)


def test_where_limits_never_hold_there_is_no_range() -> None:
    found = mk.loads(SLIDER.format(limits="{S.s: {max: -0.09}, O.theta: {max: 3}}")).ranges()
    own = found.ranges[0]
    assert (own.lower.kind, own.upper.kind) == ("nowhere", "nowhere")
    assert np.isnan([own.lower.value, own.upper.value]).all()
    (note,) = (d for d in found.diagnostics if "mode A stands beyond" in d.message)
    assert note.message == (
        "a limit of S.s: mode A stands beyond it, its whole branch beyond some limit"
    )


def nearest_within(drawn: Drawn, ends: tuple[float, float]) -> tuple[float, float] | None:
    """The turns of the crank between which the rocker is within its ends, in any turn, nearest to
    the first row; by bisection."""

    def off(turn: float) -> float:
        there = drawn.angle(turn)
        assert there is not None
        assert drawn.start is not None
        middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])
        away = there - drawn.start - middle
        return abs(away - 2.0 * pi * round(away / (2.0 * pi))) - half

    def passed(one: float, other: float) -> float:
        for _ in range(80):
            middle = 0.5 * (one + other)
            one, other = (middle, other) if off(middle) * off(one) > 0.0 else (one, middle)
        return other

    found = []
    for way in (1.0, -1.0):
        turns = [way * 2.0 * pi * k / 8000 for k in range(16001)]
        inside = [off(turn) <= 0.0 for turn in turns]
        if True in inside:
            k = inside.index(True)
            j = inside.index(False, k)
            found.append((passed(turns[k - 1], turns[k]), passed(turns[j - 1], turns[j])))
    if not found:
        return None
    one, other = min(found, key=lambda pair: abs(pair[0]))
    return min(one, other), max(one, other)


@pytest.mark.parametrize("seed", range(30))
def test_ranges_of_a_first_row_beyond_a_limit(seed: int) -> None:
    drawn = Drawn(seed)
    while any(drawn.angle(2.0 * pi * k / 360) is None for k in range(360)):
        drawn = Drawn(drawn.rng.randrange(10**6))  # the crank turns fully
    low = drawn.rng.uniform(0.1, 0.6) * drawn.rng.choice((-1.0, 1.0))
    ends = (low, low + 0.08) if low > 0.0 else (low - 0.08, low)
    model = mk.loads(drawn.text(f"{{D.theta: [{ends[0]!r}, {ends[1]!r}]}}"))
    picked = model.modes().picked
    (own,) = (one for one in model.ranges().ranges if one.mode == picked)
    expected = nearest_within(drawn, ends)
    if expected is None:
        assert own.lower.kind == "nowhere"
        return
    assert (own.lower.kind, own.upper.kind) == ("limit", "limit")
    assert (own.lower.value, own.upper.value) == pytest.approx(expected, abs=1e-8)


def test_a_fall_ends_at_the_limit() -> None:
    responses = "responses: {fall: {start: {S.s: 0}, time: {from: 0, to: 1, step: 0.1}}}\n"
    result = mk.loads(SLIDE + "limits: {S.s: [-2, 3]}\n" + responses).respond("fall")
    assert result["time"][-1] == pytest.approx(sqrt(0.4), rel=1e-12)
    assert result["S.s"][-1] == pytest.approx(-2.0, rel=1e-12)
    assert result["row.event"][-1] == "S.s at its limit -2 m"
    assert set(result["row.status"]) == {"ok"}


def test_a_fall_from_beyond_the_limit_is_never_ok() -> None:
    responses = "responses: {fall: {start: {S.s: -3}, time: {from: 0, to: 1, step: 0.1}}}\n"
    result = mk.loads(SLIDE + "limits: {S.s: [-2, 3]}\n" + responses).respond("fall")
    assert set(result["row.status"]) == {"beyond-limit"}


@pytest.mark.parametrize(
    ("limits", "code"),
    [
        ("{S.s: [3, -2]}", "no-room"),
        ("{S.s: {min: 2, max: 2}}", "no-room"),
        ("{S.s: {}}", "no-limit"),
        ("{S.theta: [0, 1]}", "unknown-coordinate"),
        ("{T.s: [0, 1]}", "unknown-coordinate"),
        ("{S.s: [0 deg, 1]}", "expression"),
        ("{S.s: [1]}", "limit-form"),
        ("{S.s: [1, 2, 3]}", "limit-form"),
        ("{S.s: 60 mm}", "limit-form"),
    ],
)
def test_limits_that_are_none_are_refused(limits: str, code: str) -> None:
    with pytest.raises(mk.InvalidFile) as refused:
        mk.loads(SLIDE + f"limits: {limits}\n")
    assert [d.code for d in refused.value.diagnostics] == [code]


CRANK = """
format: 1
plane: xy
units: {length: mm, angle: deg}
links: {crank: {}, rod: {}, slider: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [40, 0]}
  C: {type: R, links: [rod, slider], point: [140, 0]}
  S: {type: P, links: [ground, slider], point: [140, 0], axis: [1, 0]}
motion: {inputs: {A.theta: {from: 0, to: 10, step: 10}}}
"""


def test_one_note_tells_of_all_modes_at_a_limit() -> None:
    """The crank is stopped in both modes; the slide alone in that in which it stands there."""
    found = mk.loads(CRANK + "limits: {A.theta: [-30, 120]}\n").ranges()
    notes = [d.message for d in found.diagnostics if d.code == "range-at-limit"]
    assert notes == ["a limit of A.theta ends the ranges of modes A and B below and above"]
    found = mk.loads(CRANK + "limits: {S.s: {min: -20}}\n").ranges()
    notes = sorted(d.message for d in found.diagnostics if d.code == "range-at-limit")
    own = mk.loads(CRANK).modes().picked
    other = {"A": "B", "B": "A"}[str(own)]
    assert notes == sorted(
        [
            f"a limit of S.s ends the range of mode {own} below and above",
            f"a limit of S.s: mode {other} stands beyond it, its whole branch beyond some limit",
        ]
    )


@pytest.mark.parametrize("teeth", ["[20, 20]", "[30, 20]", "[20, 60]"])
def test_a_range_ends_at_a_limit_some_turns_on(teeth: str) -> None:
    """Wheels that are back after one turn or three, with a limit that takes longer."""
    one, other = map(float, teeth.strip("[]").split(","))
    text = f"""
format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{a: {{}}, b: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [ground, b], point: [1, 0]}}
couplings: {{K: {{type: gear, joints: [A, B], teeth: {teeth}}}}}
limits: {{A.theta: [-0.2, 90], B.theta: [-40, 2]}}
motion: {{inputs: {{A.theta: {{from: 0, to: 0.1, count: 2}}}}}}
"""
    (found,) = mk.loads(text).ranges().ranges
    assert found.lower.value == pytest.approx(-0.2, abs=1e-9)
    assert found.upper.value == pytest.approx(min(90.0, 40.0 * other / one), abs=1e-9)
