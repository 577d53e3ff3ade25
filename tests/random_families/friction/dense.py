"""Free-body equations of a loop's row as one dense system, and its friction by hand.

Places, rates and accelerations are read off an analysis; forces are nowhere. A joint carries
wrenches along what it holds, drives push along coordinates, and friction forces obey z = mu N(z).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from random_families.friction.loops import Loop

Array = np.ndarray[Any, Any]
Read = Callable[[str], Array]
"""A quantity of the row by its name."""
GRAVITY = np.array([0.0, 0.0, -9.81])
NONE = np.zeros(3)
SURELY_ONE, MANY_STARTS = 0.9, 20
"""Spectral radius from which on other answers are looked for, from how many starts."""


def unit(a: Array) -> Array:
    return np.asarray(a / np.linalg.norm(a))


def basis(z: Array) -> tuple[Array, Array, Array]:
    """Two directions square to z, and z."""
    z = unit(z)
    x = unit(np.cross(z, np.eye(3)[np.argmin(np.abs(z))]))
    return x, np.cross(z, x), z


@dataclass(frozen=True)
class Rubbed:
    """What friction makes of a row: spectral radius of the Lipschitz matrix, friction forces by
    joint, with directions (force, couple) of a unit and speeds, and all unknowns; `solved`: whether
    the forces were found, `others`: whether other starts found other ones."""

    radius: float
    force: dict[str, float]
    drag: dict[str, tuple[Array, Array, float]]
    mu: dict[str, float]
    unknowns: Array
    solved: bool
    others: bool


class Row:
    """The free-body equations of one row; `size` of the mechanism (m) weighs shared efforts."""

    def __init__(self, loop: Loop, read: Read, size: float) -> None:
        self.loop, self.read, self.size = loop, read, size
        self.number = {name: 6 * k for k, name in enumerate(loop.links[1:-1])}
        self.tags: list[tuple[str, Array, Array]] = []
        columns = []
        for name in loop.types:
            for force, moment in self._held(name):
                self.tags.append((name, force, moment))
                columns.append(self.column(name, force, moment))
        self.constraints = len(columns)
        for drive in loop.drives:
            columns.append(self.column(drive.partition(".")[0], *self.along(drive)))
        self.matrix = np.array(columns).T

    @cached_property
    def right(self) -> Array:
        """What each link needs, about the origin."""
        found, read = np.zeros(6 * len(self.number)), self.read
        for link, at in self.number.items():
            data = self.loop.data["links"][link]
            axes = np.array([read(f"{link}{axis}") for axis in "xyz"]).T
            t = data["inertia"]
            tensor = [[t["xx"], t["xy"], t["xz"]], [t["xy"], t["yy"], t["yz"]]]
            inertia = axes @ np.array([*tensor, [t["xz"], t["yz"], t["zz"]]]) @ axes.T
            place, spin = read(f"g{link}.position"), read(f"{link}.omega")
            force = data["mass"] * (read(f"g{link}.acceleration") - GRAVITY)
            moment = inertia @ read(f"{link}.alpha") + np.cross(spin, inertia @ spin)
            found[at : at + 6] += [*force, *(moment + np.cross(place, force))]
        given, at = np.array(self.loop.force), self.number[self.loop.forced]
        found[at : at + 6] -= [*given, *np.cross(read("forced.position"), given)]
        return found

    def axis(self, name: str) -> Array:
        return unit(self.read(f"z{name}"))

    def column(self, name: str, force: Array, moment: Array) -> Array:
        """A wrench about the joint's point on its second link, and against it on the first."""
        found = np.zeros(6 * len(self.number))
        wrench = [*force, *(moment + np.cross(self.read(f"p{name}.position"), force))]
        first, second = self.loop.data["joints"][name]["links"]
        for link, sign in ((second, 1.0), (first, -1.0)):
            if link in self.number:
                found[self.number[link] : self.number[link] + 6] += sign * np.array(wrench)
        return found

    def _held(self, name: str) -> list[tuple[Array, Array]]:
        """Forces and moments that a joint transmits."""
        kind = self.loop.types[name]
        every = [(axis, NONE) for axis in np.eye(3)]
        if kind == "S":
            return every
        x, y, z = basis(self.axis(name))
        if kind == "U":
            return [*every, (NONE, unit(np.cross(z, self.read(f"y{name}"))))]
        square, tilting = [(x, NONE), (y, NONE)], [(NONE, x), (NONE, y)]
        pitch = self.loop.data["joints"][name].get("lead", 0.0) / (2.0 * np.pi)
        return {
            "Sp": [(z, NONE)],
            "Sg": square,
            "R": [*square, (z, NONE), *tilting],
            "P": [*square, *tilting, (NONE, z)],
            "C": [*square, *tilting],
            "H": [*square, *tilting, (z, -pitch * z)],
        }[kind]

    def along(self, coordinate: str) -> tuple[Array, Array]:
        """Force and moment of a unit effort."""
        name, _, word = coordinate.partition(".")
        z = unit(self.read(f"{'y' if word == 'theta2' else 'z'}{name}"))
        if word in ("theta1", "theta2"):
            other = unit(self.read(f"{'z' if word == 'theta2' else 'y'}{name}"))
            z = (z - (z @ other) * other) / (1.0 - (z @ other) ** 2)
        if word == "s":
            return z * (-1.0 if self.loop.types[name] == "Sg" else 1.0), NONE
        return NONE, z

    def solve(self, right: Array) -> Array:
        """All unknowns; drives of least norm where there are more than freedoms."""
        if self.matrix.shape[0] == self.matrix.shape[1]:
            return np.linalg.solve(self.matrix, right)
        drives = [1.0 if name.endswith(".s") else self.size for name in self.loop.drives]
        scale = np.array([*np.ones(self.constraints), *drives])
        matrix, held = self.matrix * scale, self.constraints
        some = np.linalg.lstsq(matrix, right, rcond=None)[0]
        null = np.linalg.svd(matrix)[2][matrix.shape[0] :].T
        least = np.linalg.lstsq(null[held:], -some[held:], rcond=None)[0]
        return np.asarray((some + null @ least) * scale)

    def wrenches(self, unknowns: Array) -> dict[str, tuple[Array, Array]]:
        """Force and moment of every joint about its point."""
        found = {name: (np.zeros(3), np.zeros(3)) for name in self.loop.types}
        for (name, force, moment), value in zip(self.tags, unknowns, strict=False):
            f, m = found[name]
            found[name] = (f + value * force, m + value * moment)
        return found

    def slip(self, name: str) -> tuple[Array, Array, float]:
        """Slide, turn and radius of a joint's surfaces."""
        kind, read = self.loop.types[name], self.read
        first, second = self.loop.data["joints"][name]["links"]
        point = read(f"p{name}.position")

        def spin(link: str) -> Array:
            return NONE if link == "ground" else read(f"{link}.omega")

        def speed(link: str, word: str) -> Array:
            here = point - read(f"{word}{name}.position")
            return np.asarray(read(f"{word}{name}.velocity") + np.cross(spin(link), here))

        turn, slide = spin(second) - spin(first), speed(second, "r") - speed(first, "q")
        radius = self.loop.frictions[name].get("radius", 0.0)
        if kind == "S":
            return NONE, turn, radius
        z = self.axis(name)
        along, about = z * (z @ slide), z * (z @ turn)
        if kind == "Sp":
            return slide - along, NONE, 0.0
        rubs = {"R": (NONE, about), "P": (along, NONE), "Sg": (along, NONE)}
        return (*rubs.get(kind, (along, about)), radius)

    def contacts(self, name: str) -> Iterator[tuple[float, Callable[[Array, Array], Array]]]:
        """Weights and linear parts of a joint's normal load."""
        kind, load = self.loop.types[name], self.loop.frictions[name]
        if kind == "S":
            yield 1.0, lambda force, moment: force
            return
        z = self.axis(name)
        if kind == "Sp":
            yield 1.0, lambda force, moment: np.array([z @ force])
        elif kind == "H":
            radius, lead = load["radius"], self.loop.data["joints"][name]["lead"]
            angle = np.arctan(lead / (2.0 * np.pi * radius))
            c, s = np.cos(angle), np.sin(angle) / radius
            weight = 1.0 / np.cos(np.radians(load.get("flank", 0.0)))
            yield weight, lambda force, moment: np.array([c * (z @ force) - s * (z @ moment)])
        elif "across" in load:
            yield from self._shoes(name, load, z)
        else:
            yield from _bearings(load, z)

    def _shoes(
        self, name: str, load: dict[str, Any], z: Array
    ) -> Iterator[tuple[float, Callable[[Array, Array], Array]]]:
        e = self.read(f"w{name}")
        e = unit(e - z * (z @ e))
        up = np.cross(z, e)
        for end in (1.0, -1.0):

            def share(force: Array, moment: Array, end: float = end) -> Array:
                radial = force - z * (z @ force)
                tilt = end * np.cross(moment, z) / (2.0 * load["length"])
                return np.asarray(radial / 4.0 + tilt)

            for side in (1.0, -1.0):
                yield 1.0, lambda f, m, share=share: np.array([e @ share(f, m)])
                yield (
                    1.0,
                    lambda f, m, share=share, side=side: np.array(
                        [up @ share(f, m) + side * (z @ m) / (2.0 * load["width"])]
                    ),
                )

    def friction(self) -> Rubbed:
        """Friction forces by Newton's method."""
        names = list(self.loop.frictions)
        drag = {name: self._drag(name) for name in names}
        mu = {name: self._coefficient(name, drag[name][2]) for name in names}
        plain = self.solve(self.right)
        by_unit = [self.solve(-self.column(name, *drag[name][:2])) for name in names]
        parts = {name: list(self.contacts(name)) for name in names}
        base, gains = self.wrenches(plain), [self.wrenches(each) for each in by_unit]
        system = [
            (mu[k] * w, at, part(*base[k]), np.array([part(*gain[k]) for gain in gains]))
            for at, k in enumerate(names)
            for w, part in parts[k]
        ]
        lipschitz = np.zeros((len(names), len(names)))
        for weight, at, _, gain in system:
            lipschitz[at] += weight * np.linalg.norm(gain, axis=1)
        radius = float(max(np.abs(np.linalg.eigvals(lipschitz)), default=0.0))
        near = MANY_STARTS if SURELY_ONE < radius < 1.0 else 1
        found = _roots(system, len(names), near) if radius < 1.0 else []
        z = found[0] if found else np.zeros(len(names))
        others = any(
            (np.abs(z - each) > 1e-6 * np.abs(z).max()).any() for each in found if each.size
        )
        unknowns = plain + sum(value * own for value, own in zip(z, by_unit, strict=True))
        forces = dict(zip(names, z.tolist(), strict=True))
        return Rubbed(radius, forces, drag, mu, unknowns, bool(found), others)

    def _drag(self, name: str) -> tuple[Array, Array, float]:
        slide, turn, radius = self.slip(name)
        speed = float(np.sqrt(slide @ slide + radius**2 * (turn @ turn)))
        return -slide / speed, -(radius**2) * turn / speed, speed

    def _coefficient(self, name: str, speed: float) -> float:
        given = self.loop.frictions[name]["coefficient"]
        if not isinstance(given, dict):
            return float(given)
        falls = np.exp(-((speed / given["speed"]) ** 2)) if "speed" in given else 0.0
        return float(given["sliding"] + (given["static"] - given["sliding"]) * falls)


