"""Types of loads and joints in the words of other programs, each with what to write instead.

Looked up before the nearest known word is.
"""

from __future__ import annotations

from typing import Final

from mechkin_cli.schema.other_sentences import (
    MOTOR,
    OUTSIDE,
)

LOAD_TYPES: Final = {
    **OUTSIDE,
    "moment": "a moment is a torque: {type: torque, ...}",
    "couple": "a couple is a torque: {type: torque, ...}",
    "weight": "weights follow from the masses and {type: gravity, g: standard}",
    "acceleration": "write {type: gravity, g: [x, y, z]}",
    "damping": "write {type: damper, ..., damping: c}",
    "stiffness": "write {type: spring, ..., stiffness: k}",
    "effort": "efforts belong to a response: responses: {NAME: {efforts: {A.theta: 10 N*m}}}",
    "actuator": MOTOR,
}
"""Types of a load."""

JOINT_TYPES: Final = {
    **OUTSIDE,
    **dict.fromkeys(("revolute", "hinge", "pin", "turning", "pivot"), "a hinge is R"),
    **dict.fromkeys(("prismatic", "slider", "sliding", "translational"), "a slider is P"),
    **dict.fromkeys(("cylindrical", "cylindric", "cylinder"), "turning and sliding is C"),
    **dict.fromkeys(("helical", "screw", "thread"), "a screw is H, with lead: length per turn"),
    **dict.fromkeys(("spherical", "ball", "sphere", "globe"), "a ball joint is S"),
    **dict.fromkeys(("universal", "cardan", "hooke"), "a universal joint is U"),
    **dict.fromkeys(("planar", "plane"), "a plane on a plane is E"),
    **dict.fromkeys(("fixed", "weld", "rigid", "welded"), "what is one body is W"),
    "spring": "a spring is a load: loads: [{type: spring, ...}]",
    "damper": "a damper is a load: loads: [{type: damper, ...}]",
    "motor": "a motor is no joint: give the type of the pair that it turns, and its effort",
}
"""Types of a joint."""


def advice_for_type(section: str, word: str) -> str | None:
    """What to do instead of a type that `loads` or `joints` do not have."""
    found = {"loads": LOAD_TYPES, "joints": JOINT_TYPES}.get(section, {})
    return found.get(word.casefold())
