"""Everyday words for quantities and parts: each is answered with what to write, by one table."""

from __future__ import annotations

import re

import pytest

import mechkin_cli as mk

PLANE = """\
format: 1
plane: xy
units: {length: mm, force: N}
links: {crank: {mass: 1, center_of_mass: [1, 0], inertia: 3}, rod: {}, slider: {}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0]}
  A: {type: R, links: [crank, rod], point: [40, 0]}
  B: {type: R, links: [rod, slider], point: [160, 0]}
  D: {type: P, links: [ground, slider], point: [160, 0], axis: [1, 0]}
motion: {inputs: {O.theta: {from: 10, to: 90, step: 40, rate: 1 rad/s}}}
points: {p: {link: rod, at: [100, 0]}}
loads: [{type: gravity, g: standard}]
"""
SPACE = """\
format: 1
units: {length: mm, force: N}
links: {crank: {mass: 1, center_of_mass: [1, 0, 0]}, rod: {}, slider: {}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: S, links: [crank, rod], point: [40, 0, 0]}
  B: {type: C, links: [rod, slider], point: [160, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, slider], point: [160, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {O.theta: {from: 10, to: 90, step: 40, rate: 1 rad/s}}}
points: {p: {link: rod, at: [100, 0, 0]}}
loads: [{type: gravity, g: standard}]
"""
FILES = {"plane": PLANE, "space": SPACE}


def hint(text: str) -> str:
    """The only error's advice."""
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    (error,) = caught.value.diagnostics
    return error.hint or ""


LINK = "named under points:, has position, velocity and acceleration"
QUANTITIES = {
    "O.torque": "O.effort",
    "O.motor_torque": "O.effort",
    "A.torque": "an effort acts where there is one: O.effort",
    "O.angle": "O.theta",
    "O.rotation": "O.theta",
    "O.phi": "O.theta",
    "O.omega": "O.theta_dot",
    "O.speed": "O.theta_dot",
    "O.rpm": "O.theta_dot",
    "O.alpha": "O.theta_ddot",
    "D.velocity": "D.s_dot",
    "D.v": "D.s_dot",
    "D.acceleration": "D.s_ddot",
    "D.displacement": "D.s",
    "D.stroke": "D.s",
    "D.position": "D.s",
    "O.power": "O.effort*O.theta_dot",
    "D.power": "O.effort*O.theta_dot",
    "A.reaction": "norm(A.force)",
    "A.bearing_load": "norm(A.force)",
    "A.fx": "A.force.x",
    "D.force_y": "D.force.y",
    "O.force.magnitude": "norm(O.force)",
    "O.forc": "O.force",
    "D.friction": "{type: friction, joint: D, ...}",
    "p.speed": "norm(p.velocity)",
    "p.acc": "norm(p.acceleration)",
    "p.x": "p.position.x",
    "p.vy": "p.velocity.y",
    "crank.theta": LINK,
    "crank.angle": LINK,
    "crank.torque": LINK,
    "crank.force": LINK,
    "rod.velocity": LINK,
    "slider.position": LINK,
    "crank.angular_velocity": "crank.omega",
    "energy": "row.kinetic_energy and row.potential_energy",
    "row.energy": "row.kinetic_energy and row.potential_energy",
}


@pytest.mark.parametrize("name", QUANTITIES)
@pytest.mark.parametrize("form", FILES)
def test_a_quantity_by_another_word(form: str, name: str) -> None:
    found = hint(f'{FILES[form]}tables: [{{name: t, columns: ["{name}"]}}]\n')
    assert QUANTITIES[name] in found
    if found.startswith("did you mean"):
        # what is offered can be written
        for offered in re.sub(r"^did you mean |\?$", "", found).split(" or "):
            assert mk.loads(FILES[form]).analyze()[offered].shape[0] == 3


@pytest.mark.parametrize("name", ["O.torque", "D.velocity", "A.reaction", "O.forc"])
def test_python_says_the_same(name: str) -> None:
    model = mk.loads(PLANE)
    with pytest.raises(mk.UsageError, match=re.escape(QUANTITIES[name])):
        model.analyze([name])
    with pytest.raises(mk.MechkinError, match=re.escape(QUANTITIES[name])):
        model.analyze()[name]


FEATURES = {
    "a cable over points and pulleys is a coupling": ("rope", "cable", "ropes", "tendon", "winch"),
    "belts and chains over pulleys are couplings": ("sprocket", "belt", "timing_belt"),
    "the wheel's angle is a function of the crank's": ("geneva", "maltese", "geneva_drive"),
    "whose curve: is a line": ("curved_groove", "curved_slot", "guide_curve"),
    "an oil film is a law of friction": ("hydrodynamic", "lubrication", "oil_film"),
    "links are rigid": ("flexible", "compliant", "beam", "flexure"),
    "an effort may be an expression": ("control", "controller", "controllers", "servo", "pid"),
    "a cylinder stands between two named points": ("cylinder", "hydraulic", "piston", "jack"),
    "wheels and racks are couplings of joints": ("gear", "gearbox", "transmission", "pinion"),
    "a worm is a gear whose axes pass each other": ("worm", "worm_gear"),
    "bevel wheels are a gear whose axes meet": ("bevel",),
    "a planetary gear is two couplings": ("planetary", "epicyclic"),
    "a differential is a coupling of three": ("differential",),
    "a rack and its pinion are a coupling": ("rack",),
    "a cam is a coupling of its angle": ("cam", "follower"),
    "coordinates that move in a ratio are a coupling": ("tie", "ratio", "coupling"),
    "a wheel that rolls without slip": ("rolling", "wheel", "roller"),
    "mechkin has no contact": ("contact", "ratchet", "escapement", "clutch"),
    "a brake is a load": ("brake",),
}
EVERYWHERE = (
    "geneva",
    "rope",
    "curved_groove",
    "hydrodynamic",
    "flexible",
    "controllers",
    "ratchet",
)
ASKED = [(words, word) for words, each in FEATURES.items() for word in each]


