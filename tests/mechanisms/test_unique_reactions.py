"""Overconstrained loops: which components of reactions the equilibrium determines.

Self-stresses are the solutions of the homogeneous equilibrium: wrenches of the joints that balance
on every moving link, do no work on the joints' freedoms, efforts of the drives included. A
component is unique where all self-stresses leave it zero; elsewhere the cell must be empty.
"""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.precise import DEGREE, course, mp, rows
from mechanisms.runs import model, run, worst

OVERCONSTRAINED = ("bennett", "parallelogram", "slider_crank")
ROW = 2
PARTS = ("force", "moment", "moment_about_origin")


def self_stresses(name: str) -> dict[str, np.ndarray]:
    """Force, moment and moment about the origin of every joint per self-stress: (3, stresses)."""
    analysis, joints = run(name), list(model(name).problem.mechanism.joints.values())
    links = [link for link in model(name).problem.mechanism.links if link != "ground"]
    driven = {joint for joint, _ in model(name).graph.driven}
    columns = 6 * len(joints) + len(driven)
    balance, reciprocal, effort = np.zeros((6 * len(links), columns)), [], 6 * len(joints)
    for k, joint in enumerate(joints):
        point, axis = analysis[f"{joint.name}.point"][ROW], analysis[f"{joint.name}.axis"][ROW]
        slides = joint.letter == "P"
        # columns of the wrench about the origin: force, moment about the joint's point
        wrench = np.block([[np.eye(3), np.zeros((3, 3))], [lever(point), np.eye(3)]])
        work = np.zeros(columns)
        work[6 * k + (0 if slides else 3) : 6 * k + (3 if slides else 6)] = axis
        reciprocal.append(work)
        for link, sign in ((joint.first, -1.0), (joint.second, 1.0)):
            if link != "ground":
                at = slice(6 * links.index(link), 6 * links.index(link) + 6)
                balance[at, 6 * k : 6 * k + 6] = sign * wrench
                if joint.name in driven:
                    assert not slides
                    balance[at, effort] = sign * np.concatenate([np.zeros(3), axis])
    matrix = np.vstack([balance, reciprocal])
    _, values, right = np.linalg.svd(matrix)
    free = right[int(np.sum(values > 1e-9 * values[0])) :].T
    found = {}
    for k, joint in enumerate(joints):
        force, moment = free[6 * k : 6 * k + 3], free[6 * k + 3 : 6 * k + 6]
        about_origin = moment + lever(analysis[f"{joint.name}.point"][ROW]) @ force
        parts = (force, moment, about_origin)
        found |= {f"{joint.name}.{p}": v for p, v in zip(PARTS, parts, strict=True)}
    return found


def lever(point: np.ndarray) -> np.ndarray:
    x, y, z = point
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


@pytest.mark.parametrize("name", OVERCONSTRAINED)
def test_cells_are_empty_exactly_where_a_reaction_is_not_unique(name):
    stresses = self_stresses(name)
    assert next(iter(stresses.values())).shape[1] == 3  # mobility counts -2, the linkage moves
    for quantity, components in stresses.items():
        undetermined = np.max(np.abs(components), axis=1) > 1e-9
        assert np.isnan(run(name)[quantity][ROW]).tolist() == undetermined.tolist(), quantity


def test_slider_crank_reactions_in_the_plane():
    """The rod has no mass, so its force is along it; the slide takes what is across."""
    crank, rod = mp.mpf("0.1"), mp.mpf("0.35")
    courses = [course(int(d) * DEGREE, 20, 5) for d in run("slider_crank")["A.theta"]]
    rise = np.array([float(crank * mp.sin(q(0))) for q in courses])
    reach = [lambda t, q=q: mp.sqrt(rod**2 - (crank * mp.sin(q(t))) ** 2) for q in courses]
    place = [
        lambda t, q=q, f=f: crank * mp.cos(q(t)) + f(t) for q, f in zip(courses, reach, strict=True)
    ]
    along = 1.5 * rows(place)[2] + 100.0
    across = -along * rise / rows(reach)[0]
    force = run("slider_crank")["C.force"]
    assert worst(force[:, 0], along) <= 1e-13
    assert worst(force[:, 1], across) <= 1e-13
    assert worst(run("slider_crank")["D.force"][:, 1], -across) <= 1e-13
