"""What has been found and is kept: a question asked twice does its work once."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

T = TypeVar("T")


class Keeping:
    """Keeps what it has found, by keys: `once` for all objects of one structure, which share it,
    `own` for one object alone."""

    def __init__(self) -> None:
        self._kept: dict[object, object] = {}
        self._own: dict[object, object] = {}

    def once(self, key: object, find: Callable[[], T]) -> T:
        """What `find` gives, found once for each key and all that share the structure."""
        if key not in self._kept:
            self._kept[key] = find()
        return cast("T", self._kept[key])

    def own(self, key: object, find: Callable[[], T]) -> T:
        """What `find` gives, found once for each key and this object."""
        if key not in self._own:
            self._own[key] = find()
        return cast("T", self._own[key])
