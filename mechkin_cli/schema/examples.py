"""An example of every key whose kind of value has none of its own, for editors.

By the key, or by section and key where sections mean different things by one key. A test holds
every example against the schema of its key.
"""

from __future__ import annotations

from typing import Any, Final

_R: Final = {"type": "R", "links": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]}
_TURN: Final = {"from": 0, "to": 360, "step": 5, "rate": "10 rad/s"}

BY_KEY: Final[dict[str, Any]] = {
    "accept": ["unphysical-inertia"],
    "actuators": ["leg1.s", "leg2.s"],
    "across": [0, 0, 1],
    "along": {"O3": ["B", "C"]},
    "assembly": {"near": {"O4.theta": 37}},
    "axes": {"x": [1, 0, 0], "y": [0, 1, 0]},
    "axis": [0, 0, 1],
    "axis2": [0, 1, 0],
    "balances": [{"name": "work", "type": "work"}],
    "between": ["P", "Q"],
    "camera": [1, -2, 1],
    "center_of_mass": ["r/2", 0, "10 mm"],
    "chain": [
        {"joint": "A", "type": "R", "link": "one", "theta": 0, "s": 0, "alpha": 40, "a": 1},
        {"joint": "B", "type": "R", "link": "ground", "theta": 0, "s": 0, "alpha": -40, "a": 1},
    ],
    "coefficients": [{"name": "system", "row": 1}],
    "colours": {"crank": "#c0392b"},
    "columns": ["O1.theta", {"label": "torque", "value": "O1.effort", "decimals": 2}],
    "count": 73,
    "counted": 24,
    "data": ["m2"],
    "decimals": 3,
    "direction": [0, -1, 0],
    "directions": {"d": {"link": "crank", "vector": [1, 0, 0]}},
    "driven": {"A.theta": {"at": "30 deg"}},
    "efforts": {"A.theta": "8 N*m - 0.4 N*m*s/rad*A.theta_dot"},
    "follow": ["O1"],
    "force": [0, 0, "-10 N"],
    "groove": [1, 0, 0],
    "hidden": ["frame"],
    "inertia": {"xx": "2 kg*mm^2", "yy": 20, "zz": 20},
    "inputs": {"O1.theta": _TURN},
    "joints": {"O1": _R},
    "label": "theta [of the crank]",
    "links": ["ground", "crank"],
    "loads": [{"type": "gravity", "g": "standard"}],
    "mode": "A",
    "motion": {"inputs": {"O1.theta": _TURN}},
    "name": "RSSR with a long coupler",
    "near": {"O4.theta": 37},
    "normal": [0, 0, 1],
    "of": ["ground.shaking_force"],
    "orders": [0, 1, 2, 4],
    "over": "O1.theta_dot",
    "parameters": {"r": "40 mm", "k": "2 N/mm"},
    "paths": ["coupler_point"],
    "pin": [1, 0, 0],
    "plot": {"x": "theta", "y": ["torque"]},
    "point": [0, "r", "10 mm"],
    "points": {"P": {"link": "crank", "at": ["r", 0, 0]}},
    "published": "published/table_3.csv",
    "quantities": {"gap": "norm(P.position - Q.position)"},
    "remarks": [{"text": "The source rounds to six digits."}],
    "responses": {"fall": {"start": {"A.theta": 80}, "time": {"from": 0, "to": 3, "step": 0.1}}},
    "rows_by": "theta",
    "runs": ["sweep", "fall"],
    "shapes": {"coupler": "plate"},
    "slot": [0, 0, 1],
    "source": "A textbook, page 12",
    "start": {"A.theta": "80 deg", "A.theta_dot": "0 rad/s"},
    "stop": [{"turns": "A.theta", "count": 3}],
    "summary": ["max", "min", "rms"],
    "tables": [{"name": "drive", "columns": ["O1.theta", "O1.effort"]}],
    "text": "The source rounds to six digits.",
    "time": {"from": 0, "to": "2 s", "step": 0.1},
    "title": "Torque of the motor",
    "torque": [0, 0, "5 N*m"],
    "units": {"length": "mm", "angle": "deg", "mass": "kg", "force": "N"},
    "values": [0, 15, "40 deg"],
    "vector": [1, 0, 0],
    "view": {"hidden": ["frame"]},
    "x": [1, 0, 0],
    "y": [0, 1, 0],
    "zero": {"ground": [1, 0, 0], "crank": [0, 1, 0]},
}

BY_SECTION: Final[dict[tuple[str, str], Any]] = {
    ("ListedTime", "values"): [0, 0.1, "0.5 s"],
    ("MechanismFile", "links"): {
        "crank": {"mass": "0.4 kg", "center_of_mass": ["r/2", 0, 0]},
        "rod": {},
    },
    ("Plot", "x"): "theta",
    ("Plot", "y"): ["torque"],
    ("Polynomial", "coefficients"): [0, "10 deg/s", "2 deg/s^2"],
    ("PinInSlotJoint", "point"): [0, "r"],
    ("PlanePrismaticJoint", "point"): [0, "r"],
    ("PlaneRevoluteJoint", "point"): [0, "r"],
    ("PinInSlotJoint", "slot"): [0, 1],
    ("PlaneDirectionOfLink", "vector"): [1, 0],
    ("PlaneFile", "directions"): {"d": {"link": "crank", "vector": [1, 0]}},
    ("PlaneFile", "joints"): {"O1": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]}},
    ("PlaneFile", "links"): {"crank": {"mass": "0.4 kg", "center_of_mass": ["r/2", 0]}, "rod": {}},
    ("PlaneFile", "plane"): "xy",
    ("PlaneFile", "points"): {"P": {"link": "crank", "at": ["r", 0]}},
    ("PlaneForce", "force"): [0, "-10 N"],
    ("PlaneForce", "point"): [0, "r"],
    ("PlaneGravity", "direction"): [0, -1],
    ("PlaneLink", "center_of_mass"): ["r/2", 0],
    ("PlaneLink", "inertia"): "20 kg*mm^2",
    ("PlanePointOfLink", "at"): ["r", 0],
    ("PlanePrismaticJoint", "axis"): [1, 0],
    ("PlaneRevoluteJoint", "zero"): {"ground": [1, 0], "crank": [0, 1]},
    ("PlaneTorque", "torque"): "5 N*m",
    ("PointOfLink", "at"): ["r", 0, 0],
    ("PrintedRemark", "columns"): ["theta4"],
    ("ShapeOfLink", "points"): ["O1", [0, 10, 0]],
}


def example(section: str, key: str) -> Any:
    """The example of a key of a section; None where it has none here."""
    return BY_SECTION.get((section, key), BY_KEY.get(key))
