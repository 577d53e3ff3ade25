"""The mechanisms of the yardstick: two serial chains of R and P joints from ground, closed between
their last frames by a point (3 equations) or a weld (6 equations).

All axes, points, mass centres and inertias are given in ground axes in the reference configuration
q = 0, so that the pose of a body is the product of the screw exponentials of its chain; the two
chains need not close there.

joints[k]: name, type R or P, unit axis a, point p on it, parent joint (-1: ground), body or None;
joints[0] is the input. bodies[b]: mass m, mass centre c, inertia I about it, fixed to the joint
with that body. closure: type, last joints jL, jR and points pL, pR of the two sides.
"""

import numpy as np

G = np.array([0.3, -9.0, -3.5])
"""Gravity, in a generic direction."""
OMEGA, ALPHA = 2.0, 0.7
"""Rate and acceleration of the input, rad/s and rad/s^2."""
D2R = np.pi / 180


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v)


def _inertia(m, size, tilt):
    """Inertia of a box of dimensions `size`, turned by the rotation vector `tilt`."""
    a, b, c = size
    tensor = np.diag([b * b + c * c, a * a + c * c, a * a + b * b]) * m / 12
    t = np.linalg.norm(tilt)
    k = np.asarray(tilt, float) / t
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    R = np.eye(3) + np.sin(t) * K + (1 - np.cos(t)) * K @ K
    tensor = R @ tensor @ R.T
    return 0.5 * (tensor + tensor.T)


def _joint(name, kind, axis, point, parent, body):
    point = np.asarray(point, float)
    return {"name": name, "type": kind, "a": axis, "p": point, "parent": parent, "body": body}


def _body(m, c, tensor):
    return {"m": m, "c": np.asarray(c, float), "I": tensor}


def rcsr():
    """The RCSR of the dissertation; the C as an R and a P, closed at the S."""
    c12, s12, c15, s15 = np.cos(12 * D2R), np.sin(12 * D2R), np.cos(15 * D2R), np.sin(15 * D2R)
    P1, P2, P3, P4, s1, s4 = 0.5, 0.8, 0.4, 0.5, 5.0, 4.0
    a1, a2, a4 = np.array([-1.0, 0, 0]), -np.array([c12, 0, s12]), np.array([c15, 0, -s15])
    off = np.array([-s1, 0, 0])
    joints = [
        _joint("th1", "R", a1, np.zeros(3), -1, 0),
        _joint("th2", "R", a2, off + np.array([0, -P1, 0]), 0, None),
        _joint("S2", "P", a2, off + np.array([0, -P1, 0]), 1, 1),
        _joint("th4", "R", a4, [0, P4, 0.0], -1, 2),
    ]
    on_rocker = np.array([0, 0.7, 0]) + 3.4 * a4 + [0, 0, 0.06]
    bodies = [
        _body(
            1.2, off + np.array([0.9, -0.30, 0.08]), _inertia(1.2, (0.9, 0.5, 0.1), (0.3, 0.2, 0.1))
        ),
        _body(
            0.7,
            off + np.array([-0.2, -0.95, 0.05]),
            _inertia(0.7, (0.2, 0.8, 0.1), (-0.2, 0.4, 0.3)),
        ),
        _body(0.9, on_rocker, _inertia(0.9, (1.2, 0.4, 0.1), (0.1, -0.5, 0.2))),
    ]
    left, right = off + np.array([0, -(P1 + P2), 0]), np.array([0, P4 + P3, 0]) + s4 * a4
    return {
        "name": "rcsr",
        "joints": joints,
        "bodies": bodies,
        "closure": {"type": "point", "jL": 2, "jR": 3, "pL": left, "pR": right},
        "input": np.arange(150, 203) * D2R,
        "q_seed": (180 * D2R, np.array([-61.675 * D2R, -8.879, -18.386 * D2R])),
    }


