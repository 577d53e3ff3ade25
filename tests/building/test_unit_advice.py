"""What a file is told of its units: gravity in a wrong one, forces in one that it does not name."""

from __future__ import annotations

import pytest

import mechkin_cli as mk

FILE = """\
format: 1
UNITS
links: {arm: {mass: 2, center_of_mass: [300 mm, 0, 0]}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
motion: {inputs: {O.theta: {at: 0}}}
loads: [{type: gravity, g: GRAVITY}]
"""
MM = "units: {length: mm, force: N}"


def model(units: str, gravity: str = "[0, 0, 0]") -> mk.Model:
    return mk.loads(FILE.replace("UNITS", units).replace("GRAVITY", gravity))


def codes(found: mk.Model) -> list[str]:
    return [diagnostic.code for diagnostic in found.diagnostics]


@pytest.mark.parametrize(
    ("units", "gravity", "meant"),
    [
        (MM, "[0, -9.81, 0]", "[0, -9.81 m/s^2, 0]"),
        (MM, "[0, 0, -9.80665]", "[0, 0, -9.80665 m/s^2]"),
        (MM, "[0, -6.94, 6.94]", "[0, -6.94 m/s^2, 6.94 m/s^2]"),
        (MM, "[0, -386.09, 0]", "[0, -386.09 in/s^2, 0]"),
        (MM, "[0, -32.2, 0]", "[0, -32.2 ft/s^2, 0]"),
        (MM, "[0, -10, 0]", "[0, -10 m/s^2, 0]"),
        ("units: {length: in, force: lbf}", "[0, -9.81, 0]", "[0, -9.81 m/s^2, 0]"),
        ("units: {length: m}", "[0, -9810, 0]", "[0, -9810 mm/s^2, 0]"),
        ("units: {time: min, force: N}", "[0, -9.81, 0]", "[0, -9.81 m/s^2, 0]"),
    ],
)
def test_gravity_in_a_wrong_unit_warns_with_the_cure(units: str, gravity: str, meant: str) -> None:
    (found,) = model(units, gravity).diagnostics
    assert (found.code, found.severity) == ("gravity-unit", "warning")
    assert f"write g: {meant}, or g: standard" in str(found)
    assert codes(model(units, meant)) == []


@pytest.mark.parametrize(
    ("units", "gravity"),
    [
        (MM, "[0, -9810, 0]"),
        (MM, "[0, -1620, 0]"),
        (MM, "[0, -9.81 mm/s^2, 0]"),
        (MM, "standard"),
        (MM, "[0, 0, 0]"),
        ("units: {length: m}", "[0, -9.81, 0]"),
        ("units: {length: m}", "[0, -1.62, 0]"),
        ("units: {length: in, mass: lbm, force: lbf}", "[0, -386.09, 0]"),
    ],
)
def test_gravity_as_it_should_be_says_nothing(units: str, gravity: str) -> None:
    assert codes(model(units, gravity)) == []


@pytest.mark.parametrize("units", [MM, "units: {length: m}", "units: {length: in, force: lbf}"])
def test_standard_gravity(units: str) -> None:
    assert model(units, "standard").problem.mechanism.gravity == (0.0, 0.0, -9.80665)
    found = model(units, "standard, direction: [0, -3, 4]").problem.mechanism.gravity
    assert found == pytest.approx((0, -0.6 * 9.80665, 0.8 * 9.80665), rel=1e-15)


def test_standard_gravity_drives_a_pendulum() -> None:
    effort = model(MM, "standard, direction: [0, -1, 0]").analyze()["O.effort"][0]
    assert effort == pytest.approx(2 * 9.80665 * 300, rel=1e-14)  # N mm


@pytest.mark.parametrize(
    ("gravity", "words"),
    [
        ("[0, -9.81, 0], direction: [0, 1, 0]", "write g: standard, or no direction"),
        ("standrad", "did you mean standard?"),
        ("-9.81", "expected a list"),
        ("standard, direction: [0, 0, 0]", "this direction is zero"),
    ],
)
def test_gravity_that_cannot_be(gravity: str, words: str) -> None:
    with pytest.raises(mk.InvalidFile, match=words.replace("?", r"\?")):
        model("units: {length: m}", gravity)


@pytest.mark.parametrize(
    ("units", "words"),
    [
        ("units: {length: mm}", "forces are in N and moments in N*mm"),
        ("units: {mass: g}", "forces are in N and moments in N*m;"),
        ("units: {length: in, mass: lbm}", "such as force: lbm*in/s^2"),
        ("units: {time: ms}", "such as force: kg*m/ms^2"),
    ],
)
def test_a_unit_system_without_force_says_what_it_is(units: str, words: str) -> None:
    (found,) = model(units).diagnostics
    assert (found.code, found.severity) == ("force-unit", "note")
    assert words in str(found)
    assert str(found.place) == "text:2:1"


