"""Single loops of any pairs, whose rows Newton's method closes at 60 digits from the double answer.

Angles are in degrees, their rates in rad/s.
"""

from __future__ import annotations

import random
from typing import Any

import numpy as np
from oracle import random_loop, read, solve
from oracle.numerics import mp

import mechkin_cli as mk
from mechkin_cli.analysis.certificate import Certificate

TYPES = ("RCSR", "RRRRRRR", "RCCC", "RSCR", "HCSR", "RCRCR", "RPSC", "RRCRRR", "PCSR", "RHCS")
SUFFIXES = ("", "_dot", "_ddot")


def drawn(rng: random.Random) -> str:
    """The text of a loop with a driven first joint and a few rows about its drawing."""
    return random_loop(rng, rng.choice(TYPES), rows=rng.randint(2, 4))


def fault_of(text: str, certificate: Certificate) -> str:
    """A coordinate, rate or acceleration that lies outside its enclosure in a proven row."""
    mechanism = read(text)
    boxes = _boxes(certificate)
    for row in np.flatnonzero(certificate.status != "not proven"):
        guess = {}
        for joint, its in mechanism.joints.items():
            for name in (f"{joint}.{coordinate}" for coordinate in its.coordinates):
                guess[name] = mp.mpf(float(certificate.analysis[name][row])) * _unit(name)
        true = solve(mechanism, mechanism.row(int(row)), guess)
        for name, (low, high) in boxes.items():
            value = true[name] / _unit(name)
            if name.endswith(".theta"):
                value += 360 * mp.nint((float(low[row]) - value) / 360)
            if not low[row] <= value <= high[row]:
                return f"row {row + 1}: {name} lies outside"
    return ""


def _boxes(certificate: Certificate) -> dict[str, tuple[Any, Any]]:
    found = {}
    for name in certificate.analysis.result.coordinates:
        for suffix in SUFFIXES:
            try:
                found[name + suffix] = certificate.enclosure(name + suffix)
            except mk.UsageError:  # the angle of a joint that closes the loop
                continue
    return found


def _unit(name: str) -> Any:
    return mp.pi / 180 if name.endswith(".theta") else mp.one
