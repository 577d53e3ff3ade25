"""What a caller gives, checked before anything runs: the kind that is meant, or what to write.

Every function names the argument in its error and shows what it was given.
"""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Mapping
from itertools import islice
from math import isfinite
from numbers import Real
from pathlib import Path

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tolerances import MOST_NAMES

Setting = str | float
"""A value of a parameter or an input: a number in the file's units, or a text."""

LONGEST_PATH = 4096
"""Characters of a path; no system takes more."""

SHOWN = 60
"""Characters of a value that a message repeats."""


def shown(value: object) -> str:
    """A value as messages repeat it: its repr, shortened; its type where it has none.

    >>> shown("O4.theta"), shown([1, 2])
    ("'O4.theta'", '[1, 2]')
    """
    try:
        text = repr(value)
    except Exception:
        # whatever a foreign object's repr raises
        return f"a {type(value).__name__}"
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 4]} ..."


def refusal(name: str, wanted: str, value: object) -> UsageError:
    """What an argument was expected to be, and what it is."""
    return UsageError(f"{name}: expected {wanted}, not {shown(value)} ({type(value).__name__})")


def a_text(name: str, value: object, example: str) -> str:
    """A text; `example` is one, as Python writes it.

    Raises:
        UsageError: it is none.
    """
    if not isinstance(value, str):
        raise refusal(name, f"a text such as {example}", value)
    return value


def texts(name: str, value: object, example: str) -> tuple[str, ...]:
    """Several texts, in their order; a single text is no list of its characters.

    Raises:
        UsageError: it is no iterable of texts, or one that does not end.
    """
    wanted = f"a list of texts such as {example}"
    if isinstance(value, str | bytes | Mapping) or not isinstance(value, Iterable):
        raise refusal(name, wanted, value)
    try:
        found = tuple(islice(value, MOST_NAMES + 1))
    except TypeError:  # as a numpy array of no dimension
        raise refusal(name, wanted, value) from None
    if len(found) > MOST_NAMES:
        raise UsageError(f"{name}: more than {MOST_NAMES} names; give a list of those that count")
    for i, item in enumerate(found):
        if not isinstance(item, str):
            raise refusal(f"{name}[{i}]", f"a text such as {example.strip('[]')}", item)
    return found


def a_path(
    name: str, value: object, wanted: str = 'the path of a mechanism file such as "rcsr.yaml"'
) -> Path:
    """The path of a file; `wanted` says of which, with an example.

    Raises:
        UsageError: it is none.
    """
    given = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(given, str) or "\0" in given or not 0 < len(given) <= LONGEST_PATH:
        raise refusal(name, wanted, value)
    return Path(given)


def a_whole_number(name: str, value: object, meaning: str, least: int | None = None) -> int:
    """A whole number from `least` on; `meaning` says what it stands for. Without `least` 0 leaves
    the number to mechkin.

    Raises:
        UsageError: it is none.
    """
    which = "0 to leave it to mechkin" if least is None else f"{least} or more"
    wanted = f"a whole number{' of ' * bool(meaning)}{meaning}, {which}"
    try:
        number = -1 if isinstance(value, bool) else operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        number = -1
    if number < (least or 0):
        raise refusal(name, wanted, value)
    return number


def a_setting(name: str, value: object) -> Setting:
    """A value of a parameter or an input: a finite number or a text.

    Raises:
        UsageError: it is neither.
    """
    if isinstance(value, str):
        return value
    wanted = 'a number in the file\'s units or a text with a unit such as "0.5 in"'
    if isinstance(value, bool) or not isinstance(value, Real):
        raise refusal(name, wanted, value)
    try:
        number = float(value)
    except OverflowError:
        number = float("inf")
    if not isfinite(number):
        raise refusal(name, f"{wanted} that is finite", value)
    return number


def settings(name: str, value: object, example: str) -> dict[str, Setting]:
    """Values by name.

    Raises:
        UsageError: it is no mapping of texts to values.
    """
    if not isinstance(value, Mapping):
        raise refusal(name, f"a mapping such as {example}", value)
    return {
        a_text(f"a key of {name}", key, example.strip("{}").partition(":")[0]): a_setting(
            f"{name}[{shown(key)}]", item
        )
        for key, item in value.items()
    }
