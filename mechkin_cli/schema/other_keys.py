"""Keys of other programs, at a wrong place, or of what mechkin leaves out: what to write instead.

Looked up for an unknown key before the nearest known one is.
"""

from __future__ import annotations

from typing import Final

from mechkin_cli.schema.other_sentences import (
    ACTUATORS,
    COEFFICIENT,
    DAMPER,
    FRICTION,
    LIMITS,
    LOAD,
    MOTOR,
    NOTE,
    OUTSIDE,
    PARAMETERS,
    PLANE,
    RESPONSE,
    ROWS_IN_TIME,
    STEPS,
    STUDY,
    TABLES,
)

TOP_KEYS: Final = {
    **OUTSIDE,
    **dict.fromkeys(("study", "studies", "sweep", "optimize", "optimization"), STUDY),
    **dict.fromkeys(
        ("simulate", "simulation", "dynamics", "transient", "initial", "initial_conditions"),
        RESPONSE,
    ),
    **dict.fromkeys(("start", "driven", "response", "free_motion", "integrate"), RESPONSE),
    **dict.fromkeys(("gravity", "force", "forces", "torque", "torques", "springs"), LOAD),
    **dict.fromkeys(("g", "spring", "damper", "dampers", "moment", "moments"), LOAD),
    **dict.fromkeys(("planar", "dimension", "2d", "dimensions"), PLANE),
    **dict.fromkeys(("mu", "coulomb", "stiction", "friction_coefficient"), COEFFICIENT),
    "frictions": FRICTION,
    **dict.fromkeys(("viscous", "damping", "dissipation"), DAMPER),
    **dict.fromkeys(("actuator", "actuation", "actuated"), ACTUATORS),
    **dict.fromkeys(("t_end", "t_start", "tspan", "t_span", "end_time", "tend"), ROWS_IN_TIME),
    **dict.fromkeys(("duration", "time", "times", "dt", "timestep", "time_step"), ROWS_IN_TIME),
    **dict.fromkeys(("solver", "integrator", "tolerance", "tolerances"), STEPS),
    **dict.fromkeys(("rtol", "atol", "fixed_step", "max_step", "method"), STEPS),
    **dict.fromkeys(("output", "outputs", "plot", "plots", "columns", "results"), TABLES),
    **dict.fromkeys(("variables", "constants", "variable", "constant"), PARAMETERS),
    **dict.fromkeys(("title", "description", "author", "comment", "notes"), NOTE),
    **dict.fromkeys(("limit", "limits", "stops", "end_stops"), LIMITS),
    "version": "the version of the format stands in format: 1",
    "bodies": "bodies are links:",
    "body": "bodies are links:",
    "constraints": "constraints are joints:",
    "pairs": "pairs are joints:",
    **dict.fromkeys(
        ("mass", "masses", "inertia"), "mass and inertia stand with their link: links:"
    ),
    **dict.fromkeys(("input", "inputs"), "inputs stand under motion: {inputs: {A.theta: ...}}"),
    **dict.fromkeys(("mode", "near"), "write assembly: {near: {A.theta: 20}}, or mode: A there"),
    **dict.fromkeys(
        ("work", "harmonics", "flywheel", "fourier"),
        "write balances: [{name: work, type: work}], likewise harmonics and flywheel",
    ),
    **dict.fromkeys(
        ("published", "rows_by", "printed"),
        "printed values belong to a table: tables: [{name: t, published: {file: printed.csv, "
        "rows_by: t}, columns: ...}]",
    ),
    "run": "a run is named where it is read: tables: [{name: t, run: NAME, ...}], or --run NAME",
    "runs": "a load names its runs: loads: [{type: gravity, g: standard, runs: [NAME]}]",
    "efforts": "efforts belong to a response: responses: {NAME: {efforts: {A.theta: 10 N*m}}}",
    "events": "a response ends at its stop: [{value: A.theta, at: 45}]",
    "stop": "a response ends at its own stop:; write it under responses: {NAME: ...}",
}
"""Keys of the file."""

JOINT_KEYS: Final = {
    "friction": FRICTION,
    "damping": "a damper is a load: loads: [{type: damper, joint: A, coordinate: theta, ...}]",
    "stiffness": "a spring is a load: loads: [{type: spring, joint: A, coordinate: theta, ...}]",
    **dict.fromkeys(
        ("mu", "coulomb", "stiction", "coefficient", "friction_coefficient"), COEFFICIENT
    ),
    **dict.fromkeys(("viscous", "dampings"), DAMPER),
    **dict.fromkeys(("limit", "limits", "min", "max", "range", "stops"), LIMITS),
    **dict.fromkeys(("motor", "drive", "actuator", "actuated"), MOTOR),
    **dict.fromkeys(
        ("parent", "child", "bodies", "body1", "body2", "from", "to", "between"),
        "the two links stand in links: [first, second]; coordinates are of the second against the "
        "first",
    ),
    **dict.fromkeys(("at", "position", "location", "origin"), "the place is point:, a vector"),
    **dict.fromkeys(
        ("initial", "initial_value", "value", "theta0", "angle"),
        "every coordinate is zero as drawn; which assembly is meant says assembly: {near: ...}",
    ),
}
"""Keys of every joint."""

