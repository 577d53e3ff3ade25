"""The methods that are measured, one file for each family.

A family is a function from a scene to its methods at all their settings, or to the reason why they
cannot run. Heavy libraries are imported inside, so that one that is missing is named and left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from typing import TYPE_CHECKING

from mechkin_cli.benchmark.measurement import Method, Skipped

if TYPE_CHECKING:
    from mechkin_cli.benchmark.scene import Scene


Family = Callable[["Scene"], Iterator[Method]]

FAMILIES = {
    "mechkin": "kernel",
    "dense": "dense",
    "scipy": "with_scipy",
    "stepping": "stepping",
    "Pinocchio": "with_pinocchio",
    "CasADi": "with_casadi",
    "MuJoCo": "with_mujoco",
}
"""Module of this folder by the family's name; the first is ours."""


class Unable(Exception):
    """A method cannot run on this machine or on this mechanism; the message says why."""


def methods_of(scene: Scene, family: str) -> list[Method | Skipped]:
    """All methods of a family that can run, then the reason why others cannot."""
    found: list[Method | Skipped] = []
    try:
        make: Family = import_module(f"{__name__}.{FAMILIES[family]}").methods
        found.extend(make(scene))
    except ImportError as error:
        name = str(error.name or "").partition(".")[0]
        found.append(
            Skipped(scene.name, family, f"{name} is not installed (pip install 'mechkin[bench]')")
        )
    except Unable as reason:
        found.append(Skipped(scene.name, family, str(reason)))
    return found
