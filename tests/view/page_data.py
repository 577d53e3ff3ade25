"""Data for the page, made by hand: mechanisms whose poses are closed forms."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
PAGE = Path(__file__).parents[2] / "mechkin_cli" / "view" / "page.html"
PLACE = "/*mechkin-data*/null"
Z = [0.0, 0.0, 1.0]
X = [1.0, 0.0, 0.0]


def packed(kind: str, values: Any) -> dict[str, str]:
    """Numbers as base64 of little-endian `f32`, `f64`, `i32` or `u8`."""
    code = {"f32": "<f4", "f64": "<f8", "i32": "<i4", "u8": "u1"}[kind]
    return {kind: base64.b64encode(np.ascontiguousarray(values, dtype=code).tobytes()).decode()}


def write_page(folder: Path, data: Any, name: str = "page.html") -> Path:
    """The page with the data in it."""
    text = PAGE.read_text(encoding="utf-8")
    assert text.count(PLACE) == 1
    path = folder / name
    path.write_text(text.replace(PLACE, json.dumps(data).replace("<", "\\u003c")), encoding="utf-8")
    return path


def about_z(angle: Floats, drawn: Floats, now: Floats) -> Floats:
    """Poses (n, 7): a turn by `angle` (n, rad) about z that takes `drawn` to `now` (n, 3)."""
    turned = np.stack(
        [
            np.cos(angle) * drawn[0] - np.sin(angle) * drawn[1],
            np.sin(angle) * drawn[0] + np.cos(angle) * drawn[1],
            np.full_like(angle, drawn[2]),
        ],
        axis=1,
    )
    zero = np.zeros_like(angle)
    return np.hstack(
        [now - turned, np.stack([np.cos(angle / 2), zero, zero, np.sin(angle / 2)], axis=1)]
    )


def at_rest(count: int) -> Floats:
    """Poses (count, 7) of what stays as drawn."""
    return np.tile([0.0, 0, 0, 1, 0, 0, 0], (count, 1))


def half(point: Any, axis: Any = Z, x: Any = X) -> dict[str, Any]:
    return {"point": list(point), "axis": list(axis), "x": list(x), "axis2": None}


def joint(
    name: str, letter: str, links: tuple[int, int], first: Any, second: Any = None, **more: Any
) -> dict[str, Any]:
    return {
        "name": name,
        "type": letter,
        "links": list(links),
        "halves": [first, second or first],
        "lead": None,
        "travel": None,
        "radius": None,
        "track": None,
        "stops": {"turn": None, "slide": None},
        **more,
    }


def rod(*points: Any) -> dict[str, Any]:
    return {"kind": "rod", "points": [list(each) for each in points], "radius": None}


NOTHING = {"kind": "none", "points": []}


def link(name: str, shape: dict[str, Any] = NOTHING, **more: Any) -> dict[str, Any]:
    return {"name": name, "colour": None, "hidden": False, "shape": shape, **more}


def branch(
    name: str,
    x: Floats,
    poses: Floats,
    *,
    own: bool = True,
    codes: Any = None,
    columns: list[dict[str, Any]] | None = None,
    rows: Any = None,
    **more: Any,
) -> dict[str, Any]:
    """A branch of `x` (n) and `poses` (P, links, 7), of all rows or of `rows` (P)."""
    return {
        "name": name,
        "own": own,
        "rows": len(x),
        "x": packed("f64", x),
        "poses": {
            "rows": packed("i32", np.arange(len(x)) if rows is None else rows),
            "values": packed("f32", poses),
        },
        "status": {
            "words": ["ok", "near-singular", "beyond-dead-centre"],
            "doubts": [0, 1, 2],
            "codes": packed("u8", np.zeros(len(x)) if codes is None else codes),
        },
        "marks": [],
        "columns": columns or [],
        "arrows": [],
        **more,
    }


def exact_column(label: str, values: Floats, unit: str = "deg") -> dict[str, Any]:
    """A column of a table with all digits of its numbers."""
    return {"label": label, "unit": unit, "exact": packed("f64", values)}


def page_data(
    name: str, links: Any, joints: Any, branches: Any, *, size: float, centre: Any, **more: Any
) -> dict[str, Any]:
    return {
        "format": 1,
        "program": "mechkin 0.1.0",
        "file": f"{name}.yaml",
        "name": name,
        "units": {"length": "mm", "angle": "deg", "force": "N", "moment": "N*mm"},
        "size": size,
        "centre": list(centre),
        "up": Z,
        "planar": False,
        "links": links,
        "joints": joints,
        "points": [],
        "wheels": [],
        "belts": [],
        "screws": [],
        "discs": [],
        "cables": [],
        "runs": [
            {
                "name": "sweep",
                "kind": "sweep",
                "title": "sweep",
                "x": {"label": "A.theta", "unit": "deg"},
                "ties": [],
                "branches": branches,
            }
        ],
        "tables": [],
        "notes": [],
        "assumed": [],
        "view": {"camera": None, "speed": 6, "forces": False},
        **more,
    }


class FourBar:
    """Crank a, coupler b, rocker c, ground d, by the law of cosines; `sign` is the mode."""

    a, b, c, d = 30.0, 80.0, 60.0, 90.0
    """Lengths as the data have them; others may be given by name."""

    tip = np.array([0.4, 0.5])  # the coupler point, along and across the coupler in parts of b

    def __init__(self, theta: Floats, sign: float = 1.0, **lengths: float) -> None:
        vars(self).update(lengths)
        self.theta = theta
        self.crank = self.a * np.stack([np.cos(theta), np.sin(theta), 0 * theta], axis=1)
        self.pivot = np.array([self.d, 0.0, 0.0])
        reach = self.pivot - self.crank
        length = np.linalg.norm(reach, axis=1)
        between = np.arccos((self.b**2 + length**2 - self.c**2) / (2 * self.b * length))
        self.phi = np.arctan2(reach[:, 1], reach[:, 0]) + sign * between
        along = np.stack([np.cos(self.phi), np.sin(self.phi), 0 * theta], axis=1)
        across = np.stack([-np.sin(self.phi), np.cos(self.phi), 0 * theta], axis=1)
        self.rocker = self.crank + self.b * along
        self.coupler_point = self.crank + self.b * (
            self.tip[0] * along + sign * self.tip[1] * across
        )
        arm = self.rocker - self.pivot
        self.psi = np.unwrap(np.arctan2(arm[:, 1], arm[:, 0]))


def four_bar(rows: int = 73, poses: int | None = None) -> dict[str, Any]:
    """A crank-rocker: both modes, coupler curve, arrows, table; `poses` of its rows have one."""
    theta = np.radians(np.linspace(0, 360, rows))
    kept = (
        np.arange(rows) if poses is None else np.unique(np.linspace(0, rows - 1, poses).astype(int))
    )
    home = FourBar(np.array([0.0]))
    own = FourBar(theta)
    links = [
        link("ground"),
        link("crank", rod([0, 0, 0], home.crank[0])),
        link(
            "coupler",
            {
                "kind": "plate",
                "points": [list(each[0]) for each in (home.crank, home.rocker, home.coupler_point)],
                "normal": Z,
            },
        ),
        link("rocker", rod(home.rocker[0], home.pivot)),
    ]
    joints = [
        joint("A", "R", (0, 1), half([0, 0, 0])),
        joint("B", "R", (1, 2), half(home.crank[0])),
        joint("C", "R", (2, 3), half(home.rocker[0])),
        joint("D", "R", (0, 3), half(home.pivot)),
    ]

    def branch_of(bar: FourBar, name: str, *, is_own: bool) -> dict[str, Any]:
        poses_of = np.stack(
            [
                at_rest(rows),
                about_z(bar.theta, np.zeros(3), np.zeros((rows, 3))),
                about_z(bar.phi - home.phi[0], home.crank[0], bar.crank),
                about_z(bar.psi - home.psi[0], home.pivot, np.tile(home.pivot, (rows, 1))),
            ],
            axis=1,
        )
        force = np.stack([100 * np.cos(theta), 60 * np.sin(theta), 0 * theta], axis=1)[kept]
        moment = np.stack([0 * theta, 0 * theta, 500 * np.cos(theta)], axis=1)[kept]
        return branch(
            name,
            np.degrees(theta),
            poses_of[kept],
            own=is_own,
            rows=kept,
            codes=np.where(np.abs(np.degrees(theta) - 180) < 6, 1, 0) if is_own else None,
            columns=[
                {
                    "label": "psi",
                    "unit": "deg",
                    "table": "angles",
                    "rounding": 0.0,
                    "values": packed("f64", np.degrees(bar.psi)),
                },
                {
                    "label": "phi",
                    "unit": "deg",
                    "table": "angles",
                    "rounding": 0.0,
                    "values": packed("f64", np.degrees(bar.phi)),
                },
                {
                    "label": "tip_y",
                    "unit": "mm",
                    "table": "tip",
                    "rounding": 0.0,
                    "values": packed("f64", bar.coupler_point[:, 1]),
                },
            ],
            marks=[{"x": 180.0, "kind": "dead-centre", "text": "crank and coupler in line"}]
            if is_own
            else [],
            arrows=[
                {
                    "name": "C.force",
                    "kind": "force",
                    "unit": "N",
                    "link": 3,
                    "place": list(home.rocker[0]),
                    "values": packed("f32", force),
                },
                {
                    "name": "A.effort",
                    "kind": "moment",
                    "unit": "N*mm",
                    "link": 1,
                    "place": [0, 0, 0],
                    "values": packed("f32", moment),
                },
            ],
        )

    other = FourBar(theta, -1.0)
    return page_data(
        "four-bar",
        links,
        joints,
        [branch_of(own, "mode 1", is_own=True), branch_of(other, "mode 2", is_own=False)],
        size=150.0,
        centre=[45.0, 10.0, 0.0],
        planar=True,
        up=[0, 1, 0],
        points=[{"name": "tip", "link": 2, "place": list(home.coupler_point[0]), "path": True}],
        tables=[
            {
                "name": "angles",
                "title": "Angles of the four-bar",
                "run": "sweep",
                "columns": [
                    exact_column("theta", np.degrees(theta)),
                    exact_column("psi", np.degrees(own.psi)),
                    exact_column("phi", np.degrees(own.phi)),
                ],
                "rows": [
                    [f"{np.degrees(one):.2f}" for one in row]
                    for row in zip(theta, own.psi, own.phi, strict=True)
                ],
                "status": [1 if abs(np.degrees(one) - 180) < 6 else 0 for one in theta],
            }
        ],
        notes=[{"severity": "warning", "text": "the crank is heavy", "place": "four-bar.yaml:3:5"}],
        assumed=["lengths are in mm"],
    )


def slider(rows: int = 41) -> dict[str, Any]:
    """A block on a rail along x, s = 0 .. 50, beyond a dead centre in its last rows."""
    s = np.linspace(0, 50, rows)
    found = np.arange(rows) < rows - 5
    poses = np.stack(
        [at_rest(rows), np.hstack([np.stack([s, 0 * s, 0 * s], axis=1), at_rest(rows)[:, 3:]])],
        axis=1,
    )
    links = [link("ground"), link("block", rod([0, 0, 0], [0, 0, 15]))]
    joints = [joint("S", "P", (0, 1), half([0, 0, 0], X, [0, 1, 0]))]
    return page_data(
        "slider",
        links,
        joints,
        [
            branch(
                "mode 1", s, poses[found], rows=np.flatnonzero(found), codes=np.where(found, 0, 2)
            )
        ],
        size=60.0,
        centre=[25, 0, 5],
    )


TYPES = ["R", "P", "C", "H", "S", "U", "Sp", "Sg", "E", "W", "Ss", "Sc", "Cp", "F"]


def one_of_every_type(rows: int = 25) -> dict[str, Any]:
    """One joint of every type beside the other: a holder rests, and a link moves in it."""
    share = np.linspace(-1, 1, rows)
    zero = 0 * share
    links, joints, poses = [link("ground")], [], [at_rest(rows)]
    for k, letter in enumerate(TYPES):
        point = np.array([40.0 * (k % 7), 45.0 * (k // 7), 0.0])
        second_axis = {"U": X, "Ss": X, "Sc": [0.0, 1, 0], "Sg": X, "Cp": [0.0, 1, 0]}.get(
            letter, Z
        )
        second_x = [0.0, 1, 0] if second_axis != [0.0, 1, 0] else X
        out = np.array(
            {
                "Sp": [0, 0, -14.0],
                "Sg": [0, 0, -14.0],
                "E": [0, 0, 14.0],
                "U": [0, 14.0, 0],
                "Cp": [0, -14.0, 0],
            }.get(letter, [14.0, 0, 0])
        )
        back = np.array(
            {
                "E": [0, 0, -14.0],
                "U": [0, 0, -14.0],
                "Cp": [0, 14.0, 0],
                "Sp": [0, 0, 14.0],
                "Sg": [0, 0, 14.0],
            }.get(letter, [-14.0, 0, 0])
        )
        links += [
            link(f"holder_{letter}", rod(point, point + back)),
            link(f"mover_{letter}", rod(point, point + out)),
        ]
        joints.append(
            joint(
                letter,
                letter,
                (len(links) - 2, len(links) - 1),
                half(point),
                half(point, second_axis, second_x),
                lead=8.0 if letter == "H" else None,
            )
        )
        angle = 0.5 * share if letter in ("R", "C", "H", "E", "S") else zero
        shift = {
            "P": [zero, zero, 8 * share],
            "C": [zero, zero, 8 * share],
            "H": [zero, zero, 8 * 0.5 * share / (2 * np.pi)],
            "Sp": [6 * share, 3 * share, zero],
            "Sg": [8 * share, zero, zero],
            "E": [6 * share, zero, zero],
            "Sc": [zero, zero, 6 * share],
            "Cp": [5 * share, zero, zero],
        }.get(letter, [zero, zero, zero])
        poses += [at_rest(rows), about_z(angle, point, point + np.stack(shift, axis=1))]
    return page_data(
        "every joint",
        links,
        joints,
        [branch("mode 1", share, np.stack(poses, axis=1))],
        size=260.0,
        centre=[120, 22, 0],
    )
