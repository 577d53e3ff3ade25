"""A general 7R loop with sixteen real assemblies, as many as are possible (Lee, Liang 1988).

Dimensions are from a random search; each assembly is checked by a product of Denavit-Hartenberg
matrices at 40 digits.
"""

from __future__ import annotations

import numpy as np
from modes.random_loops import Loop
from mpmath import MPContext

import mechkin_cli as mk

mp = MPContext()
mp.dps = 40

TWIST = ("1.7453292519943295", "1.7453292519943295", "1.7", "1.72", "1.51", "1.77")
LENGTH = ("1.41", "0.3", "0.84", "0.53", "0.96", "0.58")
OFFSET = ("0.19", "0", "0.28", "-0.52", "0.02", "0.86")
HOME = ("2.47", "-0.02", "-2.86", "2.09", "-3.0", "-0.98")


def frames(angles):
    """Frames after none, one, ... six turns, 4 x 4 at 40 digits."""
    found = [mp.eye(4)]
    for twist, a, d, q in zip(TWIST, LENGTH, OFFSET, angles, strict=True):
        c, s = mp.cos(q), mp.sin(q)
        ca, sa = mp.cos(mp.mpf(twist)), mp.sin(mp.mpf(twist))
        a, d = mp.mpf(a), mp.mpf(d)
        rows = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d]]
        found.append(found[-1] * mp.matrix([*rows, [0, 0, 0, 1]]))
    return found


def drawing() -> str:
    home = frames([mp.mpf(q) for q in HOME])[:6]
    points = [[1.0, 1.0, 1.0], *([float(f[i, 3]) for i in range(3)] for f in home)]
    axes = [[0.0, 0.6, 0.8], *([float(f[i, 2]) for i in range(3)] for f in home)]
    squares = [np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]) for axis in axes]
    return Loop(["R"] * 7, np.array(points), np.array(axes), np.array(squares)).text()


def test_all_sixteen_assemblies_are_found_and_said_to_be_all() -> None:
    found = mk.loads(drawing()).modes()
    assert len(found.modes) == found.bound == 16
    assert found.complete
    assert found.sentence == "16 modes: all, no loop of these pairs has more"
    target = frames([mp.mpf(q) for q in HOME])[6]
    angles = []
    for mode in found.modes:
        turns = [mp.radians(mode.coordinates[f"J{k}.theta"]) for k in range(1, 7)]
        closure = frames([mp.mpf(q) + t for q, t in zip(HOME, turns, strict=True)])[6] - target
        assert max(abs(x) for x in closure) < 1e-13
        assert mode.residual < 1e-13
        angles.append([float(t) for t in turns])
    apart = np.abs(np.exp(1j * np.array(angles))[:, None] - np.exp(1j * np.array(angles))[None])
    assert (apart.max(axis=2) + 9 * np.eye(16)).min() > 0.01
