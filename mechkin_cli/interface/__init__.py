"""The Python interface: load a mechanism file, analyze it, read quantities by name.

The commands are thin calls of these.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from mechkin_cli.building.build import build
from mechkin_cli.building.source import open_data, open_file, open_text
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.interface.analysis import Analysis
from mechkin_cli.interface.arguments import Setting, a_path, a_text
from mechkin_cli.interface.model import Model
from mechkin_cli.interface.settings import parameter_texts

DATA = "data"
"""What messages call the dict that a caller gives."""

__all__ = ["Analysis", "Model", "load", "loads"]

_NO_PARAMETERS: Mapping[str, Setting] = MappingProxyType({})


def load(
    path: str | Path | Mapping[str, Any],
    parameters: Mapping[str, Setting] = _NO_PARAMETERS,
    *,
    folder: str | Path | None = None,
) -> Model:
    """Reads and checks a mechanism: a file, or the same sections as a dict. Text is for `loads`.

    Args:
        path: of the YAML file; or a dict of texts, numbers (of numpy, too), lists and dicts, whose
            messages name the way of keys to a value, `data at joints.A.point[2]`.
        parameters: what replaces values of its `parameters:`, such as {"P1": "0.6 in"}; a number
            has no unit.
        folder: where the files are that a dict names; None: it may name none.

    Raises:
        UsageError: the file cannot be read, or an unknown parameter.
        InvalidFile: with every independent error and its place.

    Example:
        >>> load("mechanisms/rcsr.yaml").name
        'RCSR'
        >>> pin = {"type": "R", "links": ["ground", "arm"], "point": [0, 0, 0], "axis": [0, 0, 1]}
        >>> sweep = {"O.theta": {"from": 0, "to": 90, "step": 45}}
        >>> arm = {"format": 1, "links": {"arm": {}}, "joints": {"O": pin}}
        >>> load(arm | {"motion": {"inputs": sweep}}).analyze()["O.theta"].tolist()
        [0.0, 45.0, 90.0]
    """
    place = None if folder is None else a_path("folder", folder)
    if isinstance(path, Mapping):
        return Model(build(open_data(path, DATA, parameter_texts(parameters), place)), DATA)
    if isinstance(path, str) and "\n" in path:
        raise UsageError("path: this is a text of several lines, no path; use loads(text)")
    path = a_path("path", path)
    return Model(build(open_file(path, parameter_texts(parameters))), path.stem)


def loads(
    text: str,
    name: str = "text",
    parameters: Mapping[str, Setting] = _NO_PARAMETERS,
    *,
    folder: str | Path | None = None,
) -> Model:
    """As `load`, for the text of a mechanism file.

    Args:
        text: YAML.
        name: stands for the file in messages.
        parameters: as in `load`.
        folder: where the files are that the text names; None: it may name none.

    Raises:
        UsageError: an unknown parameter.
        InvalidFile: with every independent error, its line and its column.
    """
    a_text("text", text, '"format: 1 ..."'), a_text("name", name, '"rcsr.yaml"')
    place = None if folder is None else a_path("folder", folder)
    built = build(open_text(text, name, parameter_texts(parameters), place))
    return Model(built, Path(name).stem)
