"""Where the efforts act that keep up the motion of the inputs: at these, or at actuators.

The motion is prescribed at the inputs. Without actuators each input has a drive of its own, unless
a tie moves it: then the motor of the input that it follows carries what the tie transmits.
Actuators do the virtual work of the inputs' generalised efforts: J^T t = Q, where J are the rates
of the actuators' coordinates by those of the inputs (docs/numerics.md, Actuators).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.nearest import SHORT_LIST

if TYPE_CHECKING:
    from mechkin_cli.mechanism.quantities import Wanted

Coordinate = tuple[str, str]
"""A joint and its coordinate."""


class Drives(NamedTuple):
    """The inputs, the actuators (none: the inputs' own drives), and ties (input, leader) by number
    of the inputs; a leader is tied to nothing, an input may be tied to several."""

    inputs: tuple[Coordinate, ...]
    actuators: tuple[Coordinate, ...] = ()
    ties: tuple[tuple[int, int], ...] = ()

    @property
    def acting(self) -> tuple[Coordinate, ...]:
        """Where efforts act."""
        return self.actuators or self.inputs

    @property
    def freedoms(self) -> int:
        """How many inputs move on their own."""
        return len(self.inputs) - len({tied for tied, _ in self.ties})

    @property
    def are_plain(self) -> bool:
        """Whether each input has a drive of its own."""
        return not self.actuators and not self.ties


def without_effort(
    name: str, quantities: Mapping[str, Wanted], drives: Drives | None, *, response: bool = False
) -> str | None:
    """Why nothing acts where `name` asks for an effort, where efforts act, and what to do; None for
    other names.

    Args:
        name: of a quantity that there is not, such as `B.effort` or `B.s.effort`.
        quantities: those that there are, by name.
        drives: of a sweep.
        response: whether the rows are those of a response, whose file gives the efforts.
    """
    owner, _, word = name.rpartition(".")
    if word != "effort":
        return None
    places = {
        wanted.name: wanted
        for wanted in quantities.values()
        if wanted.kind == "coordinate" and wanted.order == 0
    }
    here = [full for full, wanted in places.items() if owner in (full, wanted.owner)]
    efforts = {full: f"{full}.effort" for full in places if f"{full}.effort" in quantities}
    asked = [efforts[full] for full in here if full in efforts]
    if asked:
        return f"it has two efforts: ask for {' or '.join(asked)}"
    if not here:
        if all(wanted.owner != owner for wanted in quantities.values()):
            return None
        return f"{owner} has no coordinate: {_listed('efforts act at', efforts, quantities)}"
    at = " and ".join(here)
    if response:
        acting = _listed("efforts act at", efforts, quantities)
        return f"no effort acts at {at} in this response: {acting}, or name {at} under efforts"
    if drives is not None and drives.actuators:
        is_input = here[0] in (".".join(pair) for pair in drives.inputs)
        acting = _listed("actuators act at", efforts, quantities)
        what = f"the input {at}" if is_input else at
        return f"no effort acts at {what}: {acting}, or add {at} to actuators"
    what = "are not inputs" if len(here) > 1 else "is not an input"
    inputs = _listed("inputs are" if len(efforts) > 1 else "the input is", efforts, quantities)
    return f"{at} {what}: {inputs}, or drive {at}"


def _listed(words: str, efforts: Mapping[str, str], quantities: Mapping[str, Wanted]) -> str:
    """Where efforts act, and how the first of them is called."""
    if not efforts:
        return "there is no effort"
    first = next(iter(efforts))
    short = f"{quantities[efforts[first]].owner}.effort"
    ask = short if short in quantities else efforts[first]
    most = list(efforts)[:SHORT_LIST]
    more = f" and {len(efforts) - len(most)} more" if len(efforts) > len(most) else ""
    return f"{words} {', '.join(most)}{more}; ask for {ask}"
