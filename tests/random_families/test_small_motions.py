"""Small motions of random mechanisms against a linearization at 40 digits that shares nothing with
the kernel: positions by products of exponentials, energies, their differences, eigenvalues by
mpmath; spatial chains of hinges and slides with springs, dampers and a bushing, and four-bars."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from bushings.energy import rotation_vector
from mpmath import MPContext

import mechkin_cli as mk

mp = MPContext()
mp.dps = 60
STEP = mp.mpf(10) ** -8
WEIGHTS = ((1, mp.mpf(4) / 5), (2, -mp.mpf(1) / 5), (3, mp.mpf(4) / 105), (4, -mp.mpf(1) / 280))
G = mp.mpf("9.81")

Numbers = Sequence[Any]
Energy = Callable[[Numbers], Any]


def slope(f: Callable[[Numbers], Any], q: Numbers, k: int) -> Any:
    """The derivative of numbers or matrices by a coordinate, eighth order."""

    def at(step: int) -> Any:
        moved = list(q)
        moved[k] = moved[k] + step * STEP
        return f(moved)

    return sum((w * (at(s) - at(-s)) for s, w in WEIGHTS), 0 * at(0)) / STEP


def hessian(f: Energy, q: Numbers) -> Any:
    n = len(q)
    found = mp.zeros(n)
    for i in range(n):
        for k in range(i, n):
            found[i, k] = found[k, i] = slope(lambda x, i=i: slope(f, x, i), q, k)
    return found


def skew(a: Numbers) -> Any:
    return mp.matrix([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def turn(axis: Numbers, angle: Any) -> Any:
    """Rodrigues' rotation about a unit axis."""
    k = skew(axis)
    return mp.eye(3) + mp.sin(angle) * k + (1 - mp.cos(angle)) * k * k


