"""Drawings of a cam: DXF, as AutoCAD's release 12 reads it, and SVG; its pitch curve in YAML."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

CLOSED = 1
"""Flag of a polyline whose last point leads to the first one."""

_MARGIN = 1.1
"""The picture of a cam over its size."""

_COLOURS = {"PROFILE": "#1f77b4", "PITCH": "#999999"}


def dxf_bytes(curves: Mapping[str, Floats], base: float, unit: str, is_closed: bool) -> bytes:
    """A DXF file of curves (2, points), each on the layer of its name, and of the base circle; the
    cam's axis is its origin."""
    pairs: list[tuple[int, str]] = [(999, f"lengths in {unit}"), (0, "SECTION"), (2, "ENTITIES")]
    for layer, places in curves.items():
        flag = CLOSED if is_closed else 0
        pairs += [(0, "POLYLINE"), (8, layer), (66, "1"), (70, str(flag))]
        pairs += [(10, "0.0"), (20, "0.0"), (30, "0.0")]
        for x, y in _drawn(places, is_closed):
            pairs += [(0, "VERTEX"), (8, layer), (10, repr(x)), (20, repr(y)), (30, "0.0")]
        pairs += [(0, "SEQEND"), (8, layer)]
    circle = [(10, "0.0"), (20, "0.0"), (30, "0.0"), (40, repr(base))]
    pairs += [(0, "CIRCLE"), (8, "BASE"), *circle, (0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code:3d}\n{value}\n" for code, value in pairs).encode("ascii", "replace")


def svg_bytes(curves: Mapping[str, Floats], base: float, is_closed: bool) -> bytes:
    """An SVG file of the same, y upward."""
    half = _MARGIN * max(base, *(float(np.abs(places).max()) for places in curves.values()))
    line = f'fill="none" stroke-width="{half / 200:.6g}"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{-half:.6g} {-half:.6g} '
        f'{2 * half:.6g} {2 * half:.6g}" width="600" height="600">',
        f'<circle r="{base:.9g}" {line} stroke="#cccccc"/>',
        f'<circle r="{half / 60:.6g}" fill="#333333"/>',
    ]
    for layer, places in curves.items():
        points = " L ".join(f"{x:.9g} {-y:.9g}" for x, y in _drawn(places, is_closed))
        end = " Z" if is_closed else ""
        colour = _COLOURS[layer]
        lines.append(f'<path id="{layer.lower()}" d="M {points}{end}" {line} stroke="{colour}"/>')
    return ("\n".join([*lines, "</svg>"]) + "\n").encode()


def curve_bytes(curve: Mapping[str, Any], unit: str) -> bytes:
    """A curve through points as a section of a mechanism file."""
    lines = [f"# on the cam, from its axis, in {unit}", "curve:"]
    lines += [f"  closed: {str(curve['closed']).lower()}", "  points:"]
    lines += [f"    - [{x!r}, {y!r}]" for x, y in curve["points"]]
    return ("\n".join(lines) + "\n").encode()


def _drawn(places: Floats, is_closed: bool) -> list[tuple[float, float]]:
    """The points of a polyline, without the last one of a closed curve."""
    shown = places[:, :-1] if is_closed else places
    return [(float(x), float(y)) for x, y in shown.T]
