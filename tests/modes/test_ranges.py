"""Ranges of an input against closed forms: dead centres, full turns, circuits, extremes."""

from __future__ import annotations

import cmath
import math

import pytest
from mechanisms.runs import edited, model
from mpmath import mp, mpf
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.modes.modes import Range

FOUR_BAR = """
format: 1
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [crank, coupler], point: [{crank}, 0, 0]}}
  C: {{type: S, links: [coupler, rocker], point: [{x}, {y}, 0]}}
  D: {{type: R, links: [ground, rocker], point: [{ground}, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{{driven}.theta: {{from: {at}, to: {at}, step: 1}}}}}}
"""


def four_bar(
    crank: float, coupler: float, rocker: float, ground: float, driven: str, at: float = 0
) -> mk.Model:
    """A plane four-bar on spheres, drawn with the crank along the ground."""
    base = ground - crank
    x = crank + (coupler**2 - rocker**2 + base**2) / (2 * base)
    y = math.sqrt(coupler**2 - (x - crank) ** 2)
    return mk.loads(FOUR_BAR.format(crank=crank, x=x, y=y, ground=ground, driven=driven, at=at))


def test_a_crank_that_turns_fully_has_two_circuits() -> None:
    found = four_bar(2, 5, 4, 6, "A").ranges()
    assert [(item.mode, item.turns) for item in found.ranges] == [("A", 1), ("B", 1)]
    assert found.circuits == (("A",), ("B",))


def test_a_driven_rocker_swings_between_its_dead_centres() -> None:
    """Crank and coupler in line: the law of cosines in the triangle A, C, D."""
    found = four_bar(2, 5, 4, 6, "D").ranges()

    def angle(side: float) -> mpf:
        return mp.pi - mp.acos((mpf(6) ** 2 + 16 - mpf(side) ** 2) / (2 * 6 * 4))

    drawn = angle(mp.sqrt(mpf(x_of(2, 5, 4, 6)) ** 2 + mpf(y_of(2, 5, 4, 6)) ** 2))
    limits = sorted(float(mp.degrees(angle(side) - drawn)) for side in (3, 7))
    for item in found.ranges[:1]:
        assert (item.lower.kind, item.upper.kind) == ("dead-centre", "dead-centre")
    swings = [item for item in found.ranges if abs(item.upper.value - limits[1]) < 1]
    assert len(swings) == 2
    for item in swings:
        assert abs(item.lower.value - limits[0]) < 1e-9
        assert abs(item.upper.value - limits[1]) < 1e-9
        assert item.turns == 0
    assert len({item.circuit for item in swings}) == 1


@pytest.mark.parametrize("turns", [10, 10**10])
def test_whole_turns_change_nothing(turns: int) -> None:
    """A rocker driven from so many turns away swings between the same dead centres, farther on, and
    stands in the same modes."""
    here, far = (four_bar(2, 5, 4, 6, "D", at=at) for at in (7, 7 + 360 * turns))
    for one, other in zip(here.ranges().ranges, far.ranges().ranges, strict=True):
        assert (one.mode, one.turns, one.circuit) == (other.mode, other.turns, other.circuit)
        rounding = 360 * turns * 2.0**-52
        for end, moved in ((one.lower, other.lower), (one.upper, other.upper)):
            assert end.kind == moved.kind
            assert abs(moved.value - (end.value + 360 * turns)) <= 2 * rounding
    for found in (far.modes(), here.modes(at={"D.theta": 7 + 360 * turns})):
        modes = {round(mode.coordinates["A.theta"], 6): mode for mode in found.modes}
        for mode in here.modes().modes:
            other = modes[round(mode.coordinates["A.theta"], 6)]
            assert abs(other.coordinates["A.theta"] - mode.coordinates["A.theta"]) < 1e-11


def test_so_many_turns_are_refused() -> None:
    with pytest.raises(mk.InvalidFile, match="nothing is left of the place within one"):
        four_bar(2, 5, 4, 6, "A", at=1e99)
    with pytest.raises(mk.UsageError, match="too large"):
        four_bar(2, 5, 4, 6, "A").modes(at={"A.theta": 1e99})


def x_of(crank: float, coupler: float, rocker: float, ground: float) -> float:
    base = ground - crank
    return crank + (coupler**2 - rocker**2 + base**2) / (2 * base)


def y_of(crank: float, coupler: float, rocker: float, ground: float) -> float:
    return math.sqrt(coupler**2 - (x_of(crank, coupler, rocker, ground) - crank) ** 2)


