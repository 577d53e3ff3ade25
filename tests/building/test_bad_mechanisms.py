"""What a file says is checked before anything is computed: place, what is wrong, what to do."""

import pytest
from building.bad_parts import BAD_PARTS
from building.bad_responses import BAD_RESPONSES
from building.bad_uses import BAD_USES
from building.sound import SOUND, BadMechanism

import mechkin_cli as mk
from mechkin_cli.diagnostics import Diagnostic


def errors(text: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(mk.InvalidFile) as caught:
        _ = mk.loads(text, "bad.yaml").graph
    return caught.value.diagnostics


def places(text: str) -> list[tuple[str, int]]:
    return [(found.code, found.place.line) for found in errors(text) if found.place]


def test_the_file_they_are_made_from_is_sound() -> None:
    assert mk.loads(SOUND).diagnostics == ()


@pytest.mark.parametrize(
    "bad", [*BAD_PARTS, *BAD_USES, *BAD_RESPONSES], ids=lambda bad: f"{bad.code} {bad.new.strip()}"
)
def test_one_error_at_the_place_of_the_mistake(bad: BadMechanism) -> None:
    (error,) = errors(bad.text)
    line, column = bad.place
    assert str(error).startswith(f"bad.yaml:{line}:{column}: error: ")
    assert error.code == bad.code
    missing = [words for words in bad.words if words not in str(error)]
    assert not missing, str(error)


def test_a_misspelt_plane_is_the_only_error() -> None:
    text = """format: 1
Plane: xy
links: {crank: {mass: 1, center_of_mass: [20, 0], inertia: 10 kg*mm^2}}
joints: {O: {type: R, links: [ground, crank], point: [0, 0]}}
motion: {inputs: {O.theta: {from: 0, to: 90, step: 10}}}
"""
    for word in ("Plane", "plan", "in_plane"):
        (error,) = errors(text.replace("Plane", word))
        assert str(error).startswith("bad.yaml:2:1: error: there is no key")
        assert "plane" in str(error)


def test_independent_errors_are_reported_together_in_the_order_of_the_file() -> None:
    text = (
        SOUND.replace("mass: 1,", "mass: -1,")
        .replace("axis: [0, 0.2, 1]", "axis: [0, 0, 0]")
        .replace("{from: -70, to: 70, step: 5}", "{from: -70, to: 70, step: 0}")
        .replace("g: [0, -9810, 0]", "g: [0, 1 N, 0]")
        .replace("columns: [O.theta]", "columns: [O.theta, D.phi]")
    )
    assert places(text) == [
        ("negative-mass", 5),
        ("zero-direction", 11),
        ("zero-step", 15),
        ("expression", 16),
        ("expression", 17),
    ]


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("k: 2", "k: 2*kk, m: 3*k, n2: m", "expression"),
        ("r: 40 mm", "r: 40 mmm", "expression"),
        ("[ground, crank]", "[ground, crnk]", "unknown-link"),
        ("p: {link: crank", "p: {link: crnk", "unknown-link"),
        ("n: {link: crank", "n: {link: crnk", "unknown-link"),
        ("step: 5", "step: 0", "zero-step"),
        ("step: 5", "step: 5 mm", "expression"),
    ],
)
def test_what_uses_a_refused_name_is_not_reported_again(old: str, new: str, code: str) -> None:
    users = """\
assembly: {near: {O.theta: 0}}
loads:
  - {type: torque, joint: O, value: 1}
  - {type: spring, between: [p, q], stiffness: 1, free: r}
tables:
  - {name: t, columns: [O.theta, O.effort, O.force.x, p.position.x, n.x, k*D.s]}
"""
    text = SOUND.replace("O.theta: {from", "O.theta: {rate: k*1 rad/s, from").split("loads:")[0]
    mk.loads(text + users)
    assert text.count(old) == 1
    assert [error.code for error in errors(text.replace(old, new) + users)] == [code]


def test_one_direction_for_both_links_of_a_planar_joint_is_one_mistake() -> None:
    planar = "{type: E, links: [crank, rod], point: [0, r, 10], normal: [0, 0, 1], x: [0, 0, 3]}"
    text = SOUND.replace("{type: S, links: [crank, rod], point: [0, r, 10]}", planar)
    assert places(text) == [("zero-parallel", 10)]