@pytest.mark.parametrize("units", ["", MM, "units: {length: m, angle: rad}", "units: {angle: rad}"])
def test_a_coherent_unit_system_says_nothing(units: str) -> None:
    assert codes(model(units)) == []


SWING = "responses: {swing: {start: {O.theta: 1}, time: {from: 0, to: 1, count: 2}EFFORTS}}\n"


@pytest.mark.parametrize(
    "section",
    [
        "",
        "tables: [{name: t, columns: [O.theta]}]",
        "tables: [{name: t, columns: [O.effort, norm(O.force)]}]",
        "coefficients: [{name: c, row: 1}]",
        SWING.replace("EFFORTS", ""),
    ],
)
def test_a_file_that_writes_no_force_needs_no_unit_of_one(section: str) -> None:
    text = FILE.replace("UNITS", "units: {length: mm}").partition("loads")[0]
    assert codes(mk.loads(f"{text}{section}")) == []


def test_an_effort_of_a_response_has_a_unit_of_force() -> None:
    text = FILE.replace("UNITS", "units: {length: mm}").partition("loads")[0]
    section = SWING.replace("EFFORTS", ", efforts: {O.theta: 3}")
    assert codes(mk.loads(f"{text}{section}")) == ["force-unit"]


@pytest.mark.parametrize(
    ("units", "coefficients", "bad"),
    [
        ("{angle: deg}", "[0, »3]", "3 may be meant in deg/s or in rad/s"),
        ("{angle: deg}", "[0, 3 deg/s, »-2]", "-2 may be meant in deg/s^2 or in rad/s^2"),
        ("{angle: rad, time: ms}", "[0, »3]", "3 may be meant in rad/ms or in rad/s"),
        ("{angle: rad, angular_rate: rpm}", "[0, »3]", "3 may be meant in rad/s or in rpm"),
        ("{angle: rad}", "[0, 3, 4, 5]", ""),
        ("{angle: deg, angular_rate: deg/s}", "[0, 3, 4, 5]", ""),
        ("{angle: deg}", "[7, 3 deg/s, 0, 4 rad/s^3]", ""),
        ("{angle: deg}", "[7, 0, 0]", ""),
    ],
)
def test_bare_coefficients_of_an_angle(units: str, coefficients: str, bad: str) -> None:
    text = FILE.replace("UNITS", f"units: {units}").replace("GRAVITY", "standard")
    law = f"{{law: polynomial, coefficients: {coefficients}}}"
    marked = text.replace("{at: 0}}", f"{law}}}, time: {{from: 0, to: 1, step: 1}}")
    if not bad:
        mk.loads(marked)
        return
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(marked.replace("»", ""), "m")
    before = marked[: marked.index("»")]
    assert str(caught.value).startswith(f"m:5:{len(before) - before.rfind(chr(10))}: error: {bad}")


def test_bare_torsional_damping_is_per_radian_and_second() -> None:
    text = FILE.replace("[300 mm, 0, 0]", "[0, 0, 0]").replace("GRAVITY", "[0, 0, 0]")
    text = text.replace("{at: 0}", "{at: 0, rate: 3 rad/s}").replace(
        "loads: [", "loads: [{type: damper, joint: O, coordinate: theta, damping: 5}, "
    )
    for rate in ("rad/s", "rpm", "deg/s"):
        found = mk.loads(text.replace("UNITS", f"units: {{angular_rate: {rate}}}")).analyze()
        assert found["O.effort"][0] == pytest.approx(15.0, rel=1e-14)


@pytest.mark.parametrize(
    "length", ["1e-101", "-1e-150", "1e-320", "1e-400", "1e-98 mm", "5e-324 mm", "r"]
)
@pytest.mark.parametrize("place", ["point: [0, 0, 0]", "center_of_mass: [300 mm, 0, 0]"])
def test_tiny_lengths_are_refused_in_words(length: str, place: str) -> None:
    key = place.partition(":")[0]
    text = FILE.replace("UNITS", "parameters: {r: 3e-60 m*1e-60}")
    text = text.replace("GRAVITY", "standard").replace(place, f"{key}: [1, {length}, 0]")
    with pytest.raises(mk.InvalidFile, match="too small"):
        mk.loads(text)


def test_lengths_that_are_zero_or_small_are_lengths() -> None:
    text = FILE.replace("UNITS", "").replace("GRAVITY", "standard")
    for length in ("0", "0e-400", "-0.0", "1e-99", "1e-100"):
        mk.loads(text.replace("point: [0,", f"point: [{length},").replace("300 mm", "1e-98"))
