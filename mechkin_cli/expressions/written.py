"""How a number that is written becomes one to compute with: as a double, or on a recording.

While a file is recorded with all its numbers, each digit string becomes a recorded number that
knows the decimal it says; else nothing of this is felt.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

Reader = Callable[[str], Any]
"""The number that digits (or the word `pi`) say."""

_READER: ContextVar[Reader | None] = ContextVar("reader of written numbers", default=None)


@contextmanager
def numbers_read_by(reader: Reader) -> Iterator[None]:
    """Numbers read in this context are what `reader` makes of their digits."""
    token = _READER.set(reader)
    try:
        yield
    finally:
        _READER.reset(token)


def read(value: float, digits: str) -> Any:
    """The number that digits say, whose double is `value`."""
    reader = _READER.get()
    return value if reader is None else reader(digits)
