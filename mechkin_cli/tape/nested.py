"""Recorded numbers inside nested data: mappings, tuples, data classes, arrays of objects.

Data is filled in by the steps that build it: each distinct part with a recorded number in it once,
from parts that stand before. Parts without any stay the objects that they are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from mechkin_cli.tape.traced import Traced

Build = Callable[[list[Any]], Any]


class Filling:
    """How some data follows from its recorded numbers.

    Attributes:
        numbers: the recorded numbers, each once.
    """

    def __init__(self, data: Any) -> None:
        self.numbers: list[Traced] = []
        self._registers: dict[int, int] = {}
        self._parts: dict[int, int | None] = {}
        self._kept: list[Any] = []
        self._steps: list[tuple[Build, list[int]]] = []
        self._whole = self._place(data)
        self._data = data

    def fill(self, numbers: Sequence[float]) -> Any:
        """The data with other numbers in the places of the recorded ones."""
        if self._whole is None:
            return self._data
        # a place: 3k for number k, 3k + 1 for a part that is kept, 3k + 2 for the result of a step
        built: list[Any] = []
        sources = (numbers, self._kept, built)
        for build, places in self._steps:
            built.append(build([sources[place % 3][place // 3] for place in places]))
        return sources[self._whole % 3][self._whole // 3]

    def _place(self, value: Any) -> int | None:
        """The place of a value with recorded numbers; None where it has none."""
        if isinstance(value, Traced):
            if value.register not in self._registers:
                self._registers[value.register] = len(self.numbers)
                self.numbers.append(value)
            return 3 * self._registers[value.register]
        if id(value) not in self._parts:
            self._parts[id(value)] = self._built(value)
        return self._parts[id(value)]

    def _built(self, value: Any) -> int | None:
        taken_apart = _taken_apart(value)
        if taken_apart is None:
            return None
        items, build = taken_apart
        places = [self._place(item) for item in items]
        if all(place is None for place in places):
            return None
        found = [
            self._keep(item) if place is None else place
            for item, place in zip(items, places, strict=True)
        ]
        self._steps.append((build, found))
        return 3 * (len(self._steps) - 1) + 2

    def _keep(self, item: Any) -> int:
        self._kept.append(item)
        return 3 * (len(self._kept) - 1) + 1


def _taken_apart(value: Any) -> tuple[list[Any], Build] | None:
    """The parts of a value, and how it is built of such parts; None for what has none."""
    if isinstance(value, np.ndarray):
        if value.dtype != object:
            return None
        return list(value.flat), partial(_array, value.shape)
    if isinstance(value, tuple):
        return list(value), getattr(type(value), "_make", tuple)
    if isinstance(value, Mapping):
        return list(value.values()), partial(_mapping, list(value))
    if is_dataclass(value) and not isinstance(value, type):
        names = [field.name for field in fields(value)]
        return [getattr(value, name) for name in names], partial(_record, value, names)
    return None


def _array(shape: tuple[int, ...], items: list[Any]) -> Any:
    return np.array(items, dtype=np.float64).reshape(shape)


def _mapping(keys: list[Any], items: list[Any]) -> dict[Any, Any]:
    return dict(zip(keys, items, strict=True))


def _record(value: Any, names: list[str], items: list[Any]) -> Any:
    return replace(value, **dict(zip(names, items, strict=True)))
