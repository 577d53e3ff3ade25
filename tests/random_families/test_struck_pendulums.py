"""Double pendulums with limits at both joints, against an integrator of scipy with events and
impulses of M (u+ - u-) = J P, P >= 0: moments, impulses and rows, held and in blocks."""

from __future__ import annotations

import os
from itertools import combinations
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import mechkin_cli as mk
from mechkin_cli import tolerances

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
MOST = 8
"""Impacts that are compared: from one to the next what is off grows."""
END, ROWS = 2.5, 251


class Machine(NamedTuple):
    """Lengths, masses, inertias about the centres, dampings, gravity; limits (least, largest) and
    restitutions of both joints; where it begins, and how fast."""

    arm: float
    centres: np.ndarray
    masses: np.ndarray
    inertias: np.ndarray
    damping: np.ndarray
    gravity: np.ndarray
    limits: np.ndarray
    bounce: np.ndarray
    start: np.ndarray
    rates: np.ndarray

    @classmethod
    def of(cls, seed: int) -> Machine:
        """By chance."""
        draw = np.random.default_rng([seed, 48])
        low = draw.uniform(-1.0, 0.0, 2)
        high = low + draw.uniform(0.5, 1.5, 2)
        return cls(
            draw.uniform(0.4, 1.2),
            draw.uniform(0.2, 1.0, 2),
            draw.uniform(0.5, 3.0, 2),
            draw.uniform(0.02, 0.3, 2),
            draw.uniform(0.0, 0.5, 2),
            np.array([draw.uniform(-8.0, 8.0), -9.0]),
            np.array([low, high]).T,
            draw.uniform(0.3, 0.9, 2),
            low + (high - low) * draw.uniform(0.1, 0.9, 2),
            draw.uniform(-2.0, 2.0, 2),
        )

    def text(self) -> str:
        """Its file."""
        first, second = self.centres
        x, y = self.gravity
        links = [
            f"  {name}: {{mass: {m!r}, center_of_mass: [0, {-c!r}], inertia: {i!r}}}"
            for name, m, c, i in zip(
                "ab",
                self.masses.tolist(),
                [float(first), float(self.arm + second)],
                self.inertias.tolist(),
                strict=True,
            )
        ]
        limits = [
            f"  {joint}.theta: {{min: {low!r}, max: {high!r}, restitution: {e!r}}}"
            for joint, (low, high), e in zip(
                "AB", self.limits.tolist(), self.bounce.tolist(), strict=True
            )
        ]
        dampers = [
            f"  - {{type: damper, joint: {joint}, coordinate: theta, damping: {c!r}}}"
            for joint, c in zip("AB", self.damping.tolist(), strict=True)
        ]
        start = ", ".join(
            f"{joint}.theta: {u!r}, {joint}.theta_dot: {v!r}"
            for joint, u, v in zip("AB", self.start.tolist(), self.rates.tolist(), strict=True)
        )
        time = f"{{from: 0, to: {END}, count: {ROWS}}}"
        lines = [
            "format: 1",
            "plane: xy",
            "units: {length: m, angle: rad, mass: kg, force: N}",
            "links:",
            *links,
            "joints:",
            "  A: {type: R, links: [ground, a], point: [0, 0]}",
            f"  B: {{type: R, links: [a, b], point: [0, {-self.arm!r}]}}",
            "limits:",
            *limits,
            "loads:",
            f"  - {{type: gravity, g: [{float(x)!r}, {float(y)!r}]}}",
            *dampers,
            f"responses: {{r: {{start: {{{start}}}, time: {time}}}}}",
            "tables:",
            "  - {name: t, run: r, columns: [time, A.theta, B.theta, A.theta_dot, B.theta_dot]}",
        ]
        return "\n".join(lines)

    def mass(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The mass matrix at a place, and how both centres move with the coordinates."""
        p, q = u[0], u[0] + u[1]
        one, two = (np.array([np.cos(a), np.sin(a)]) for a in (p, q))
        near = np.stack([self.centres[0] * one, np.zeros(2)], axis=1)
        far = np.stack([self.arm * one + self.centres[1] * two, self.centres[1] * two], axis=1)
        m, i = self.masses, self.inertias
        turned = np.array([[i[0] + i[1], i[1]], [i[1], i[1]]])
        return m[0] * near.T @ near + m[1] * far.T @ far + turned, near, far

    def accelerations(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Of the free motion."""
        mass, near, far = self.mass(u)
        p, q, w, turn = u[0], u[0] + u[1], v[0], v[0] + v[1]
        inward = [np.array([-np.sin(a), np.cos(a)]) for a in (p, q)]
        first = self.centres[0] * w * w * inward[0]
        second = self.arm * w * w * inward[0] + self.centres[1] * turn * turn * inward[1]
        forces = near.T @ (self.masses[0] * (self.gravity - first))
        forces += far.T @ (self.masses[1] * (self.gravity - second))
        return np.linalg.solve(mass, forces - self.damping * v)

    def struck(self, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rates behind an impact, and impulses along both coordinates."""
        sides = np.where(u > self.limits.mean(axis=1), 1.0, -1.0)
        off = np.min(np.abs(u[:, None] - self.limits), axis=1)
        touched = [int(k) for k in np.flatnonzero(off < 1e-9)]
        mass, least = self.mass(u)[0], -self.bounce * np.maximum(sides * v, 0.0)
        for count in range(len(touched) + 1):
            for some in combinations(touched, count):
                rows = np.array([sides[k] * np.eye(2)[k] for k in some]).reshape(count, 2)
                system = np.block([[mass, rows.T], [rows, np.zeros((count, count))]])
                found = np.linalg.solve(system, [*(mass @ v), *least[list(some)]])
                after, pushes = found[:2], found[2:]
                rest = [k for k in touched if k not in some]
                if (pushes >= 0.0).all() and all(
                    sides[k] * after[k] <= least[k] + 1e-12 for k in rest
                ):
                    given = np.zeros(2)
                    given[list(some)] = -sides[list(some)] * pushes
                    return after, given
        raise AssertionError("no impulses")

    def motion(self) -> tuple[np.ndarray, list[float], list[np.ndarray]]:
        """Rows up to the last impact that is compared, moments, and impulses along the
        coordinates."""

        def beyond(joint: int, side: int):
            def event(t: float, y: np.ndarray) -> float:
                # what has just been left is none
                return (2 * side - 1) * (y[joint] - self.limits[joint, side]) - (t < time + 1e-7)

            event.terminal, event.direction = True, 1.0
            return event

        events = [beyond(joint, side) for joint in (0, 1) for side in (0, 1)]
        times = np.linspace(0.0, END, ROWS)
        time, y, rows, moments, impulses = 0.0, np.concatenate([self.start, self.rates]), [], [], []
        while time < END:
            found = solve_ivp(
                lambda _, y: np.concatenate([y[2:], self.accelerations(y[:2], y[2:])]),
                (time, END),
                y,
                method="DOP853",
                rtol=1e-12,
                atol=1e-13,
                events=events,
                dense_output=True,
                max_step=0.01,
            )
            end = found.t[-1]
            inside = times[(times >= time) & (times < end)]
            if inside.size:
                rows.append(found.sol(inside).T)
            if found.status == 0 or len(moments) == MOST:
                break
            time, y = float(end), found.y[:, -1].copy()
            y[2:], given = self.struck(y[:2], y[2:])
            moments.append(time)
            impulses.append(given)
        return np.concatenate(rows), moments, impulses


@pytest.mark.parametrize("seed", range(12 * TIMES))
def test_impacts_are_those_of_an_integrator_with_events(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = Machine.of(seed)
    rows, moments, impulses = machine.motion()
    model = mk.loads(machine.text(), f"struck {seed}")
    response = model.respond("r")
    table = response.tables[0]
    found = np.stack([np.asarray(column.values) for column in table.columns[1:]], axis=1)
    clear = np.abs(table.columns[0].values[: len(rows), None] - [*moments, -1.0]).min(axis=1) > 1e-6
    assert found[: len(rows)][clear] == pytest.approx(rows[clear], abs=1e-6)
    if moments:
        columns = {column.label: column for column in response.impacts.columns}
        own = np.asarray(columns["time"].values)[: len(moments)]
        assert own == pytest.approx(moments, abs=1e-8)
        for number, joint in enumerate("AB"):
            name = f"{joint}.theta.impulse"
            given = np.zeros(len(moments))
            if name in columns:
                given = np.nan_to_num(np.asarray(columns[name].values)[: len(moments)])
            expected = np.array([each[number] for each in impulses])
            assert given == pytest.approx(expected, rel=1e-6, abs=1e-8)
    for size in (7, 100):
        monkeypatch.setattr(tolerances, "PART_ROWS", size)
        monkeypatch.setattr(tolerances, "LEAST_PART_ROWS", 1)
        blocks = [block.tables[0] for block in model.stream(run="r", rows=size)]
        for number, column in enumerate(table.columns):
            values = np.concatenate([block.columns[number].values for block in blocks])
            assert values.tobytes() == np.asarray(column.values).tobytes()
