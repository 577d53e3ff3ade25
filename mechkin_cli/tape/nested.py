"""Recorded numbers inside nested data: mappings, tuples, data classes, arrays of objects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np

from mechkin_cli.tape.traced import Traced


def traced_in(value: Any) -> Iterator[Traced]:
    """Every recorded number of some data, in a fixed order."""
    if isinstance(value, Traced):
        yield value
    elif isinstance(value, np.ndarray):
        if value.dtype == object:
            yield from (item for item in value.flat if isinstance(item, Traced))
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from traced_in(item)
    elif isinstance(value, tuple):
        for item in value:
            yield from traced_in(item)
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            yield from traced_in(getattr(value, field.name))


def filled(value: Any, numbers: Iterator[float]) -> Any:
    """The data with `numbers` in the places of `traced_in`; parts without any stay the objects
    that they are."""
    if isinstance(value, Traced):
        return next(numbers)
    if isinstance(value, np.ndarray):
        if value.dtype != object:
            return value
        entries = [next(numbers) if isinstance(item, Traced) else item for item in value.flat]
        return np.array(entries, dtype=np.float64).reshape(value.shape)
    if isinstance(value, tuple):
        items = [filled(item, numbers) for item in value]
        if all(new is old for new, old in zip(items, value, strict=True)):
            return value
        return type(value)(*items) if hasattr(value, "_fields") else tuple(items)
    if isinstance(value, Mapping):
        pairs = {key: filled(item, numbers) for key, item in value.items()}
        return value if all(pairs[key] is value[key] for key in value) else pairs
    if is_dataclass(value) and not isinstance(value, type):
        changes = {}
        for field in fields(value):
            old = getattr(value, field.name)
            new = filled(old, numbers)
            if new is not old:
                changes[field.name] = new
        return replace(value, **changes) if changes else value
    return value