class Chain:
    """Links one behind the other on random hinges and slides, with all kinds of springs."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.count = int(rng.integers(2, 5))

        def numbers(size: int, reach: float = 1.0) -> list[str]:
            return [f"{x:.3f}" for x in rng.uniform(-reach, reach, size)]

        self.kinds = ["RP"[int(k)] for k in rng.integers(0, 2, self.count)]
        self.kinds[0] = "R"
        self.axes = [["1", "2", "-2"], ["2", "1", "2"], ["-2", "2", "1"], ["0", "3", "4"]]
        rng.shuffle(self.axes)
        self.points = [numbers(3) for _ in range(self.count)]
        self.centres = [numbers(3) for _ in range(self.count)]
        self.masses = [f"{x:.2f}" for x in rng.uniform(0.5, 3, self.count)]
        self.inertias = [[f"{x:.3f}" for x in rng.uniform(0.1, 0.15, 3)] for _ in self.kinds]
        self.places = numbers(self.count, 0.5)
        self.stiffness = [f"{x:.1f}" for x in rng.uniform(5, 60, self.count)]
        self.damping = [f"{x:.2f}" for x in rng.uniform(0.1, 2, self.count)]
        self.hook, self.eye = numbers(3), numbers(3, 3.0)
        self.mount = [f"{x:.1f}" for x in rng.uniform(5, 40, 6)]
        self.names = [
            f"J{k}.{'theta' if kind == 'R' else 's'}" for k, kind in enumerate(self.kinds)
        ]

    def text(self) -> str:
        last = self.count - 1
        lines = ["format: 1", "units: {angle: rad}", "links:"]
        for k in range(self.count):
            xx, yy, zz = self.inertias[k]
            lines.append(
                f"  L{k}: {{mass: {self.masses[k]}, center_of_mass: [{', '.join(self.centres[k])}],"
                f" inertia: {{xx: {xx}, yy: {yy}, zz: {zz}}}}}"
            )
        lines.append("joints:")
        for k, kind in enumerate(self.kinds):
            before = "ground" if k == 0 else f"L{k - 1}"
            lines.append(
                f"  J{k}: {{type: {kind}, links: [{before}, L{k}], point: "
                f"[{', '.join(self.points[k])}], axis: [{', '.join(self.axes[k])}]}}"
            )
        lines += [
            "points:",
            f"  hook: {{link: L{last}, at: [{', '.join(self.hook)}]}}",
            f"  eye: {{link: ground, at: [{', '.join(self.eye)}]}}",
            "loads:",
            "  - {type: gravity, g: [0, 0, -9.81]}",
            "  - {type: spring, between: [hook, eye], stiffness: 20, free: 0.5}",
        ]
        for k, name in enumerate(self.names):
            at = f"joint: J{k}, coordinate: {name.rpartition('.')[2]}"
            lines.append(f"  - {{type: spring, {at}, stiffness: {self.stiffness[k]}, free: 0.1}}")
            lines.append(f"  - {{type: damper, {at}, damping: {self.damping[k]}}}")
        words = ", ".join(
            f"{axis}: {x}"
            for axis, x in zip(("x", "y", "z", "rx", "ry", "rz"), self.mount, strict=True)
        )
        lines.append(
            f"  - {{type: bushing, links: [ground, L{last}], point: [{', '.join(self.hook)}], "
            f"stiffness: {{{words}}}}}"
        )
        places = ", ".join(
            f"{name}: {{at: {x}}}" for name, x in zip(self.names, self.places, strict=True)
        )
        lines.append(f"motion: {{inputs: {{{places}}}}}")
        return "\n".join(lines)

    def poses(self, q: Numbers) -> list[tuple[Any, Any]]:
        """Rotation and shift of every link from the drawing."""
        rotation, shift, found = mp.eye(3), mp.zeros(3, 1), []
        for k, kind in enumerate(self.kinds):
            axis = mp.matrix([mp.mpf(x) for x in self.axes[k]])
            axis = axis / mp.norm(axis)
            point = mp.matrix([mp.mpf(x) for x in self.points[k]])
            if kind == "R":
                by = turn(axis, q[k])
                shift = shift + rotation * (point - by * point)
                rotation = rotation * by
            else:
                shift = shift + rotation * (axis * q[k])
            found.append((rotation, shift))
        return found

    def potential(self, q: Numbers) -> Any:
        poses, total = self.poses(q), mp.mpf(0)
        for k, (rotation, shift) in enumerate(poses):
            centre = rotation * mp.matrix([mp.mpf(x) for x in self.centres[k]]) + shift
            total += mp.mpf(self.masses[k]) * G * centre[2]
            total += mp.mpf(self.stiffness[k]) * (q[k] - mp.mpf("0.1")) ** 2 / 2
        rotation, shift = poses[-1]
        hook, eye = (mp.matrix([mp.mpf(x) for x in p]) for p in (self.hook, self.eye))
        place = rotation * hook + shift
        total += 10 * (mp.norm(place - eye) - mp.mpf("0.5")) ** 2
        e = [*(place - hook), *rotation_vector(rotation)]
        return total + sum(mp.mpf(k) * x * x for k, x in zip(self.mount, e, strict=True)) / 2

    def inertia(self, q: Numbers) -> Any:
        n, found = self.count, mp.zeros(self.count)
        here = self.poses(q)
        for k in range(n):
            centre = mp.matrix([mp.mpf(x) for x in self.centres[k]])
            tensor = mp.diag([mp.mpf(x) for x in self.inertias[k]])
            rotation = here[k][0]
            moves, turns = [], []

            def place(x: Numbers, k: int = k, centre: Any = centre) -> Any:
                rotation, shift = self.poses(x)[k]
                return rotation * centre + shift

            for i in range(n):
                moves.append(slope(place, q, i))
                rate = rotation.T * slope(lambda x, k=k: self.poses(x)[k][0], q, i)
                turns.append(mp.matrix([rate[2, 1], rate[0, 2], rate[1, 0]]))
            for i in range(n):
                for j in range(n):
                    found[i, j] += mp.mpf(self.masses[k]) * (moves[i].T * moves[j])[0]
                    found[i, j] += (turns[i].T * tensor * turns[j])[0]
        return found


def exact_motions(inertia: Any, damping: Any, stiffness: Any) -> np.ndarray:
    """Eigenvalues with an imaginary part that is not negative, by their size."""
    n = inertia.rows
    system = mp.zeros(2 * n)
    back = mp.inverse(inertia)
    system[:n, n:] = mp.eye(n)
    system[n:, :n] = -back * stiffness
    system[n:, n:] = -back * damping
    values = mp.eig(system, left=False, right=False)
    kept = [complex(value) for value in values if value.imag > -(mp.mpf(10) ** -30)]
    return np.array(sorted(kept, key=abs))


@pytest.mark.parametrize("seed", range(10))
def test_chains(seed: int) -> None:
    chain = Chain(seed)
    model = mk.loads(chain.text())
    v = model.vibration()
    # in another order forces are taken along a chart, not along the inputs
    other = model.vibration(coordinates=v.coordinates[::-1])
    q = [mp.mpf(x) for x in chain.places]
    stiffness, inertia = hessian(chain.potential, q), chain.inertia(q)
    damping = mp.diag([mp.mpf(x) for x in chain.damping])
    for name, exact in (("stiffness", stiffness), ("mass", inertia), ("damping", damping)):
        numbers = np.array(exact.tolist(), dtype=float)
        for told in (getattr(v, name), getattr(other, name)[::-1, ::-1]):
            assert np.abs(told - numbers).max() < 1e-10 * np.abs(numbers).max()
    held = np.array([float(slope(chain.potential, q, k)) for k in range(chain.count)])
    assert v.holding == pytest.approx(held, rel=1e-11, abs=1e-11)
    exact = exact_motions(inertia, damping, stiffness)
    assert len(v.eigenvalues) == len(exact)
    assert np.abs(v.eigenvalues - exact).max() < 1e-9 * np.abs(exact).max()


class FourBar:
    """Ground from A to D, hinges A, B, C, D; springs at A and D and between the links."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(100 + seed)
        self.b = [f"{x:.3f}" for x in (rng.uniform(-0.3, 0.3), rng.uniform(0.6, 1.0))]
        self.c = [f"{x:.3f}" for x in (rng.uniform(1.2, 1.8), rng.uniform(0.9, 1.4))]
        self.d = [f"{x:.3f}" for x in (rng.uniform(1.3, 1.7), rng.uniform(-0.2, 0.2))]
        self.masses = [f"{x:.2f}" for x in rng.uniform(0.5, 2, 3)]
        self.inertias = [f"{x:.3f}" for x in rng.uniform(0.02, 0.2, 3)]
        self.angle = f"{rng.uniform(-0.3, 0.3):.3f}"

    def text(self) -> str:
        (bx, by), (cx, cy), (dx, dy) = self.b, self.c, self.d
        m, i = self.masses, self.inertias
        return f"""format: 1
plane: xy
units: {{angle: rad}}
links:
  a: {{mass: {m[0]}, center_of_mass: [{bx}, {by}], inertia: {i[0]}}}
  b: {{mass: {m[1]}, center_of_mass: [{cx}, {cy}], inertia: {i[1]}}}
  c: {{mass: {m[2]}, center_of_mass: [{dx}, {dy}], inertia: {i[2]}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [a, b], point: [{bx}, {by}]}}
  C: {{type: R, links: [b, c], point: [{cx}, {cy}]}}
  D: {{type: R, links: [ground, c], point: [{dx}, {dy}]}}
loads:
  - {{type: gravity, g: [0, -9.81]}}
  - {{type: spring, joint: A, coordinate: theta, stiffness: 40}}
  - {{type: spring, joint: D, coordinate: theta, stiffness: 25, free: 0.2}}
motion: {{inputs: {{A.theta: {{at: {self.angle}}}}}}}
"""

    def closed(self, theta: Any) -> tuple[Any, Any, Any, Any]:
        """Places of B and C as complex numbers, and the turns of rod and rocker."""
        b, c, d = (mp.mpc(mp.mpf(p[0]), mp.mpf(p[1])) for p in (self.b, self.c, self.d))
        at_b = b * mp.expj(theta)
        rod, rocker = abs(c - b), abs(c - d)
        # the same side of the line from B to D as drawn
        way = d - at_b
        along = (rod**2 - rocker**2 + abs(way) ** 2) / (2 * abs(way))
        height = mp.sqrt(rod**2 - along**2)
        side = mp.sign(((c - b) * mp.conj(d - b)).imag)
        at_c = at_b + (along + side * mp.mpc(0, 1) * height) * way / abs(way)
        return at_b, at_c, mp.arg((at_c - at_b) / (c - b)), mp.arg((at_c - d) / (c - d))

    def potential(self, q: Numbers) -> Any:
        at_b, at_c, _, rocker = self.closed(q[0])
        weights = mp.mpf(self.masses[0]) * at_b.imag + mp.mpf(self.masses[1]) * at_c.imag
        return G * weights + 20 * q[0] ** 2 + mp.mpf("12.5") * (rocker - mp.mpf("0.2")) ** 2

    def inertia(self, theta: Any) -> Any:
        def at(q: Numbers) -> Any:
            return mp.matrix(self.closed(q[0]))

        move_b, move_c, rod, rocker = slope(at, [theta], 0)
        m, i = ([mp.mpf(x) for x in xs] for xs in (self.masses, self.inertias))
        moved = m[0] * abs(move_b) ** 2 + m[1] * abs(move_c) ** 2
        return moved + i[0] + i[1] * rod.real**2 + i[2] * rocker.real**2


@pytest.mark.parametrize("seed", range(10))
def test_four_bars(seed: int) -> None:
    """Held by the crank's drive at any angle; then told by the rocker's angle instead."""
    bar = FourBar(seed)
    model = mk.loads(bar.text())
    v, q = model.vibration(), [mp.mpf(bar.angle)]
    stiffness, inertia = hessian(bar.potential, q)[0, 0], bar.inertia(q[0])
    assert v.stiffness[0, 0] == pytest.approx(float(stiffness), rel=1e-10)
    assert v.mass[0, 0] == pytest.approx(float(inertia), rel=1e-11)
    root = complex(mp.sqrt(mp.mpc(stiffness / inertia)))
    assert v.frequencies[0] == pytest.approx(abs(root) / (2 * np.pi), rel=1e-10)
    # by another coordinate: the crank's drive still holds it, so the motion is the same
    other = model.vibration(coordinates=["D.theta"])
    assert other.frequencies == pytest.approx(v.frequencies, rel=1e-10)
