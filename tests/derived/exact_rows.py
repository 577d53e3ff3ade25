"""Rows of mechanism files at 40 digits, from the oracle, in the units of the file but rad."""

from __future__ import annotations

from functools import cache

from mechanisms.runs import run
from oracle import Mechanism, Solution, document, mp, read, solve, to_text
from references import FILE_OF

DEGREE = mp.pi / 180


@cache
def mechanism(name: str) -> Mechanism:
    units = {"length": "in", "angle": "deg", "mass": "lbm", "force": "lbm*in/s^2"}
    return read(to_text(document(FILE_OF[name]) | {"units": units}))


@cache
def solution(name: str, row: int) -> Solution:
    """A row, sought from the coordinates that the package has there."""
    guess = {}
    for joint, its in mechanism(name).joints.items():
        for coordinate in its.coordinates:
            value = float(run(name)[f"{joint}.{coordinate}"][row])
            guess[f"{joint}.{coordinate}"] = value * (DEGREE if coordinate == "theta" else 1)
    return solve(mechanism(name), mechanism(name).row(row), guess)
