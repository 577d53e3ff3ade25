"""What to write instead of words of other programs, and of what mechkin leaves out."""

from __future__ import annotations

from typing import Final

FRICTION = "friction is a load: loads: [{type: friction, joint: A, coefficient: 0.1, ...}]"
CONTACT = (
    "mechkin has no contact: bodies that stay in touch are a joint (Sp: a sphere on a plane, Sg: a "
    "sphere in a groove), and a response may end where they would meet (stop:)"
)
RATIO = "tie two inputs by their ratio: motion: {inputs: {B.theta: {with: -2*A.theta}, ...}}"
CAM = (
    "give the follower a law: {law: table, file: lift.csv} with time, or {with: an expression of "
    "the cam's angle}"
)
RIGID = "links are rigid; put a spring between two of them: {type: spring, joint: A, ...}"
CONTROL = (
    "an effort may be an expression of coordinates, rates and time: responses: {NAME: {efforts: "
    '{A.theta: "-k*(A.theta - 1 rad) - c*A.theta_dot"}}}'
)
MOTOR = (
    "prescribe a motion under motion: inputs:, or give a torque or force under responses: {NAME: "
    "{efforts: {A.theta: 10 N*m}}}"
)
STUDY = (
    "give another value with --set NAME=VALUE, or many from Python: load(FILE).vary({NAME: values})"
)
RESPONSE = (
    "a motion under forces stands under responses: {NAME: {start: {A.theta: 20}, time: {from: 0, "
    "to: 2, step: 0.1}}}"
)
PLANE = (
    "write plane: xy, then points and forces as [x, y], inertias and torques as one number, and "
    "hinges as R without an axis"
)
COEFFICIENT = (
    "give it to a friction of its joint: loads: [{type: friction, joint: A, coefficient: 0.1, "
    "radius: 8 mm}]"
)
DAMPER = (
    "a damper is a load: loads: [{type: damper, joint: A, coordinate: theta, damping: 0.1 "
    "N*m*s/rad}]"
)
ROWS_IN_TIME = (
    "moments stand under time: {from: 0, to: 2, step: 0.1}, of motion: or of a response under "
    "responses:"
)
STEPS = (
    "a response takes its own steps: responses: {NAME: {tolerance: 1e-10}}, or fixed_step: 1e-3 s"
)
ACTUATORS = "coordinates at which efforts act: actuators: [leg1.s, leg2.s]"
NOTE = "write name: and source:, or a comment behind #"
TABLES = "what is written stands under tables: [{name: t, columns: [A.theta, A.effort]}]"
PARAMETERS = "named values stand under parameters: {r: 40 mm}"
LIMITS = (
    "joints have no stops; a response may end where a coordinate comes to a value: stop: [{value: "
    "A.theta, at: 45}]"
)
LOAD = "write loads: [{type: gravity, g: standard}], likewise force, torque, spring, damper"

OUTSIDE: Final = {
    **dict.fromkeys(("contact", "contacts", "collision", "impact", "clearance"), CONTACT),
    **dict.fromkeys(("gear", "gears", "gearing", "belt", "pulley", "chain_drive", "rack"), RATIO),
    **dict.fromkeys(("cam", "cams", "follower"), CAM),
    **dict.fromkeys(("flexible", "elastic", "beam", "beams", "bushing", "bushings"), RIGID),
    **dict.fromkeys(("control", "controls", "controller", "pid"), CONTROL),
    **dict.fromkeys(("motor", "motors", "drive", "drives", "engine"), MOTOR),
    "friction": FRICTION,
}
"""What is asked for at any place."""