@pytest.mark.parametrize(
    ("old", "new", "codes"),
    [
        (
            "{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}",
            "{type: R, links: [grund, crnk], point: [0, 0, 1 kg], axis: [0, 0, 0]}",
            ["unknown-link", "unknown-link", "expression", "zero-direction"],
        ),
        (
            "{type: R, links: [rod, slider], point: [120, 0, 10], axis: [0, 0.2, 1]}",
            "{type: H, links: [rod, slidr], point: [120, 0, 10], axis: [0, 0, 0], lead: 0}",
            ["unknown-link", "zero-direction", "zero-lead"],
        ),
    ],
)
def test_independent_errors_of_one_joint_are_reported_together(
    old: str, new: str, codes: list[str]
) -> None:
    assert [code for code, _ in places(SOUND.replace(old, new))] == codes


@pytest.mark.parametrize(
    "joint",
    [
        "{type: R, LINKS, axis: [0, 0, 0], zero: {crank: [1, 0, 0], rod: [1, 0, 0]}}",
        "{type: U, LINKS, axis: [0, 0, 0], axis2: [1, 0, 0]}",
        "{type: E, LINKS, normal: [0, 0, 0], x: [1, 0, 0]}",
    ],
)
def test_what_stands_in_for_a_zero_axis_is_parallel_to_nothing(joint: str) -> None:
    whole = joint.replace("LINKS", "links: [crank, rod], point: [0, r, 10]")
    text = SOUND.replace("{type: S, links: [crank, rod], point: [0, r, 10]}", whole)
    assert places(text) == [("zero-direction", 10)]


def test_numbers_behind_a_message_are_there_for_programs() -> None:
    (error,) = errors(SOUND.replace("mass: 1,", "mass: 1e101,"))
    assert error.record()["numbers"] == [{"name": "value", "value": 1e101, "limit": 1e100}]
    (warning,) = mk.loads(SOUND.replace("{xx: 1, yy: 1, zz: 1}", SLENDER)).diagnostics
    moments = [{"name": "principal moment", "value": m, "unit": "kg*mm^2"} for m in (1, 1, 3)]
    numbers = warning.record()["numbers"]
    assert numbers == [part | {"value": pytest.approx(part["value"])} for part in moments]


HELICAL = """\
format: 1
links: {nut: {}}
joints: {J: {type: H, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1], lead: 0.01}}
motion: {inputs: INPUTS}
"""


def test_turn_and_slide_of_a_helical_joint_are_one_freedom() -> None:
    (error,) = errors(HELICAL.replace("INPUTS", "{J.theta: {at: 0}, J.s: {at: 0}}"))
    assert error.code == "driven-twice"
    assert str(error).startswith("bad.yaml:4:37: error: J.theta and J.s are one freedom")


def test_freedoms_that_nothing_drives_are_named() -> None:
    (error,) = errors(HELICAL.replace("motion: {inputs: INPUTS}", ""))
    assert error.code == "undriven-freedom"
    assert "J.theta" in error.message
    assert error.place is not None
    assert error.place.line == 3


SLENDER = "{xx: 1, yy: 1, zz: 3}"


def test_an_inertia_of_no_real_body_is_a_warning_with_its_principal_moments() -> None:
    text = SOUND.replace("{xx: 1, yy: 1, zz: 1}", SLENDER)
    (warning,) = mk.loads(text, "odd.yaml").diagnostics
    assert (warning.code, warning.severity) == ("unphysical-inertia", "warning")
    assert str(warning).startswith("odd.yaml:5:57: warning: the inertia of crank")
    assert warning.measured == "principal moments 1, 1, 3 kg*mm^2"


def test_an_acknowledged_inertia_is_no_warning() -> None:
    text = SOUND.replace("{xx: 1, yy: 1, zz: 1}", SLENDER) + "accept: [unphysical-inertia]\n"
    assert mk.loads(text).diagnostics == ()


def test_a_tensor_at_the_limit_of_a_flat_body_is_no_warning() -> None:
    text = SOUND.replace("{xx: 1, yy: 1, zz: 1}", "{xx: 1, yy: 1, zz: 2}")
    assert mk.loads(text).diagnostics == ()
