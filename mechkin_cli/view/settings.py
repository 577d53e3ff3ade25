"""What the `view:` section of a file asks for, checked and in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from mechkin_cli.mechanism.vectors import Vector

Kind = Literal["rod", "plate", "star", "none"]


class ShapeSetting(NamedTuple):
    """The shape of a link: its kind (None: as its points lie), and the points (m, as drawn) that it
    goes through (None: its joints and named points)."""

    kind: Kind | None = None
    points: tuple[Vector, ...] | None = None


@dataclass(frozen=True)
class ViewSettings:
    """How a mechanism is shown.

    Attributes:
        colours: of links by name, `#rrggbb`.
        hidden: links that are not drawn.
        shapes: of links by name.
        joint_radius: m; None: by the size of the mechanism.
        paths: named points whose paths are drawn; None: all.
        forces: whether arrows are shown at first.
        arrow_length: of the longest arrow, m; None: by the size of the mechanism.
        camera: direction from the mechanism to the eye; None: the page's choice.
        speed: seconds for once through a run; None: the page's choice.
    """

    colours: Mapping[str, str] = field(default_factory=dict)
    hidden: frozenset[str] = frozenset()
    shapes: Mapping[str, ShapeSetting] = field(default_factory=dict)
    joint_radius: float | None = None
    paths: frozenset[str] | None = None
    forces: bool = True
    arrow_length: float | None = None
    camera: Vector | None = None
    speed: float | None = None
