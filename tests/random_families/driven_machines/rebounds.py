"""Limits of coordinates: masses that fall on one and rebound, alone and with a flywheel behind a
rack or a function; wheels between the limits of both; ranges, and rows of sweeps beyond them.

Right is the motion under a constant force from impact to impact, which turns the rate and leaves a
share of it, until nothing is left. The last moment may be that of an impact.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from random_families.driven_machines.judged import Floats, Judged, begun

KINDS = ("fall", "fall by a rack", "fall by a sum", "fall by a function", "wheels", "ranges")
LIMIT = 1e-6
MOMENTS = 31
MASS = 2.0


class Flight(NamedTuple):
    """A motion along a line under a constant acceleration.

    Attributes:
        ends: the least and the largest place, which may be infinite.
        kept: share of the rate that an impact leaves.
    """

    place: float
    rate: float
    acceleration: float
    ends: tuple[float, float]
    kept: float

    def impact(self) -> tuple[float, float]:
        """When it comes to an end, and which; infinite where it never does."""
        found = [(np.inf, np.inf)]
        for end, out in zip(self.ends, (-1.0, 1.0), strict=True):
            rate, pull = out * self.rate, out * self.acceleration
            way = out * (end - self.place)
            square = rate**2 + 2.0 * pull * way
            if not np.isfinite(end) or square < 0.0:
                continue
            # outward at the end, by the form of the root that does not cancel
            root = np.sqrt(square)
            after = 2.0 * way / (rate + root) if rate > 0.0 and way > 0.0 else np.inf
            if not np.isfinite(after) and pull > 0.0:
                after = (root - rate) / pull
            if after > 0.0:
                found.append((after, end))
        return min(found)

    def after(self, time: float) -> tuple[float, float]:
        """Place and rate."""
        rate = self.rate + self.acceleration * time
        return self.place + (self.rate + rate) / 2.0 * time, rate

    def seen(self, times: Floats) -> Floats:
        """Rows of place, rate and time to the nearest impact."""
        flight, now, least = self, 0.0, 1e-11 * (abs(self.rate) + abs(self.acceleration))
        rows: list[tuple[float, float, float]] = []
        while len(rows) < len(times):
            step, end = flight.impact()
            while len(rows) < len(times) and (time := times[len(rows)]) <= now + step:
                rows.append((*flight.after(time - now), min(time - now, now + step - time)))
            if step == np.inf:
                continue
            rate = -flight.kept * flight.after(step)[1]
            flight, now = flight._replace(place=end, rate=rate), now + step
            if abs(rate) < least and (end == self.ends[1]) == (self.acceleration > 0.0):
                flight = Flight(end, 0.0, 0.0, self.ends, 0.0)  # it is pushed there, and rests
        return np.array(rows)


def _flown(judged: Judged, result: Any, names: tuple[str, str], flight: Flight) -> None:
    """Compares a response with a flight; the rate at an impact is neither that before nor after."""
    if not judged.is_ok(result) or not result.complete:
        judged.faults.append(f"ends early: {[str(one) for one in result.diagnostics][:2]}"[:300])
        return
    times = np.asarray(result["time"], float)
    places, rates, far = flight.seen(times).T
    quick = float(np.max(np.abs(rates)))
    size = max(float(np.max(np.abs(places))), quick * times[-1] / MOMENTS)
    judged.compare(names[0], result[names[0]], places, size, LIMIT)
    clear = far > 1e-6 * times[-1]
    judged.compare(names[1], result[names[1]][clear], rates[clear], quick, LIMIT)


def _fall(rng: np.random.Generator, judged: Judged, kind: str) -> None:
    size = float(10.0 ** rng.uniform(-2, 2))
    high, rate = size * float(rng.uniform(0.1, 3)), size * float(rng.uniform(-3, 3))
    kept = float(rng.choice([1.0, 0.9, 0.7, 0.5, 0.0]))
    radius, inertia = size * float(rng.uniform(0.1, 0.5)), size**2 * float(rng.uniform(0.01, 0.5))
    data: dict[str, Any] = begun(plane=True) | {
        "links": {"s": {"mass": MASS, "center_of_mass": [0, 0], "inertia": 0}},
        "joints": {"S": {"type": "P", "links": ["ground", "s"], "point": [0, 0], "axis": [0, 1]}},
        "loads": [{"type": "gravity", "g": [0, -10.0 * size]}],
    }
    limited, pull = "S.s", 10.0 * size
    if kind != "fall":
        turning = {"type": "R", "links": ["ground", "w"], "point": [-radius, 0]}
        data["links"]["w"] = {"mass": 1, "center_of_mass": [-radius, 0], "inertia": inertia}
        data["joints"]["A"] = turning
        data["couplings"] = {
            "K": {
                "fall by a rack": {"type": "rack", "joints": ["A", "S"], "radius": radius},
                "fall by a sum": {
                    "type": "linear",
                    "terms": {"A.theta": 1, "S.s": f"{-1 / radius!r} rad/m"},
                },
                "fall by a function": {
                    "type": "function",
                    "of": "A.theta",
                    "gives": "S.s",
                    "value": f"{radius!r} m*theta/(1 rad)",
                },
            }[kind]
        }
        pull *= MASS / (MASS + inertia / radius**2)
        limited = str(rng.choice(["S.s", "A.theta"]))
    flight = Flight(high, rate, -pull, (0.0, np.inf), kept)
    first, _ = flight.impact()
    fast = float(np.hypot(rate, np.sqrt(2.0 * pull * high)))
    if kept == 1.0:  # to an impact, or near to one
        last = first + 2.0 * fast / pull * int(rng.integers(0, 4)) * float(rng.choice([1.0, 0.9]))
    else:  # the last of its impacts, and where it rests
        last = first + 2.0 * fast / pull * kept / (1.0 - kept) * float(rng.uniform(0.5, 1.5))
    data["limits"] = {limited: {"min": 0, "restitution": kept}}
    start = {"S.s": high, "S.s_dot": rate}
    data["responses"] = {"r": {"start": start, "time": {"from": 0, "to": last, "count": MOMENTS}}}
    _flown(judged, judged.model(data).respond("r"), ("S.s", "S.s_dot"), flight)


def _wheels(rng: np.random.Generator, judged: Judged, kind: str) -> None:
    one, other = (int(n) for n in rng.integers(9, 50, 2))
    own = (-float(rng.uniform(0.1, 9)), float(rng.uniform(0.1, 9)))
    far = (-float(rng.uniform(0.1, 9)), float(rng.uniform(0.1, 9)))
    ends = (max(own[0], -far[1] * other / one), min(own[1], -far[0] * other / one))
    masses = [float(x) for x in rng.uniform(0.1, 2, 2)]
    torque, rate = float(rng.uniform(-3, 3)), float(rng.uniform(1, 3) * rng.choice([-1, 1]))
    kept = float(rng.choice([0.0, 0.5, 0.8, 1.0]))
    turning = {"type": "R", "links": ["ground", "a"], "point": [0, 0]}
    data = begun(plane=True) | {
        "links": {
            "a": {"mass": 1, "center_of_mass": [0, 0], "inertia": masses[0]},
            "b": {"mass": 1, "center_of_mass": [0.06, 0], "inertia": masses[1]},
        },
        "joints": {"A": turning, "B": turning | {"links": ["ground", "b"], "point": [0.06, 0]}},
        "couplings": {"K": {"type": "gear", "joints": ["A", "B"], "teeth": [one, other]}},
    }
    if kind == "ranges":
        _ranges(judged, data | {"limits": {"A.theta": [*own], "B.theta": [*far]}}, ends)
        return
    inertia = masses[0] + masses[1] * (one / other) ** 2
    flight = Flight(0.0, rate, torque / inertia, ends, kept)
    data["limits"] = {
        name: {"min": low, "max": high, "restitution": kept}
        for name, (low, high) in (("A.theta", own), ("B.theta", far))
    }
    data["loads"] = [{"type": "torque", "joint": "A", "value": torque}]
    start = {"A.theta": 0, "A.theta_dot": rate}
    data["responses"] = {"r": {"start": start, "time": {"from": 0, "to": 4, "count": MOMENTS}}}
    _flown(judged, judged.model(data).respond("r"), ("A.theta", "A.theta_dot"), flight)


def _ranges(judged: Judged, data: dict[str, Any], ends: tuple[float, float]) -> None:
    """What a range is, and which rows are beyond the limits."""
    near = {"A.theta": {"from": 0, "to": 0.01, "count": 2}}
    (found,) = judged.model(data | {"motion": {"inputs": near}}).ranges().ranges
    judged.compare("range", [found.lower.value, found.upper.value], ends, 10.0, 1e-9)
    wide = {"A.theta": {"from": -10, "to": 10, "count": 41}}
    result = judged.model(data | {"motion": {"inputs": wide}}).analyze()
    judged.is_ok(result, ["beyond-limit"])
    turned = np.asarray(result["A.theta"])
    beyond = [str(word) == "beyond-limit" for word in result["row.status"]]
    if np.any(beyond != ((turned < ends[0]) | (turned > ends[1]))):
        judged.faults.append(f"rows beyond {ends} are {turned[beyond]}")


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = judged.remark = str(rng.choice(KINDS))
    (_fall if kind.startswith("fall") else _wheels)(rng, judged, kind)
