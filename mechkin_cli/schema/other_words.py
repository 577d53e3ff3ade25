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


_SPATIAL = "it is a pair in space; a plane has R, P, Ps (a pin in a slot) and W"
_POSE = (
    "a pose in a plane is P along x, P along y and R, one after the other through two links "
    "without mass; their coordinates may be inputs"
)
PLANE_JOINT_TYPES: Final = {
    **JOINT_TYPES,
    **dict.fromkeys(("c", "h", "s", "sp", "u", "e", "ss", "sc", "cp"), _SPATIAL),
    **dict.fromkeys(("f", "free", "pose"), _POSE),
    "sg": "a pin in a slot is Ps, with slot: [x, y]",
    **dict.fromkeys(
        ("pin_in_slot", "slot", "half", "pinslot"), "a pin in a slot is Ps, with slot: [x, y]"
    ),
    **dict.fromkeys(("cylindrical", "cylindric", "cylinder", "spherical"), _SPATIAL),
    **dict.fromkeys(("helical", "screw", "thread", "universal", "cardan"), _SPATIAL),
    **dict.fromkeys(("hooke", "ball", "sphere", "globe", "planar", "plane"), _SPATIAL),
}
"""Types of a joint in a plane file."""


def advice_for_type(section: str, word: str, in_plane: bool = False) -> str | None:
    """What to do instead of a type that `loads` or `joints` do not have."""
    joints = PLANE_JOINT_TYPES if in_plane else JOINT_TYPES
    found = {"loads": LOAD_TYPES, "joints": joints}.get(section, {})
    return found.get(word.casefold())