def _bearings(
    load: dict[str, Any], z: Array
) -> Iterator[tuple[float, Callable[[Array, Array], Array]]]:
    """One bearing or two, each with the shoes of a width on both sides, and a collar."""
    ends = ((1.0, 0.0),)
    if "length" in load:
        ends = ((0.5, 1.0 / load["length"]), (0.5, -1.0 / load["length"]))
    for share, tilt in ends:
        yield (
            1.0,
            lambda f, m, share=share, tilt=tilt: share * (f - z * (z @ f)) + tilt * np.cross(m, z),
        )
    if "width" in load:
        yield 2.0 / load["width"], lambda force, moment: np.array([z @ moment])
    if "collar" in load:
        yield load["collar"] / load["radius"], lambda force, moment: np.array([z @ force])


def _roots(system: list[Any], count: int, starts: int) -> list[Array]:
    """Solutions of z = mu N(z), z >= 0, by damped Newton steps from zero and random starts."""

    def left(z: Array) -> tuple[Array, Array]:
        value, slope = -z, -np.eye(count)
        value = value.copy()
        for weight, at, base, gain in system:
            load = base + z @ gain
            size = np.linalg.norm(load)
            value[at] += weight * size
            slope[at] += weight * (gain @ load) / (size or 1.0)
        return value, slope

    rng, found = np.random.default_rng(1), []
    size = max((float(np.linalg.norm(base)) for _, _, base, _ in system), default=0.0)
    for start in range(starts):
        z = 10.0 ** rng.uniform(-2, 3) * size * rng.random(count) if start else np.zeros(count)
        for _ in range(100):
            value, slope = left(z)
            off = np.abs(value).max(initial=0.0)
            if off <= 1e-12 * (np.abs(z).max(initial=0.0) + size) or not np.isfinite(off):
                break
            try:
                step = np.linalg.solve(slope, -value)
            except np.linalg.LinAlgError:
                break
            halves = 0.5 ** np.arange(9)
            sizes = [np.abs(left(z + part * step)[0]).max() for part in halves]
            z = z + halves[int(np.argmin(sizes))] * step
        off, largest = np.abs(left(z)[0]).max(initial=0.0), np.abs(z).max(initial=0.0) + size
        if off <= 1e-11 * largest and z.min(initial=0.0) >= -1e-9 * size:
            found.append(z)
    return found
