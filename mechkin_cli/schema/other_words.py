"""Words of other programs and of what mechkin leaves out, and what to write instead.

Looked up for an unknown key or type, before the nearest known word is.
"""

from __future__ import annotations

from typing import Final

_FRICTION = "friction is a load: loads: [{type: friction, joint: A, coefficient: 0.1, ...}]"
_CONTACT = (
    "mechkin has no contact: bodies that stay in touch are a joint (Sp: a sphere on a plane, Sg: a "
    "sphere in a groove), and a response may end where they would meet (stop:)"
)
_RATIO = "tie two inputs by their ratio: motion: {inputs: {B.theta: {with: -2*A.theta}, ...}}"
_CAM = (
    "give the follower a law: {law: table, file: lift.csv} with time, or {with: an expression of "
    "the cam's angle}"
)
_RIGID = "links are rigid; put a spring between two of them: {type: spring, joint: A, ...}"
_CONTROL = (
    "an effort may be an expression of coordinates, rates and time: responses: {NAME: {efforts: "
    '{A.theta: "-k*(A.theta - 1 rad) - c*A.theta_dot"}}}'
)
_MOTOR = (
    "prescribe a motion under motion: inputs:, or give a torque or force under responses: {NAME: "
    "{efforts: {A.theta: 10 N*m}}}"
)
_STUDY = (
    "give another value with --set NAME=VALUE, or many from Python: load(FILE).vary({NAME: values})"
)
_RESPONSE = (
    "a motion under forces stands under responses: {NAME: {start: {A.theta: 20}, time: {from: 0, "
    "to: 2, step: 0.1}}}"
)
_LOAD = "write loads: [{type: gravity, g: standard}], likewise force, torque, spring, damper"

_OUTSIDE: Final = {
    **dict.fromkeys(("contact", "contacts", "collision", "impact", "clearance"), _CONTACT),
    **dict.fromkeys(("gear", "gears", "gearing", "belt", "pulley", "chain_drive", "rack"), _RATIO),
    **dict.fromkeys(("cam", "cams", "follower"), _CAM),
    **dict.fromkeys(("flexible", "elastic", "beam", "beams", "bushing", "bushings"), _RIGID),
    **dict.fromkeys(("control", "controls", "controller", "pid"), _CONTROL),
    **dict.fromkeys(("motor", "motors", "drive", "drives", "engine"), _MOTOR),
    "friction": _FRICTION,
}
"""What is asked for at any place."""

TOP_KEYS: Final = {
    **_OUTSIDE,
    **dict.fromkeys(("study", "studies", "sweep", "optimize", "optimization"), _STUDY),
    **dict.fromkeys(
        ("simulate", "simulation", "dynamics", "transient", "initial", "initial_conditions"),
        _RESPONSE,
    ),
    **dict.fromkeys(("gravity", "force", "forces", "torque", "torques", "springs"), _LOAD),
    "dampers": _LOAD,
    "bodies": "bodies are links:",
    "constraints": "constraints are joints:",
    "efforts": "efforts belong to a response: responses: {NAME: {efforts: {A.theta: 10 N*m}}}",
    "events": "a response ends at its stop: [{value: A.theta, at: 45}]",
    "stop": "a response ends at its own stop:; write it under responses: {NAME: ...}",
    "time": "moments belong to motion: {time: ...}, or to a response",
}
"""Keys of the file."""

LOAD_TYPES: Final = {
    **_OUTSIDE,
    "moment": "a moment is a torque: {type: torque, ...}",
    "couple": "a couple is a torque: {type: torque, ...}",
    "weight": "weights follow from the masses and {type: gravity, g: standard}",
    "acceleration": "write {type: gravity, g: [x, y, z]}",
    "damping": "write {type: damper, ..., damping: c}",
    "stiffness": "write {type: spring, ..., stiffness: k}",
    "effort": "efforts belong to a response: responses: {NAME: {efforts: {A.theta: 10 N*m}}}",
    "actuator": _MOTOR,
}
"""Types of a load."""

JOINT_TYPES: Final = {
    **_OUTSIDE,
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

JOINT_KEYS: Final = {
    "friction": _FRICTION,
    "damping": "a damper is a load: loads: [{type: damper, joint: A, coordinate: theta, ...}]",
    "stiffness": "a spring is a load: loads: [{type: spring, joint: A, coordinate: theta, ...}]",
    "limits": "joints have no stops; a response may end where a coordinate comes to a value: stop:",
    "motor": _MOTOR,
    "drive": _MOTOR,
}
"""Keys of every joint."""


def advice_for_key(section: str, key: str) -> str | None:
    """What to do instead of a key that a section, by the name of its class, does not have."""
    if section == "MechanismFile":
        return TOP_KEYS.get(key.casefold())
    if section.endswith("Joint"):
        return JOINT_KEYS.get(key.casefold())
    return None


def advice_for_type(section: str, word: str) -> str | None:
    """What to do instead of a type that `loads` or `joints` do not have."""
    found = {"loads": LOAD_TYPES, "joints": JOINT_TYPES}.get(section, {})
    return found.get(word.casefold())
