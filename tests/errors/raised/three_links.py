"""Three-link mechanisms at many digits, from the closed forms of `mechanisms.three_links`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mechanisms.precise import Number, Vector, dot, mp, plus, turned, unit, vector
from mechanisms.three_links import (
    Pair,
    groove_slides,
    groove_turn,
    home_sign,
    plane_turn,
    root,
)

DIGITS = 200
"""Of the forms themselves: differences leave a third of them."""
DRAWINGS = {
    "rspr_identified": ((2, 1, 0), (-3, 2, 0), (0, 0, 0), (0, 6, 1), ("1.5",) * 3, (0, 0, 1)),
    "rspr_as_printed": ((2, 1, 0), (-3, 2, 0), (0, 0, 0), (0, 0, 1), ("1.5",) * 3, (0, 0, 1)),
    "rsgc": ((1, 2, 1), (1, 1, 0), (0, 0, 0), (0, 0, 1), (3, 3, 3), (1, 1, 2)),
    "rspp": (
        (1, 2, 2),
        (2, -1, 3),
        (1, -1, "0.5"),
        ("0.25", "0.75", "-1.5"),
        ("2.5", 1, "-0.5"),
        (1, -2, 4),
    ),
    "pspr": ((1, 1, -2), (2, 3, 6), (1, 0, 2), ("0.5", -1, 2), (3, "1.5", 1), (-1, 2, 2)),
}
"""A, B, P, Q, R and N of each mechanism."""


def raised(table: str, row: Mapping[str, str]) -> dict[str, Any]:
    """The cells of a row of `exact/<table>.csv`, from its input and its branch."""
    with mp.workdps(DIGITS):
        a, b, p, q, r, n = (vector(*x) for x in DRAWINGS[row.get("case", table)])
        pair = Pair(unit(a), unit(b), p, q, r, unit(n))
        slides = table == "pspr"
        value = mp.mpf(row["s_A"]) if slides else mp.mpf(row["theta_A_deg"]) * (mp.pi / 180)
        name = "s_A" if slides else "theta_A"
        rate, bend = (mp.mpf(row.get(f"{name}{x}", y)) for x, y in (("_dot", "1"), ("_ddot", "0")))
        other = row["branch"] == "other"

        def state(t: Number) -> dict[str, Number]:
            at = value + rate * t + bend * t * t / 2
            sphere = pair.sphere(mp.zero, at) if slides else pair.sphere(at, mp.zero)
            return _FORMS[table](pair, sphere, other)

        found: dict[str, Any] = {}
        home = state(mp.zero)
        for label in home:
            series = mp.taylor(lambda t, label=label: state(t)[label], 0, 2)
            found |= {label: home[label], f"{label}_dot": series[1], f"{label}_ddot": 2 * series[2]}
        if "theta_B" in found:
            angle = found.pop("theta_B")
            angle -= 2 * mp.pi * mp.nint(angle / (2 * mp.pi))
            found |= {"theta_B_deg": angle / (mp.pi / 180), "theta_B_rad": angle}
        if "slip_x" in row:
            sphere = pair.sphere(mp.zero, value) if slides else pair.sphere(value, mp.zero)
            slip = _slip(pair, sphere, home)
            found |= dict(zip(("slip_x", "slip_y", "slip_z"), slip, strict=True))
        return found


def _turn(pair: Pair, sphere: Vector, other: bool) -> dict[str, Number]:
    sign = home_sign(*plane_turn(pair, pair.r, mp.zero))
    return {"theta_B": root(*plane_turn(pair, sphere, mp.zero), -sign if other else sign)}


def _groove(pair: Pair, sphere: Vector, other: bool) -> dict[str, Number]:
    sign = home_sign(*groove_turn(pair, pair.r))
    turn = root(*groove_turn(pair, sphere), -sign if other else sign)
    s_g, s_b = groove_slides(pair, sphere, turn)
    return {"theta_B": turn, "s_G": s_g, "s_B": s_b}


def _slide(pair: Pair, sphere: Vector, other: bool) -> dict[str, Number]:
    """The plane goes as far along B as the sphere goes square to it."""
    return {"s_B": dot(plus(sphere, pair.r, -1), pair.n) / dot(pair.b, pair.n)}


_FORMS = {"rspr": _turn, "pspr": _turn, "rsgc": _groove, "rspp": _slide}


def _slip(pair: Pair, sphere: Vector, state: Mapping[str, Number]) -> Vector:
    """The sphere against the point of the plane that it touched in the drawing."""
    contact = plus(pair.q, turned(pair.arm, pair.b, state.get("theta_B", mp.zero)))
    contact = plus(contact, pair.b, state.get("s_B", mp.zero))
    return plus(sphere, contact, -1)
