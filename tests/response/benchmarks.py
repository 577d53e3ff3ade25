"""Published test problems of multibody dynamics, as text of format 1.

Andrews' squeezer: Test Set for Initial Value Problem Solvers (Mazzia, Magherini), after Hairer and
Wanner, Solving Ordinary Differential Equations II, VII.7. Bricard's mechanism (A04), the stiff
flyball governor (A05) and the row of four-bars through its singular position (A02): Gonzalez,
Dopico, Lugris and Cuadrado, Multibody System Dynamics 16 (2006), and the benchmark library of the
University of La Coruna. The spatial slider-crank: Haug, Computer Aided Kinematics and Dynamics of
Mechanical Systems, 1989, section 12.3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

Point = Sequence[float]


def text(
    name: str,
    links: dict[str, str],
    joints: dict[str, str],
    points: dict[str, str],
    loads: list[str],
    response: list[str],
    more: str = "",
) -> str:
    """A file from its entries, angles in rad."""
    rows = [f"format: 1\nname: {name}\nunits: {{angle: rad}}", "links:"]
    rows += [f"  {key}: {{{value}}}" for key, value in links.items()]
    rows += ["joints:", *(f"  {key}: {{{value}}}" for key, value in joints.items())]
    rows += ["points:"] if points else []
    rows += [f"  {key}: {{{value}}}" for key, value in points.items()]
    rows += ["loads:", *(f"  - {{{load}}}" for load in loads)] if loads else []
    rows += [more] if more else []
    rows += ["responses:", "  run:", *(f"    {line}" for line in response), ""]
    return "\n".join(rows)


def place(p: Point) -> str:
    return "[" + ", ".join(repr(float(x)) for x in p) + "]"


def hinge(first: str, second: str, p: Point, axis: Point = (0, 0, 1)) -> str:
    return f"type: R, links: [{first}, {second}], point: {place(p)}, axis: {place(axis)}"


def body(mass: float, centre: Point, inertia: Point, products: Point = (0, 0, 0)) -> str:
    keys = ("xx", "yy", "zz", "xy", "xz", "yz")
    entries = ", ".join(f"{k}: {v!r}" for k, v in zip(keys, (*inertia, *products), strict=True))
    return f"mass: {mass!r}, center_of_mass: {place(centre)}, inertia: {{{entries}}}"


def rod(mass: float, p: Point, q: Point, width: float = 0.0) -> str:
    """A straight rod of square section, by its ends."""
    centre = [(a + b) / 2 for a, b in zip(p, q, strict=True)]
    d = [b - a for a, b in zip(p, q, strict=True)]
    square = sum(x * x for x in d)
    across, along = mass * (square + width**2) / 12, mass * width**2 / 6
    tensor = [
        [(i == j) * across + (along - across) * d[i] * d[j] / square for j in range(3)]
        for i in range(3)
    ]
    return body(
        mass,
        centre,
        [tensor[i][i] for i in range(3)],
        (tensor[0][1], tensor[0][2], tensor[1][2]),
    )


SQUEEZER_END = {
    "beta": 15.81077119629904,
    "Theta": -15.75637105984298,
    "gamma": 0.04082224013073101,
    "Phi": -0.5347301163226948,
    "delta": 0.5244099658805304,
    "Omega": 0.5347301163226948,
    "epsilon": 1.048080741042263,
}
"""At 0.03 s, as published."""
SQUEEZER_START = {
    "beta": -0.0617138900142764496358948458001,
    "Theta": 0.0,
    "gamma": 0.455279819163070380255912382449,
    "Phi": 0.222668390165885884674473185609,
    "delta": 0.487364979543842550225598953530,
    "Omega": -0.222668390165885884674473185609,
    "epsilon": 1.23054744454982119249735015568,
}
SQUEEZER_JOINTS = {
    "beta": "O",
    "Theta": "K1K2",
    "gamma": "B",
    "Phi": "K5K4",
    "delta": "A5",
    "Omega": "K7K6",
    "epsilon": "A7",
}
"""Which hinge counts what, from its value at the start on."""


def squeezer(response: Sequence[str] = ("time: {from: 0, to: 0.03, count: 7}",)) -> str:
    """Seven bodies in a plane; three loops meet at P."""
    b, t, g, f, d, w, e = (SQUEEZER_START[k] for k in SQUEEZER_END)

    def ray(angle: float, length: float, start: Point = (0.0, 0.0)) -> tuple[float, float]:
        return start[0] + length * math.cos(angle), start[1] + length * math.sin(angle)

    quarter = math.pi / 2
    at_a, at_b, at_c = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
    pin = ray(b, 0.007)
    at_p = ray(b + t + math.pi, 0.028, pin)
    end5, end7 = ray(d, 0.04, at_a), ray(e - quarter, 0.04, at_a)
    at_d = ray(g - quarter, 0.018, ray(g, 0.02, at_b))
    centres = {
        "K1": ray(b, 0.00092),
        "K2": ray(b + t + math.pi, 0.0115, pin),
        "K3": ray(g + quarter, 0.01043, ray(g, 0.01874, at_b)),
        "K4": ray(f + d - quarter, 0.02 - 0.01421, end5),
        "K5": ray(d + quarter, 0.00916, ray(d, 0.02308, at_a)),
        "K6": ray(w + e, 0.02 - 0.01421, end7),
        "K7": ray(e, 0.00449, ray(e - quarter, 0.01228, at_a)),
    }
    masses = (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498)
    spins = (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
    links = {
        name: body(m, (*centre, 0.0), (0.0, 0.0, spin))
        for (name, centre), m, spin in zip(centres.items(), masses, spins, strict=True)
    }
    joints = {
        "O": hinge("ground", "K1", (0, 0, 0)),
        "K1K2": hinge("K1", "K2", (*pin, 0)),
        "P3": hinge("K2", "K3", (*at_p, 0)),
        "B": hinge("ground", "K3", (*at_b, 0)),
        "P4": hinge("K2", "K4", (*at_p, 0)),
        "K5K4": hinge("K5", "K4", (*end5, 0)),
        "A5": hinge("ground", "K5", (*at_a, 0)),
        "P6": hinge("K2", "K6", (*at_p, 0)),
        "K7K6": hinge("K7", "K6", (*end7, 0)),
        "A7": hinge("ground", "K7", (*at_a, 0)),
    }
    points = {
        "C": f"link: ground, at: {place((*at_c, 0))}",
        "D": f"link: K3, at: {place((*at_d, 0))}",
    }
    loads = [
        "type: spring, between: [C, D], stiffness: 4530, free: 0.07785",
        "type: torque, joint: O, value: 0.033",
    ]
    return text(
        "Andrews' squeezer",
        links,
        joints,
        points,
        loads,
        ["start: {O.theta: 0}", "tolerance: 1e-13", *response],
        "accept: [unphysical-inertia]",
    )


def bricard(response: Sequence[str] = ("time: {from: 0, to: 2, step: 0.25}",)) -> str:
    """Six edges of a cube, of which one is ground; every hinge is square to both its edges."""
    corners = [(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)]
    axes = [(0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0)]
    names = ["ground", *(f"rod{k}" for k in range(1, 6)), "ground"]
    links = {f"rod{k + 1}": rod(1.0, corners[k], corners[k + 1], 0.1) for k in range(5)}
    joints = {f"J{k + 1}": hinge(names[k], names[k + 1], corners[k], axes[k]) for k in range(6)}
    points = {"P3": f"link: rod3, at: {place(corners[3])}"}
    return text(
        "Bricard's mechanism",
        links,
        joints,
        points,
        ["type: gravity, g: [0, -9.81, 0]"],
        ["start: {J1.theta: 0}", "tolerance: 1e-13", *response],
    )


def governor(response: Sequence[str] = ("time: {from: 0, to: 1, step: 0.125}",)) -> str:
    """Shaft, slider, two rods with balls, and two stiff springs with dampers."""
    density, tilt = 3000.0, math.radians(60)
    mass = density * 1e-4
    slider = density * 1e-3
    links = {
        "shaft": rod(mass, (0, 0, 0), (0, 0, 1), 0.01),
        "slider": body(slider, (0, 0, 0.5), (slider * 0.01 / 6,) * 3),
    }
    joints = {
        "S": hinge("ground", "shaft", (0, 0, 0)),
        "P": "type: P, links: [shaft, slider], point: [0, 0, 0.5], axis: [0, 0, 1]",
    }
    points, loads = {}, ["type: gravity, g: [0, 0, -9.81]"]
    for name, side in (("right", 1), ("left", -1)):
        top = (0.05 * side, 0.0, 1.0)
        tip = (top[0] + side * math.sin(tilt), 0.0, 1 - math.cos(tilt))
        middle = [(a + b) / 2 for a, b in zip(top, tip, strict=True)]
        links[f"{name}_rod"] = rod(mass, top, tip, 0.01)
        links[f"{name}_ball"] = f"mass: 5, center_of_mass: {place(tip)}"
        joints[name] = hinge("shaft", f"{name}_rod", top, (0, -side, 0))
        joints[f"{name}_weld"] = f"type: W, links: [{name}_rod, {name}_ball]"
        points[f"{name}_middle"] = f"link: {name}_rod, at: {place(middle)}"
        points[f"{name}_side"] = f"link: slider, at: {place((0.05 * side, 0, 0.5))}"
        ends = f"between: [{name}_middle, {name}_side]"
        loads += [f"type: spring, {ends}, stiffness: 8e5, free: 0.5"]
        loads += [f"type: damper, {ends}, damping: 4e4"]
    start = "S.theta: 0, P.s: 0, right.theta: 0, left.theta: 0"
    rate = f"S.theta_dot: {2 * math.pi!r} rad/s"
    return text(
        "stiff flyball governor",
        links,
        joints,
        points,
        loads,
        [f"start: {{{start}, {rate}}}", *response],
    )


def slider_crank(
    response: Sequence[str] = ("time: {from: 0, to: 2, step: 0.25}", "tolerance: 1e-13"),
) -> str:
    """A crank about x whose rod, on a sphere and a universal joint, pushes a slide along x."""
    crank = (0.0, 0.1, 0.12)
    pin = (0.0, 0.1, 0.2)
    end = (math.sqrt(0.3**2 - 0.1**2 - 0.2**2), 0.0, 0.0)
    middle = [(a + b) / 2 for a, b in zip(pin, end, strict=True)]
    d = [b - a for a, b in zip(pin, end, strict=True)]
    length = 0.3
    across, along = 0.004, 0.0004
    tensor = [
        [(i == j) * across + (along - across) * d[i] * d[j] / length**2 for j in range(3)]
        for i in range(3)
    ]
    links: dict[str, Any] = {
        "crank": body(0.12, crank, (1e-4, 1e-5, 1e-4)),
        "rod": body(
            0.5,
            middle,
            [tensor[i][i] for i in range(3)],
            (tensor[0][1], tensor[0][2], tensor[1][2]),
        ),
        "slider": body(2.0, end, (1e-4, 1e-4, 1e-4)),
    }
    # the universal joint's cross is square to the rod and to the slide's z axis
    side = (d[1], -d[0], 0.0)
    joints = {
        "A": hinge("ground", "crank", crank, (1, 0, 0)),
        "B": f"type: S, links: [crank, rod], point: {place(pin)}",
        "C": f"type: U, links: [slider, rod], point: {place(end)}, axis: [0, 0, 1],"
        f" axis2: {place(side)}",
        "D": f"type: P, links: [ground, slider], point: {place(end)}, axis: [1, 0, 0]",
    }
    return text(
        "spatial slider-crank",
        links,
        joints,
        {},
        ["type: gravity, g: [0, 0, -9.81]"],
        ["start: {A.theta: 0, A.theta_dot: 6 rad/s}", *response],
    )


def four_bars(
    windows: int = 2,
    response: Sequence[str] = ("time: {from: 0, to: 3, step: 0.125}", "tolerance: 1e-13"),
) -> str:
    """Equal links in a row, upright on ground, joined at their tops; one freedom, and as many
    more as links stand upright while all lie in one line."""
    links, joints = {}, {}
    for k in range(windows + 1):
        links[f"bar{k}"] = rod(1.0, (k, 0, 0), (k, 1, 0))
        joints[f"G{k}"] = hinge("ground", f"bar{k}", (k, 0, 0))
    for k in range(windows):
        links[f"top{k}"] = rod(1.0, (k, 1, 0), (k + 1, 1, 0))
        joints[f"L{k}"] = hinge(f"bar{k}", f"top{k}", (k, 1, 0))
        joints[f"R{k}"] = hinge(f"top{k}", f"bar{k + 1}", (k + 1, 1, 0))
    return text(
        "four-bars in a row",
        links,
        joints,
        {},
        ["type: gravity, g: [0, -9.81, 0]"],
        ["start: {G0.theta: 0, G0.theta_dot: -1 rad/s}", *response],
        "assembly: {at_branch_points: straight}",
    )