def test_a_triple_rocker_is_one_circuit_over_two_dead_centres() -> None:
    """Shortest + longest > the others: every link swings, both assemblies are one circuit."""
    found = four_bar(3, 2.5, 2, 4, "A").ranges()
    limit = math.degrees(math.acos((9 + 16 - 4.5**2) / (2 * 3 * 4)))
    assert found.circuits == (("A", "B"),)
    for item in found.ranges:
        assert abs(item.upper.value - limit) < 1e-9
        assert abs(item.lower.value + limit) < 1e-9


def test_the_ends_of_a_parallelogram_are_branch_points() -> None:
    for item in model("parallelogram").ranges().ranges:
        assert (item.lower.kind, item.upper.kind) == ("branch-point", "branch-point")
        assert abs(item.lower.value) < 1e-9
        assert abs(item.upper.value - 180) < 1e-9


def test_rcsr_has_one_circuit_between_its_dead_centres() -> None:
    """The places are those of a bordered system at 40 digits (tests/stress)."""
    found = model("rcsr").ranges()
    assert found.circuits == (("A", "B"),)
    for item in found.ranges:
        assert abs(item.lower.value - 133.9439778838147) < 1e-9
        assert abs(item.upper.value - 205.1439659451948) < 1e-9


def test_extremes_of_a_rocker() -> None:
    """Dead centres of the output: crank and coupler in line, stretched or folded."""
    found = four_bar(2, 5, 4, 6, "A").ranges(outputs=["D.theta"])
    item = found.ranges[0]
    assert [extreme.output for extreme in item.extremes] == ["D.theta", "D.theta"]

    def crank_angle(side: float) -> float:
        return math.degrees(math.acos((36 + side**2 - 16) / (2 * 6 * side)))

    stretched, folded = crank_angle(7), crank_angle(3)
    expected = {0: sorted(((stretched) % 360, (folded + 180) % 360))}
    mirrored = sorted(((-stretched) % 360, (180 - folded) % 360))
    places = sorted(extreme.input % 360 for extreme in item.extremes)
    misses = [
        max(abs(a - b) for a, b in zip(places, wanted, strict=True))
        for wanted in (expected[0], mirrored)
    ]
    assert min(misses) < 1e-9


def test_struts_walk_through_the_modes_of_both_sides() -> None:
    """Each circuit of the suspension has its two dead centres in both of its modes."""
    found = model("five_link_suspension").ranges()
    by_name = {item.mode: item for item in found.ranges}
    for circuit in found.circuits:
        uppers = [by_name[name].upper.value for name in circuit]
        assert max(uppers) - min(uppers) < 1e-9


@pytest.mark.parametrize("name", ["pspr", "sevenr", "rsgc", "rchch", "slider_crank"])
def test_every_end_has_a_reason(name: str) -> None:
    found = model(name).ranges()
    assert found.ranges
    for item in found.ranges:
        for limit in (item.lower, item.upper):
            assert limit.kind in ("dead-centre", "full-turn", "far")
        assert_full_turns_have_no_limits(item)


def assert_full_turns_have_no_limits(item: Range) -> None:
    assert (item.turns > 0) == (item.lower.kind == item.upper.kind == "full-turn")


def test_unknown_names_are_told() -> None:
    rcsr = mk.load(FILE_OF["rcsr"])
    with pytest.raises(mk.UsageError, match=r"there is no input O2\.theta; inputs are O1\.theta"):
        rcsr.ranges("O2.theta")
    with pytest.raises(mk.UsageError, match=r"there is no coordinate O9\.theta"):
        rcsr.ranges(outputs=["O9.theta"])


def test_slides_of_rccc_grow_out_of_bounds() -> None:
    """Where its turns have a dead centre, its slides go with their rates, which are infinite."""
    for item in model("rccc").ranges().ranges:
        assert (item.lower.kind, item.upper.kind) == ("unbounded", "unbounded")
    inputs = {"J1.theta": {"from": 0, "to": 100, "step": 2}}
    result = edited("rccc", ["J4.s"], motion={"inputs": inputs})
    (note,) = result.diagnostics
    assert note.code == "unbounded"
    assert "the slide of J4 grows out of bounds" in note.message
    assert abs(result["J4.s"][result["row.status"] == "ok"][-1]) > 100