def rssr():
    """Crank of 1 about z at the origin, coupler of 4, rocker of 2.5 about a generic axis.

    The first S is a U (two R), which takes the idle spin away; the coupler is a slender rod, so
    that input torque and forces are those of the RSSR.
    """
    length, rocker = 4.0, 2.5
    a3, O3 = unit([0.25, -0.45, 0.85]), np.array([4.0, 1.0, 0.5])
    A, u = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    e = unit(np.cross(a3, [1.0, 0, 0]))
    joints = [
        _joint("q1", "R", np.array([0, 0, 1.0]), np.zeros(3), -1, 0),
        _joint("u1", "R", np.array([0, 0, 1.0]), A, 0, None),
        _joint("u2", "R", np.array([1.0, 0, 0]), A, 1, 1),
        _joint("q3", "R", a3, O3, -1, 2),
    ]
    mass = 0.8
    rod = mass * length * length / 12
    on_rocker = O3 + 0.45 * rocker * e + 0.1 * a3
    bodies = [
        _body(1.5, [0.4, 0.1, 0.05], _inertia(1.5, (1.0, 0.2, 0.2), (0.1, 0.2, 0.3))),
        _body(mass, A + u * length / 2, np.diag([rod, 0.0, rod])),
        _body(1.1, on_rocker, _inertia(1.1, (2.5, 0.3, 0.2), (0.4, -0.1, 0.2))),
    ]
    left, right = A + length * u, O3 + rocker * e
    return {
        "name": "rssr",
        "joints": joints,
        "bodies": bodies,
        "closure": {"type": "point", "jL": 2, "jR": 3, "pL": left, "pR": right},
        "input": np.arange(0, 361) * D2R,
        "q_seed": None,
    }


def sevenr():
    """General 7R: seven arbitrary lines always form a closed loop at q = 0.

    The short first link lets the input make a full turn. Link 4 is split into two equal halves that
    are welded together. Dimensions have few digits, so that a file can say the same mechanism
    (benchmarks/sevenr.py).
    """
    rng = np.random.default_rng(123)
    angles = np.linspace(0, 2 * np.pi, 7)[:6]
    P = np.stack([1.3 * np.cos(angles), 1.3 * np.sin(angles), 0.4 * rng.standard_normal(6)], 1)
    second = P[0] + 0.22 * unit(rng.standard_normal(3))
    points = [P[0], second] + [P[k] + 0.15 * rng.standard_normal(3) for k in range(1, 6)]
    axes = [unit(rng.standard_normal(3)) for _ in range(7)]
    axes[1] = unit(axes[0] + 0.35 * rng.standard_normal(3))
    axes, points = [unit(a.round(3)) for a in axes], [p.round(3) for p in points]
    joints = [_joint(f"q{k + 1}", "R", axes[k], points[k], k - 1, k) for k in range(4)]
    # the right chain is walked from ground: reversed axes keep q_k the same relative angle
    for k, parent, body in ((6, -1, 5), (5, 4, 4), (4, 5, 6)):
        joints.append(_joint(f"q{k + 1}", "R", -axes[k], points[k], parent, body))
    bodies = []
    for k, mass in enumerate((0.9, 1.1, 0.8, 1.3, 0.7, 1.0)):
        centre = 0.5 * (points[k] + points[k + 1]) + 0.05 * rng.standard_normal(3)
        size, tilt = 0.4 + 0.5 * rng.random(3), rng.standard_normal(3)
        bodies.append(_body(mass, centre.round(3), _inertia(mass, size, tilt).round(4)))
    bodies[3] = _body(0.5 * bodies[3]["m"], bodies[3]["c"], 0.5 * bodies[3]["I"])
    bodies.append(dict(bodies[3]))
    weld = bodies[3]["c"]
    return {
        "name": "sevenr",
        "joints": joints,
        "bodies": bodies,
        "closure": {"type": "weld", "jL": 3, "jR": 6, "pL": weld, "pR": weld},
        "input": np.arange(0, 361) * D2R,
        "q_seed": (0.0, np.zeros(6)),
    }


MECHS = {"rcsr": rcsr, "rssr": rssr, "sevenr": sevenr}
