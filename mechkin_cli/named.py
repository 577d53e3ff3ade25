"""Things with names in their order: a tuple that also gives them by name."""

from __future__ import annotations

from typing import Any, Generic, SupportsIndex, TypeVar, overload

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.nearest import nearest_hint

Item = TypeVar("Item")


class Named(tuple[Item, ...], Generic[Item]):
    """A tuple of things with a `name`: `tables[0]`, `tables["drive"]`, `"drive" in tables`."""

    __slots__ = ()

    def keys(self) -> list[str]:
        """The names, in order."""
        return [item.name for item in self]  # type: ignore[attr-defined]

    def __contains__(self, key: object) -> bool:
        return key in self.keys() if isinstance(key, str) else tuple.__contains__(self, key)

    @overload
    def __getitem__(self, key: SupportsIndex | str) -> Item: ...

    @overload
    def __getitem__(self, key: slice) -> tuple[Item, ...]: ...

    def __getitem__(self, key: Any) -> Any:
        """By number, slice or name.

        Raises:
            UsageError: nothing has this name, or neither number nor name.
            IndexError: there are not so many.
        """
        names = self.keys()
        if not isinstance(key, str):
            try:
                return tuple.__getitem__(self, key)
            except TypeError:
                text = f"a {type(key).__name__} is neither number nor name; see keys()"
                raise UsageError(text) from None
        if key in names:
            return tuple.__getitem__(self, names.index(key))
        hint = nearest_hint(key, names) or f"there are {len(names)}, see keys()"
        raise UsageError(f"there is no {key[:LONGEST_NAME]!r} here; {hint}")
