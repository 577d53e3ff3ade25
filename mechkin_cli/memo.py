"""Remembering what has been computed for a frozen value, by the arguments of the question.

A value that is derived from another by `dataclasses.replace` starts with an empty memo, so nothing
that was computed under one choice can be taken for the answer under another.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar, cast

import numpy as np

Memo = dict[object, Any]
"""Answers by the function that gave them and its arguments."""


class Remembers(Protocol):
    """A frozen value with a memo of its own: `field(default_factory=dict, init=False)`."""

    @property
    def memo(self) -> Memo:
        """What has been computed for this value."""


Owner = TypeVar("Owner", bound=Remembers)
Arguments = ParamSpec("Arguments")
Answer = TypeVar("Answer")


def remembered(
    function: Callable[Concatenate[Owner, Arguments], Answer],
) -> Callable[Concatenate[Owner, Arguments], Answer]:
    """Computes a function of a frozen value once for each value and other arguments.

    Arguments must be hashable, or arrays. What raises is not remembered. Two threads that ask at
    the same time may both compute; they find the same.
    """

    @wraps(function)
    def recall(owner: Owner, /, *args: Arguments.args, **named: Arguments.kwargs) -> Answer:
        key: object = function
        if named:
            by_name = [(k, _hashable(named[k])) for k in sorted(named)]
            key = (function, *map(_hashable, args), *by_name)
        elif args:
            key = (function, *args)
        memo = owner.memo
        try:
            found = memo.get(key, memo)  # which is no answer of its own
        except TypeError:  # an array
            if named:
                raise
            key = (function, *map(_hashable, args))
            found = memo.get(key, memo)
        if found is memo:
            found = memo[key] = function(owner, *args, **named)
        answer: Answer = found
        return answer

    return cast("Callable[Concatenate[Owner, Arguments], Answer]", recall)


def _hashable(argument: object) -> object:
    if isinstance(argument, np.ndarray):
        return argument.shape, argument.dtype.str, argument.tobytes()
    return argument
