"""What a plan is made of, as a list of calls: the constants may be recorded numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mechkin_cli.tape.scalars import is_number


class PlanImage:
    """Stands in for the kernel's plan while it is built.

    Attributes:
        constants: the numbers of the calls in the kernel's order.
        structure: everything else, call by call.
    """

    def __init__(self, length: float, origin: Any, size: float) -> None:
        self.constants: list[float] = []
        self.structure: list[tuple[Any, ...]] = []
        self._note("Plan", length, origin, size)

    def __getattr__(self, name: str) -> Any:
        if name.startswith(("add_", "set_")):
            return lambda *arguments: self._note(name, *arguments)
        raise AttributeError(name)

    def finish(self) -> None:
        """Nothing is left to be done."""

    def _note(self, name: str, *arguments: Any) -> int:
        entry: list[Any] = [name]
        for argument in arguments:
            numbers = list(_numbers(argument))
            self.constants += numbers
            entry.append(len(numbers) if numbers else argument)
        self.structure.append(tuple(entry))
        return len([call for call in self.structure if call[0] == name]) - 1


def _numbers(argument: Any) -> Iterator[float]:
    if is_number(argument):
        yield argument
    elif isinstance(argument, list | tuple) and argument and is_number(argument[0]):
        yield from argument
