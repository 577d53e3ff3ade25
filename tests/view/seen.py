"""What a page shows, read back from its data as the page reads it."""

from __future__ import annotations

import json
from base64 import b64decode
from typing import Any

import numpy as np

import mechkin_cli as mk
from mechkin_cli.view.page import script_json
from mechkin_cli.view.scene import view_scene

TYPES = {"f32": "<f4", "f64": "<f8", "i32": "<i4", "u8": "|u1"}


def data(model: mk.Model, modes: bool = True, run: str | None = None) -> dict[str, Any]:
    """The data of a model's page, through JSON and back."""
    scene, _ = view_scene(model.analyses(run), modes)
    found: dict[str, Any] = json.loads(script_json(scene.record()))
    return found


def array(packed: dict[str, str]) -> np.ndarray:
    ((kind, text),) = packed.items()
    return np.frombuffer(b64decode(text), TYPES[kind])


def branch(shown: dict[str, Any], run: int = 0, number: int = 0) -> dict[str, Any]:
    found: dict[str, Any] = shown["runs"][run]["branches"][number]
    return found


def poses(shown: dict[str, Any], run: int = 0, number: int = 0) -> np.ndarray:
    """Poses (poses, links, 7) of a branch."""
    values = array(branch(shown, run, number)["poses"]["values"])
    return values.astype(float).reshape(-1, len(shown["links"]), 7)


def posed_rows(shown: dict[str, Any], run: int = 0, number: int = 0) -> np.ndarray:
    return array(branch(shown, run, number)["poses"]["rows"])


def number_of(shown: dict[str, Any], link: str) -> int:
    return [one["name"] for one in shown["links"]].index(link)


def rotation(q: np.ndarray) -> np.ndarray:
    """Rotation matrices of quaternions (..., 4), scalar first, by the textbook's entries."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def moved(pose: np.ndarray, point: Any) -> np.ndarray:
    """Where a drawn point is in poses (..., 7)."""
    return rotation(pose[..., 3:]) @ np.asarray(point, dtype=float) + pose[..., :3]


def column(shown: dict[str, Any], label: str, run: int = 0, number: int = 0) -> np.ndarray:
    found = next(one for one in branch(shown, run, number)["columns"] if one["label"] == label)
    return array(found["values"])
