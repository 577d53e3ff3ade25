"""What an engineer writes with Pinocchio for the same task: every table cell of a 7R sweep.

    python tests/benchmark/pinocchio_7r.py FILE DIR [CSV]

FILE is the general 7R of `benchmarks/sevenr.py`. Pinocchio places the
links, and gives the Jacobian, the accelerations and, by its recursive Newton-Euler algorithm, the
joint forces of the open chain; the loop is closed here by Newton's method row by row, the reaction
at the end by a 6x6 system. DIR/pinocchio.csv has the columns of the file's table; with CSV, a
table that `mechkin analyze FILE` wrote, the largest difference is printed, in parts of a column's
largest value. Needs `pin` and `pyyaml`, and says so where they are missing.
"""

import csv
import sys
from math import pi

try:
    import numpy as np
    import pinocchio as pin
    import yaml
except ImportError as error:
    sys.exit(f"left out: {error.name} is not installed (pip install pin pyyaml)")

NEWTON_STEPS = 10
CLOSED = 1e-13


def main():
    source, folder, *other = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        data = yaml.load(file, Loader=yaml.CSafeLoader)
    model = chain(data)
    rows = sweep(model, *law(data["motion"]["inputs"]["J1.theta"]))
    labels = [column["label"] for column in data["tables"][0]["columns"]]
    with open(f"{folder}/pinocchio.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(labels)
        writer.writerows(rows)
    if other:
        print(f"largest difference {difference(labels, np.array(rows), other[0]):.1e}")


def chain(data):
    """The seven joints one after the other; the frames' axes are those of the drawing."""
    model = pin.Model()
    model.gravity.linear = np.array(data["loads"][0]["g"], float)
    last = np.zeros(3)
    for k, joint in enumerate(data["joints"].values()):
        axis, point = np.array(joint["axis"], float), np.array(joint["point"], float)
        turn = pin.JointModelRevoluteUnaligned(axis / np.linalg.norm(axis))
        place = pin.SE3(np.eye(3), point - last)
        index = model.addJoint(k, turn, place, f"J{k + 1}")
        link = data["links"].get(joint["links"][1])
        if link:
            t = link["inertia"]
            tensor = [[t[min(i + j, j + i)] for j in "xyz"] for i in "xyz"]
            centre = np.array(link["center_of_mass"], float) - point
            inertia = pin.Inertia(float(link["mass"]), centre, np.array(tensor, float))
            model.appendBodyToJoint(index, inertia, pin.SE3.Identity())
        last = point
    return model


def law(motion):
    """Positions (rad), rate and acceleration of the input."""
    first, last, step = (float(motion[key].removesuffix("deg")) for key in ("from", "to", "step"))
    count = round((last - first) / step) + 1
    positions = [(first + i * step) * pi / 180 for i in range(count)]
    rate, acceleration = (float(motion[key].split()[0]) for key in ("rate", "acceleration"))
    return positions, rate, acceleration


def sweep(model, positions, rate, acceleration):
    """One list of numbers per row, in the order of the table's columns."""
    data, end = model.createData(), model.njoints - 1
    home = pin.SE3(np.eye(3), sum(place.translation for place in model.jointPlacements))
    back, first = home.inverse(), np.zeros(model.nv)
    q, slope, curvature, rows = np.zeros(model.nv), first, first, []
    for i, theta in enumerate(positions):
        h = theta - positions[i - 1] if i else 0.0
        q = q + h * slope + 0.5 * h * h * curvature
        q[0] = theta
        jacobian = close(model, data, q, back, end)
        unknown = jacobian[:, 1:]
        slope = np.concatenate([[1.0], np.linalg.solve(unknown, -jacobian[:, 0])])
        velocity = rate * slope
        start = np.zeros(model.nv)
        start[0] = acceleration
        pin.forwardKinematics(model, data, q, velocity, start)
        start[1:] = np.linalg.solve(unknown, -data.a[end].vector)
        curvature = (start - acceleration * slope) / rate**2
        effort, wrenches = loads(model, data, q, velocity, start, jacobian)
        rows.append([theta, *q[1:], *velocity[1:], *start[1:], effort, *wrenches])
    return rows


def close(model, data, q, back, end):
    """Newton's method on q[1:] in place; returns the end's Jacobian in its own frame."""
    for _ in range(NEWTON_STEPS):
        pin.computeJointJacobians(model, data, q)
        jacobian = pin.getJointJacobian(model, data, end, pin.LOCAL)
        gap = pin.log6(back * data.oMi[end]).vector
        if np.abs(gap).max() < CLOSED:
            return jacobian
        q[1:] -= np.linalg.solve(jacobian[:, 1:], gap)
    raise SystemExit(f"not closed at {q[0]}")


def loads(model, data, q, velocity, acceleration, jacobian):
    """The effort, then force and moment of every joint about its point in ground axes."""
    torques = pin.rnea(model, data, q, velocity, acceleration)
    reaction = np.linalg.solve(jacobian[:, 1:].T, torques[1:])
    outer = pin.StdVec_Force()
    for _ in range(model.njoints - 1):
        outer.append(pin.Force.Zero())
    outer.append(pin.Force(reaction))
    effort = pin.rnea(model, data, q, velocity, acceleration, outer)[0]
    found = []
    for k in range(1, model.njoints):
        turn, wrench = data.oMi[k].rotation, data.f[k]
        moment = wrench.angular - (effort * model.joints[k].extract().axis if k == 1 else 0.0)
        found += [*(turn @ wrench.linear), *(turn @ moment)]
    return effort, found


def difference(labels, rows, path):
    """Largest difference from a CSV file, in parts of each column's largest value."""
    with open(path, encoding="utf-8") as file:
        header, *lines = csv.reader(file)
    assert header == labels, "other columns"
    wanted = np.array(lines, float)
    scale = np.abs(wanted).max(axis=0)
    return float((np.abs(rows - wanted).max(axis=0) / scale).max())


if __name__ == "__main__":
    main()
