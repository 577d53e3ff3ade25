"""From a mechanism of `mechs` to the flat data of the yardstick's kernel.

Joint k: R_k = R_parent C_k Rz(q_k), t_k = t_parent + R_parent c_k (+ z q_k for P), where the frame
of body k has z along the joint's axis and stands as Q_k in the reference configuration.
"""

import mechs
import numpy as np


def prep(m):
    joints = m["joints"]
    n = len(joints)
    Q = []
    for k in range(n):
        Q.append(_frame(joints, k, Q))
    C, c = [], []
    for k, j in enumerate(joints):
        p = j["parent"]
        here = np.asarray(j["p"], float)
        C.append(Q[k] if p < 0 else Q[p].T @ Q[k])
        c.append(here if p < 0 else Q[p].T @ (here - joints[p]["p"]))
    body = {}
    for k, j in enumerate(joints):
        if j["body"] is not None:
            b = m["bodies"][j["body"]]
            body[k] = (b["m"], Q[k].T @ (b["c"] - j["p"]), Q[k].T @ b["I"] @ Q[k])
    closure = m["closure"]
    left, right = closure["jL"], closure["jR"]
    return {
        "n": n,
        "type": [j["type"] for j in joints],
        "parent": [j["parent"] for j in joints],
        "C": C,
        "c": c,
        "body": body,
        "jL": left,
        "jR": right,
        "xL": Q[left].T @ (closure["pL"] - joints[left]["p"]),
        "xR": Q[right].T @ (closure["pR"] - joints[right]["p"]),
        "EL": Q[left].T,
        "ER": Q[right].T,
        "point": closure["type"] == "point",
    }


def _frame(joints, k, Q):
    """Axes of body k: z along the joint's axis, x square to it and to the parent's axis."""
    a, p = np.asarray(joints[k]["a"], float), joints[k]["parent"]
    if p < 0:
        x = mechs.unit(np.cross(np.eye(3)[np.argmin(abs(a))], a))
    else:
        x = np.cross(joints[p]["a"], a)
        x = Q[p][:, 0] if np.linalg.norm(x) < 1e-12 else mechs.unit(x)
    return np.column_stack([x, np.cross(a, x), a])


def chain(P, j):
    """Joints from ground to j."""
    found = []
    while j >= 0:
        found.append(j)
        j = P["parent"][j]
    return found[::-1]