@pytest.mark.parametrize(("words", "word"), ASKED)
@pytest.mark.parametrize("form", FILES)
def test_a_feature_as_a_type_and_as_a_section(form: str, words: str, word: str) -> None:
    text = FILES[form]
    for bad in (
        text.replace("D: {type: P", f"D: {{type: {word}"),
        text.replace("{type: gravity, g: standard}", f"{{type: {word}, joint: O}}"),
        text.replace("{type: gravity, g: standard}", f"{{type: {word.upper()}, joint: O}}"),
        f"{text}{word}: {{of: O}}\n",
    ):
        assert words in hint(bad), bad


@pytest.mark.parametrize("word", EVERYWHERE)
@pytest.mark.parametrize("form", FILES)
def test_a_feature_as_a_key_of_anything(form: str, word: str) -> None:
    (words,) = (words for words, each in FEATURES.items() if word in each)
    text = FILES[form]
    for place in ("rod: {", "links: [ground, slider], ", "motion: {", "{type: gravity, "):
        assert words in hint(text.replace(place, f"{place}{word}: 3, ", 1).replace(", }", "}"))
    friction = text.replace("g: standard}", "g: standard}, {type: friction, joint: O, radius: 8}")
    friction = friction.replace("radius: 8}", f"radius: 8, coefficient: 0.1, {word}: 1}}")
    assert words in hint(friction)


def test_the_curved_slot_that_is_advised_runs() -> None:
    """A slide at x puts the pin of an ellipse of half axes 30 and 20 at 20 sqrt(1 - x^2/900)."""
    advice = hint(PLANE.replace("D: {type: P", "D: {type: curved_slot"))
    joint = advice.partition("joints: {")[2].removesuffix("}")
    rows = mk.loads(
        "format: 1\nplane: xy\nunits: {length: mm, angle: deg}\n"
        "links: {cart: {}, pin: {}, slotted: {}}"
        "\njoints:\n  X: {type: P, links: [ground, cart], point: [0, 0], axis: [1, 0]}\n"
        "  Y: {type: P, links: [cart, pin], point: [0, 0], axis: [0, 1]}\n"
        f"  W: {{type: W, links: [ground, slotted]}}\n  {joint}\n"
        "motion: {inputs: {X.s: {from: -6, to: -18, step: 6}}}\n"
    ).analyze()
    assert set(rows["row.status"]) == {"ok"}
    x = 30.0 + rows["X.s"]
    assert abs(rows["Y.s"]) == pytest.approx(20.0 * (1.0 - x * x / 900.0) ** 0.5, abs=1e-9)


def test_a_chain_is_a_coupling() -> None:
    """In space the key chain: is there, for rows of Denavit and Hartenberg."""
    for text in FILES.values():
        assert "belts and chains over pulleys are couplings" in hint(
            text.replace("D: {type: P", "D: {type: chain")
        )
    assert "a chain over two wheels is a coupling" in hint(f"{PLANE}chain: 3\n")


HEAD = "format: 1\nplane: xy\nunits: {length: mm, force: N}\n"
TWO = """\
links: {one: {mass: 1, center_of_mass: [9, 0], inertia: 20}, other: {}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0]}
  D: {type: P, links: [ground, other], point: [50, 0], axis: [0, 1]}
"""
WHEEL = """\
links: {crank: {}, wheel: {inertia: 20, mass: 1, center_of_mass: [50, 0]}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  W: {type: R, links: [ground, wheel], point: [50, 0]}
"""
PIN = """\
links: {arm: {mass: 1, center_of_mass: [50, 0], inertia: 3}, rod: {}}
joints:
  A: {type: R, links: [ground, arm], point: [0, 0]}
  B: {type: R, links: [arm, rod], point: [50, 0]}
points: {p: {link: rod, at: [90, 20]}}
"""
SWEPT = "A.theta: {from: -60, to: 60, step: 20, rate: 1 rad/s}"


@pytest.mark.parametrize(
    ("links", "inputs", "load"),
    [
        (TWO, SWEPT + ", D.s: {with: 20 mm*A.theta, drive: tie}", ""),
        (TWO, SWEPT + ", D.s: {with: -20 mm*A.theta, drive: tie}", ""),
        (
            WHEEL,
            SWEPT + ', W.theta: {with: "if(abs(A.theta) < 45 deg, -atan2(sin(A.theta), 2^0.5 - '
            'cos(A.theta)), -sign(A.theta)*45 deg)", drive: tie}',
            "",
        ),
        (WHEEL, SWEPT + ", W.theta: {with: 2*A.theta, drive: tie}", ""),
        (
            PIN,
            "p.position.x: {from: 90, to: 80, step: 5, rate: -1}, p.position.y: {with: "
            '"20 mm + (p.position.x - 90 mm)^2/(100 mm)", drive: own}',
            "",
        ),
        (
            WHEEL,
            SWEPT + ", W.theta: {at: 0}",
            "{type: damper, joint: A, coordinate: theta, damping: 0.1 N*m*s/rad}, {type: torque, "
            'joint: A, value: "-3 N*m*sign(A.theta_dot)"}',
        ),
    ],
)
def test_what_is_advised_can_be_written(links: str, inputs: str, load: str) -> None:
    text = f"{HEAD}{links}motion: {{inputs: {{{inputs}}}}}\nloads: [{load}]\n"
    analysis = mk.loads(text).analyze()
    assert analysis.complete
    assert analysis.diagnostics == ()
