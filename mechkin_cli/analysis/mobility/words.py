"""Mobility in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mechkin_cli.analysis.mobility.mobility import Mobility


def verdict(found: Mobility) -> str:
    """What count and truth say together, in one sentence."""
    if found.mobility is None:
        return f"mobility unclear; the count says {found.count}"
    return f"{_moves(found)}; {_compared(found)}"


def freedoms(number: int) -> str:
    """A number of freedoms in words.

    >>> freedoms(1), freedoms(2)
    ('one freedom', '2 freedoms')
    """
    return "one freedom" if number == 1 else f"{number} freedoms"


def meeting(dimensions: tuple[int, ...]) -> str:
    """Dimensions of components that meet, the least first."""
    return " and ".join(str(number) for number in sorted(dimensions))


def _moves(found: Mobility) -> str:
    if not found.mobility:
        text = "nothing can move"
        return f"{text} but to first order" if found.first_order else text
    if len(found.dimensions) > 1:
        text = f"motions of {meeting(found.dimensions)} freedoms meet"
    else:
        text = freedoms(found.mobility)
    if found.first_order != found.mobility:
        text += f" ({found.first_order} to first order)"
    return text + (f", {len(found.idle)} of them idle" if found.idle else "")


def _compared(found: Mobility) -> str:
    redundant = sum(item.number for item in found.redundant)
    if not redundant:
        same = found.mobility == found.count
        return "as Kutzbach's count says" if same else f"Kutzbach's count is {found.count}"
    if not found.mobility:
        return f"Kutzbach's count is {found.count}"
    constraints = "one constraint is" if redundant == 1 else f"{redundant} constraints are"
    return (
        f"Kutzbach's count is {found.count}: {constraints} redundant, so it moves only while the "
        "dimensions are exact"
    )