@pytest.mark.parametrize("before", [1e-6, 1e-3, 0.1, 1.0, 1.6, 5.0, 20.0])
@pytest.mark.parametrize("side", [7, 3])
def test_modes_next_to_a_dead_centre_share_a_circuit(before: float, side: int) -> None:
    """Crank and coupler in line at both ends of the rocker's swing, the law of cosines; the first
    row stands some degrees before one of them."""

    def angle(length: float) -> float:
        return math.pi - math.acos((36 + 16 - length**2) / (2 * 6 * 4))

    drawn = angle(math.hypot(x_of(2, 5, 4, 6), y_of(2, 5, 4, 6)))
    lower, upper = sorted(math.degrees(angle(length) - drawn) for length in (3, 7))
    at = upper - before if side == 7 else lower + before
    found = four_bar(2, 5, 4, 6, "D", at).ranges()
    swings = [item for item in found.ranges if abs(item.upper.value - upper) < 1]
    assert len(swings) == 2
    assert len({item.circuit for item in swings}) == 1
    for item in swings:
        assert abs(item.lower.value - lower) < 1e-8
        assert abs(item.upper.value - upper) < 1e-8


AT_DEAD_CENTRE = """format: 1
plane: xy
units: {{length: mm}}
links: {{c: {{}}, d: {{}}, e: {{}}}}
joints:
  A: {{type: R, links: [ground, c], point: {a}}}
  B: {{type: R, links: [c, d], point: {b}}}
  C: {{type: R, links: [d, e], point: {c}}}
  S: {{type: P, links: [ground, e], point: {c}, axis: {axis}}}
motion: {{inputs: {{A.theta: {{values: [0, 5]}}}}}}
"""


@pytest.mark.parametrize("turned", [0.0, 0.5, 2.0])
@pytest.mark.parametrize(
    ("a", "b", "c"),
    [
        ((-3, 34), (-6, -33), (43, -33)),
        ((0, 0), (0, -1), (1, -1)),
        ((0, 0), (-1, -1), (1, -1)),
        ((0, 0), (-3, -4), (3, -4)),
    ],
)
def test_a_range_begins_at_the_dead_centre_at_which_it_is_drawn(
    a: tuple[int, int], b: tuple[int, int], c: tuple[int, int], turned: float
) -> None:
    """The rod stands square to the slide: the crank's pin may not come farther from it, and comes
    back to this distance when the crank has turned by twice the angle to the normal."""

    def at(x: float, y: float) -> list[float]:
        cosine, sine = math.cos(turned), math.sin(turned)
        return [cosine * x - sine * y, sine * x + cosine * y]

    text = AT_DEAD_CENTRE.format(a=at(*a), b=at(*b), c=at(*c), axis=at(0, 1))
    (item,) = mk.loads(text).ranges().ranges
    x, y = b[0] - a[0], b[1] - a[1]
    end = 2.0 * math.degrees(math.acos(x / math.hypot(x, y)))
    assert (item.lower.kind, item.upper.kind) == ("dead-centre", "dead-centre")
    assert item.lower.value == pytest.approx(0.0, abs=1e-9)
    assert item.upper.value == pytest.approx(end, abs=1e-9)


STRETCHED = """format: 1
plane: xy
units: {{length: mm, angle: rad}}
links: {{a: {{}}, b: {{}}, c: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: {points[0]}}}
  B: {{type: R, links: [a, b], point: {points[1]}}}
  C: {{type: R, links: [b, c], point: {points[2]}}}
  D: {{type: R, links: [ground, c], point: {points[3]}}}
motion: {{inputs: {{A.theta: {{values: [0, 0.01]}}}}}}
"""


@pytest.mark.parametrize("shift", [0, 1])
@pytest.mark.parametrize(
    "points",
    [
        [(-1, -1), (-4, 5), (-6, 6), (-8, 7)],
        [(0, 0), (0, 4), (2, 3), (6, 1)],
        [(0, 0), (0, 3), (4, 3), (10, 3)],
        [(0, 0), (10, 40), (26, 28), (42, 16)],
    ],
)
def test_a_range_begins_where_two_bars_are_drawn_in_line(
    points: list[tuple[int, int]], shift: int
) -> None:
    """Stretched: the crank comes back to this distance on the other side of the frame, unless the
    bars fold before."""
    moved = [[x + shift, y + shift] for x, y in points]
    found = mk.loads(STRETCHED.format(points=moved)).ranges()
    a, b, c, d = (complex(*point) for point in points)
    width = 2.0 * abs(cmath.phase((b - a) / (d - a)))
    crank, frame, folded = abs(b - a), abs(d - a), abs(abs(c - b) - abs(d - c))
    if folded > abs(frame - crank):
        cosine = (crank**2 + frame**2 - folded**2) / (2.0 * crank * frame)
        width = width / 2.0 - math.acos(cosine)
    for item in found.ranges:
        assert (item.lower.kind, item.upper.kind) == ("dead-centre", "dead-centre")
        ends = item.lower.value, item.upper.value
        assert min(map(abs, ends)) < 1e-12
        assert ends[1] - ends[0] == pytest.approx(width, abs=1e-12)
    assert len(found.circuits) == 1
