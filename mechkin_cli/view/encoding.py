"""Data of a page as JSON that stands in an HTML file: arrays in base64, nothing that is markup.

Arrays are row-major and little-endian: {"f32": ...}, {"f64": ...}, {"i32": ...}, {"u8": ...}.
"""

from __future__ import annotations

import json
from base64 import b64encode
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli.legible import legible

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    Plain = dict[str, object]

_TYPES = {"f32": "<f4", "f64": "<f8", "i32": "<i4", "u8": "|u1"}
_MARKUP = {ord("<"): "\\u003c", ord(">"): "\\u003e", ord("&"): "\\u0026"}


def packed(kind: Literal["f32", "f64", "i32", "u8"], values: ArrayLike) -> dict[str, str]:
    """An array of any shape.

    Example:
        >>> packed("i32", [1, 2])
        {'i32': 'AQAAAAIAAAA='}
    """
    array = np.ascontiguousarray(values, dtype=_TYPES[kind])
    return {kind: b64encode(array.tobytes()).decode("ascii")}


def script_json(data: Plain) -> str:
    r"""JSON in ASCII in which no text can end the script element that holds it, or begin another.

    Raises:
        ValueError: a number outside of arrays is not finite.

    Example:
        >>> script_json({"name": "</script>"})
        '{"name":"\\u003c/script\\u003e"}'
    """
    text = json.dumps(_shown(data), ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.translate(_MARKUP)


def _shown(value: object) -> object:
    """Plain data whose texts hold no characters that do not print or that turn the line."""
    if isinstance(value, str):
        return legible(value)
    if isinstance(value, list):
        return [_shown(item) for item in value]
    if isinstance(value, dict):
        return {key: _shown(item) for key, item in value.items()}
    return value
