"""Laws of motion over time and over a coordinate, alone and in sequences, against their definitions
at 40 digits, which are differentiated as numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
from random_families.driven_machines.judged import Judged, begun, numbers

KINDS = ("time", "coordinate", "sequence", "sine")
LIMIT = 1e-9
DIGITS = 40
Shape = Callable[[Any], Any]
JUMPS = (0.0, 0.125, 0.375, 0.5, 0.625, 0.875, 1.0, 1.05, 1.35)
"""Where the third derivative of some rise jumps, and where segments begin."""


def _modified_sine(u: Any) -> Any:
    scale = 1 / (4 + mp.pi)
    if u <= mp.mpf(1) / 8:
        return scale * (mp.pi * u - mp.sin(4 * mp.pi * u) / 4)
    if u <= mp.mpf(7) / 8:
        wave = mp.sin(4 * mp.pi * u / 3 + mp.pi / 3)
        return scale * (2 + mp.pi * u - mp.mpf(9) / 4 * wave)
    return scale * (4 + mp.pi * u - mp.sin(4 * mp.pi * u) / 4)


def _modified_trapezoid(u: Any) -> Any:
    """Quarter waves and constant accelerations, integrated from eighth to eighth."""
    if u > 0.5:
        return 1 - _modified_trapezoid(1 - u)
    most, turn, eighth = 8 * mp.pi / (2 + mp.pi), 4 * mp.pi, mp.mpf(1) / 8
    if u <= eighth:
        return most / turn * u - most / turn**2 * mp.sin(turn * u)
    place, rate = most / turn * eighth - most / turn**2, most / turn
    if u <= 3 * eighth:
        return place + rate * (u - eighth) + most * (u - eighth) ** 2 / 2
    place += rate * 2 * eighth + most * (2 * eighth) ** 2 / 2
    rate += most * 2 * eighth
    left = u - 3 * eighth
    return place + rate * left + most / turn**2 * (1 - mp.cos(turn * left))


RISES: dict[str, Shape] = {
    "harmonic": lambda u: (1 - mp.cos(mp.pi * u)) / 2,
    "cycloidal": lambda u: u - mp.sin(2 * mp.pi * u) / (2 * mp.pi),
    "3-4-5": lambda u: 10 * u**3 - 15 * u**4 + 6 * u**5,
    "4-5-6-7": lambda u: 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7,
    "modified-sine": _modified_sine,
    "modified-trapezoid": _modified_trapezoid,
}
"""From 0 to 1 while u does."""


def _risen(shape: Shape, u: Any, first: float, last: float) -> Any:
    return mp.mpf(first) + (mp.mpf(last) - mp.mpf(first)) * shape(min(max(u, 0), 1))


def _law(
    rng: np.random.Generator, kind: str, span: float, begin: float
) -> tuple[Any, Shape, float]:
    """What the file has, its value at a place or moment, and the largest of its value."""
    first, last = (float(x) for x in rng.uniform(-5, 5, 2) * 10.0 ** rng.uniform(-3, 2))
    if kind == "sine":
        phase = float(rng.uniform(-3, 3))
        given: dict[str, Any] = {"law": "sine", "amplitude": last, "offset": first, "phase": phase}
        slow = bool(rng.integers(2))
        given |= {"period": span} if slow else {"frequency": f"{1.0 / span!r}/(1 s)"}
        rate = 1 / mp.mpf(span) if slow else mp.mpf(1.0 / span)
        # moments are counted from the first one, a tenth of a span before `begin`
        zero = mp.mpf(begin - 0.1 * span)

        def wave(t: Any) -> Any:
            return first + last * mp.sin(2 * mp.pi * rate * (t - zero) + phase)

        return given, wave, max(abs(first), abs(last))
    name = str(rng.choice(list(RISES)))
    if kind != "sequence":
        given = {"law": name, "from": first, "to": last, "start": begin, "duration": span}

        def rise(t: Any) -> Any:
            return _risen(RISES[name], (t - begin) / mp.mpf(span), first, last)

        return given, rise, max(abs(first), abs(last))
    end = float(rng.uniform(-5, 5))
    rest, back = span * 0.05, span * 0.3
    segments = [
        {"for": span, "to": last, "law": name},
        {"for": rest, "law": "dwell"},
        {"for": back, "to": end, "law": "3-4-5"},
    ]
    given = {"law": "sequence", "from": first, "start": begin, "segments": segments}

    def value(t: Any) -> Any:
        after = (t - begin - mp.mpf(span) - mp.mpf(rest)) / mp.mpf(back)
        if after > 0:
            return _risen(RISES["3-4-5"], after, last, end)
        return _risen(RISES[name], (t - begin) / mp.mpf(span), first, last)

    return given, value, max(abs(first), abs(last), abs(end))


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = judged.remark = str(rng.choice(KINDS))
    span, begin = (
        float(10.0 ** rng.uniform(-3, 3)),
        float(rng.uniform(-1, 2) * 10.0 ** rng.uniform(-2, 2)),
    )
    law, value, size = _law(rng, kind, span, begin)
    data = begun(plane=True) | {
        "links": {"a": {}, "b": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
            "B": {"type": "P", "links": ["ground", "b"], "point": [0.1, 0], "axis": [1, 0]},
        },
    }
    rate, acceleration = 1.0, 0.0
    if kind == "coordinate":
        rate, acceleration = (float(x) for x in rng.uniform(-3, 3, 2))
        places = numbers(begin + span * np.sort(rng.uniform(-0.2, 1.2, 7)))
        data["couplings"] = {"K": {"type": "function", "of": "A.theta", "gives": "B.s", "law": law}}
        driven = {"values": places, "rate": rate, "acceleration": acceleration}
        data["motion"] = {"inputs": {"A.theta": driven}}
        name, leading = "B.s", "A.theta"
    else:
        time = {"from": begin - 0.1 * span, "to": begin + 1.5 * span, "count": 9}
        resting = {"law": "constant-rate", "at": 0, "rate": 0}
        data["motion"] = {"time": time, "inputs": {"A.theta": law, "B.s": resting}}
        name, leading = "A.theta", "time"
    result = judged.model(data).analyze()
    if not judged.is_ok(result):
        return
    found = [np.asarray(result[name + dots], float) for dots in ("", "_dot", "_ddot")]
    for k, place in enumerate(np.asarray(result[leading], float)):
        u = (place - begin) / span
        if kind != "sine" and min(abs(u - jump) for jump in JUMPS) < 1e-4:
            continue
        with mp.workdps(DIGITS):
            step = mp.mpf(span) * mp.mpf(10) ** -10
            at = value(mp.mpf(place))
            slope = mp.diff(value, mp.mpf(place), 1, h=step)
            curvature = mp.diff(value, mp.mpf(place), 2, h=step)
            wanted = [at, slope * rate, curvature * rate**2 + slope * acceleration]
        # a place is rounded, of which a span is a small part
        limit = LIMIT + 1e-12 * abs(place) / span
        sizes = [1.0, abs(rate), rate**2 + span * abs(acceleration)]
        quick = {"sine": 2 * np.pi, "sequence": 1 / 0.3}.get(kind, 1.0)
        for order, right in enumerate(wanted):
            most = size * sizes[order] * (quick / span) ** order
            judged.compare(
                f"{name} {order} at {place!r}", found[order][k], float(right), most, limit
            )