FRICTION_KEYS: Final = {
    "mu": "the key is coefficient: a number, or {static: .15, sliding: .1, speed: 5 mm/s}",
    **dict.fromkeys(
        ("static", "sliding", "speed", "mu_s", "mu_k", "kinetic", "stribeck"),
        "they belong to the coefficient: {static: .15, sliding: .1, speed: 5 mm/s}",
    ),
    **dict.fromkeys(("viscous", "damping"), DAMPER),
    "diameter": "radius is half of it",
    "force": "a constant force of friction is a load: {type: force, joint: A, value: "
    "-3 N*sign(A.s_dot)}",
    "torque": "a constant torque of friction is a load: {type: torque, joint: A, value: "
    "-3 N*m*sign(A.theta_dot)}",
    "coordinate": "friction acts on all that the joint leaves free; leave it out",
}
"""Keys of friction."""

RESPONSE_KEYS: Final = {
    **dict.fromkeys(
        ("t_end", "t_start", "tspan", "t_span", "duration", "end", "to", "end_time"),
        "write time: {from: 0, to: 2, step: 0.1}",
    ),
    **dict.fromkeys(
        ("count", "dt", "timestep", "time_step"),
        "rows stand under time: {from, to, step}, the integrator's own step under fixed_step",
    ),
    **dict.fromkeys(
        ("initial_conditions", "initial", "x0", "state", "begin"),
        "write start: {A.theta: 20, A.theta_dot: 0 rad/s}",
    ),
    **dict.fromkeys(
        ("rtol", "atol", "accuracy", "epsilon", "error"), "the key is tolerance: 1e-10"
    ),
    **dict.fromkeys(
        ("solver", "method", "integrator"),
        "the integrator is chosen by itself: DOP853, where it is stiff Radau IIA; leave it out",
    ),
    **dict.fromkeys(
        ("effort", "forces", "force", "torque", "torques", "motor", "motors"),
        "write efforts: {A.theta: 10 N*m}",
    ),
    **dict.fromkeys(
        ("drive", "drives", "prescribed", "motion", "law"),
        "coordinates that move by laws stand under driven: {A.theta: {law: harmonic, ...}}",
    ),
    "assembly": "write near: {A.theta: 20} or mode: A here",
    "at_branch_points": "write assembly: {at_branch_points: straight} in the file",
    "friction": FRICTION,
    "actuators": "in a response efforts act where efforts: names them; leave it out",
    "columns": "columns stand in tables: [{name: t, run: NAME, columns: [...]}]",
    "rates": "rates stand in start: {A.theta: 20, A.theta_dot: 1 rad/s}",
    "gravity": LOAD,
}
"""Keys of a response."""

MOTION_KEYS: Final = {
    "driven": "in the sweep they are inputs:; driven: belongs to a response",
    "efforts": "in the sweep efforts follow from the motion; as given they belong to a response",
    "start": RESPONSE,
    **dict.fromkeys(
        ("input", "drive", "drives"), "write inputs: {A.theta: {from: 0, to: 90, step: 5}}"
    ),
    **dict.fromkeys(
        ("from", "to", "step", "count", "values"),
        "rows belong to an input: inputs: {A.theta: {from: 0, to: 90, step: 5}}, or to time:",
    ),
}
"""Keys of the motion."""

TABLE_KEYS: Final = {
    "rows_by": "it stands with the file: published: {file: printed.csv, rows_by: t}",
    "remarks": "they stand with the file: published: {file: printed.csv, remarks: [...]}",
    "file": "printed values are published: {file: printed.csv}; its own file is called by name:",
    "runs": "a table reads one run: run: NAME",
    "response": "the key is run: NAME",
    **dict.fromkeys(
        ("values", "quantities", "outputs", "rows"), "the key is columns: [A.theta, ...]"
    ),
    "summary": "from Python: r = m.analyze(); max(r[NAME]); a table has the rows of its run",
}
"""Keys of a table."""

_SECTIONS: Final = {
    "MechanismFile": TOP_KEYS,
    "PlaneFile": TOP_KEYS,
    "FrictionAtJoint": FRICTION_KEYS,
    "PlaneFriction": FRICTION_KEYS,
    "Response": RESPONSE_KEYS,
    "MotionSection": MOTION_KEYS,
    "Table": TABLE_KEYS,
}


def advice_for_key(section: str, key: str) -> str | None:
    """What to do instead of a key that a section, by the name of its class, does not have."""
    known = JOINT_KEYS if section.endswith("Joint") else {}
    return _SECTIONS.get(section, known).get(key.casefold())
