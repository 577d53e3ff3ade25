"""A room's door: its public names, each loaded from its chapter when it is first used.

A door says its names once, in `lazy_names`; type checkers get the chapters whole, or by name where
two chapters have different things of one name.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # every command waits for what the package itself loads
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import Any


def lazy_names(
    room: str, chapters: Mapping[str, str | Sequence[str]]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Gives a room's `__getattr__` and `__dir__`.

    Args:
        room: the dotted name of the room's package.
        chapters: the names that each module of the room offers to other rooms, as a list or as a
            text with spaces between them.
    """
    homes = {
        name: chapter
        for chapter, names in chapters.items()
        for name in (names.split() if isinstance(names, str) else names)
    }

    def load(name: str) -> Any:
        chapter = homes.get(name)
        if chapter is None:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        from importlib import import_module

        value = getattr(import_module(f"{room}.{chapter}"), name)
        setattr(sys.modules[room], name, value)
        return value

    def names() -> list[str]:
        return sorted(homes)

    return load, names
