"""What an engineer's scripts for a sweep share, whichever library places the links: the rows one
after the other by Newton's method, rates and accelerations, the table as CSV.

    python tests/benchmark/scripts/with_LIBRARY.py PROBLEM DIR [CSV]

PROBLEM is a mechanism in plain numbers (`benchmark/script_problem.py` writes it, so that no script
has a file format to read): a tree of hinges and slides as drawn, pairs of points that a loop keeps
together, pairs that keep a length, what is driven, what the table has. DIR/script.csv is the table;
with CSV, one that `mechkin analyze` wrote, the largest difference is printed, in parts of a
column's largest value.
"""

import csv
import json
import sys

import numpy as np

NEWTON_STEPS = 10
CLOSED = 1e-13


def run(make):
    """The whole script; `make(problem)` gives the tree with `spots` and `drift`."""
    source, folder, *other = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        problem = json.load(file)
    write(folder, problem, rows_of(problem, make(problem)), other)


def write(folder, problem, rows, other):
    """The table, and how far it is from another."""
    labels = [output["label"] for output in problem["outputs"]]
    with open(f"{folder}/script.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(labels)
        writer.writerows(rows)
    if other:
        print(f"largest difference {difference(labels, np.array(rows), other[0]):.1e}")


def rows_of(problem, tree):
    """One list of numbers per row, in the order of the outputs.

    `tree.spots(q)` gives places (spots, 3) and Jacobians (spots, 3, joints) of the points that the
    problem names, `tree.drift(q, rates)` their accelerations at constant rates.
    """
    closure = Closure(problem)
    q = np.array(problem["start"], float)
    rows = []
    for moment in range(len(problem["rows"])):
        given, first, second = (
            np.array(problem[k][moment]) for k in ("rows", "rates", "accelerations")
        )
        closure.drive(q, given)
        for _ in range(NEWTON_STEPS):
            places, columns = tree.spots(q)
            gap, jacobian, _ = closure.equations(places, columns, given)
            if np.abs(gap).max() < CLOSED:
                break
            q[closure.unknown] -= closure.solve(jacobian, gap)
        else:
            sys.exit(f"row {moment + 1}: Newton's method does not converge")
        rates, accelerations = np.zeros(q.size), np.zeros(q.size)
        closure.drive(rates, first)
        moving = closure.rate_miss(jacobian, rates, first)
        rates[closure.unknown] = -closure.solve(jacobian, moving)
        closure.drive(accelerations, second)
        moving = closure.acceleration_miss(
            places, columns, jacobian, rates, accelerations, tree.drift(q, rates), second
        )
        accelerations[closure.unknown] = -closure.solve(jacobian, moving)
        velocity = columns @ rates
        spots = (places, velocity, columns @ accelerations + tree.drift(q, rates))
        rows.append(read(problem, (q, rates, accelerations), spots))
    return rows


def read(problem, coordinates, spots):
    """The outputs of a row: a coordinate or a component of a spot, of an order."""
    found = []
    for output in problem["outputs"]:
        order = output["order"]
        if "joint" in output:
            found.append(float(coordinates[order][output["joint"]]))
        else:
            found.append(float(spots[order][output["spot"]][output["axis"]]))
    return found


class Closure:
    """The closing equations: pairs of spots that coincide, pairs that keep a driven length."""

    def __init__(self, problem):
        self.pairs = problem["pairs"]
        self.lengths = problem["lengths"]
        self.driven = problem["driven"]
        count = len(problem["joints"])
        self.unknown = [k for k in range(count) if k not in self.driven]

    def drive(self, q, given):
        """The driven coordinates; lengths are driven by the rest."""
        q[self.driven] = given[: len(self.driven)]

    def equations(self, places, columns, given):
        """Gap, Jacobian by all joints, and the directions of the lengths."""
        gaps, rows = [], []
        for one, other in self.pairs:
            gaps.extend(places[one] - places[other])
            rows.extend(columns[one] - columns[other])
        along = []
        for (one, other), length in zip(self.lengths, given[len(self.driven) :], strict=True):
            span = places[other] - places[one]
            size = np.linalg.norm(span)
            along.append(span / size)
            gaps.append(size - length)
            rows.append(along[-1] @ (columns[other] - columns[one]))
        return np.array(gaps), np.array(rows), along

    def solve(self, jacobian, right):
        """The unknowns' part; three points of a link are more equations than it needs."""
        matrix = jacobian[:, self.unknown]
        if matrix.shape[0] == matrix.shape[1]:
            return np.linalg.solve(matrix, right)
        return np.linalg.lstsq(matrix, right, rcond=None)[0]

    def rate_miss(self, jacobian, rates, first):
        """By which the equations' rates are off while the unknowns rest."""
        miss = jacobian @ rates
        if self.lengths:
            miss[3 * len(self.pairs) :] -= first[len(self.driven) :]
        return miss

    def acceleration_miss(self, places, columns, jacobian, rates, driven, drift, second):
        """The same for accelerations, with the drift of the spots at constant rates."""
        miss = jacobian @ driven
        for k, (one, other) in enumerate(self.pairs):
            miss[3 * k : 3 * k + 3] += drift[one] - drift[other]
        for k, (one, other) in enumerate(self.lengths):
            at = 3 * len(self.pairs) + k
            span = places[other] - places[one]
            size = np.linalg.norm(span)
            along = span / size
            velocity = (columns[other] - columns[one]) @ rates
            across = velocity @ velocity - (along @ velocity) ** 2
            miss[at] += along @ (drift[other] - drift[one]) + across / size
            miss[at] -= second[len(self.driven) + k]
        return miss


def difference(labels, rows, path):
    """The largest difference from a table with the same labels, in parts of a column's largest."""
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        other = np.array([[float(row[label]) for label in labels] for row in reader])
    if other.shape != rows.shape:
        sys.exit(f"{path} has {other.shape[0]} rows, the script {rows.shape[0]}")
    turns = 2 * np.pi * np.round((rows - other) / (2 * np.pi))
    angle = np.array([label.endswith(".theta") for label in labels])
    miss = np.abs(rows - other - np.where(angle, turns, 0.0))
    return float(np.max(miss.max(axis=0) / np.abs(other).max(axis=0)))
