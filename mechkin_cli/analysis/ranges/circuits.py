"""Which modes belong to one circuit, and where that is not known."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.diagnostics import Diagnostic

if TYPE_CHECKING:
    from collections.abc import Sequence


class Circuit(NamedTuple):
    """Modes that are reached from one another, and whether others may be reached, too: no walk
    through them came to all of its ends."""

    modes: frozenset[str]
    is_open: bool

    @property
    def shown(self) -> tuple[str, ...]:
        """The modes in the order of their letters."""
        return tuple(sorted(self.modes, key=lambda name: (len(name), name)))


def joined(circuits: Sequence[Circuit]) -> list[Circuit]:
    """Circuits that share a mode with the last are one with it: a walk may end early on one side of
    a narrow place and get through from the other, and one that came to all ends knows them all."""
    *before, last = circuits
    apart = [one for one in before if not one.modes & last.modes]
    same = [last, *(one for one in before if one.modes & last.modes)]
    modes = frozenset().union(*(one.modes for one in same))
    return [*apart, Circuit(modes, all(one.is_open for one in same))]


def undecided(circuits: Sequence[Circuit], name: str) -> list[Diagnostic]:
    """That circuits may be one: those of which no walk came to all ends; a closed one has no part
    in the others."""
    numbers = [str(number) for number, one in enumerate(circuits, 1) if one.is_open]
    if len(numbers) < 2:
        return []
    *first, last = numbers
    text = (
        f"whether circuits {', '.join(first)} and {last} are one is not known: moving {name}, a "
        "branch of each could not be followed to its end"
    )
    hint = "begin at another value of it"
    return [Diagnostic("circuits-undecided", "warning", text, hint=hint)]
