"""Where the efforts act that keep up the motion of the inputs: at these, or at actuators.

The motion is prescribed at the inputs. Without actuators each input has a drive of its own, unless
a tie moves it: then the motor of the input that it follows carries what the tie transmits.
Actuators do the virtual work of the inputs' generalised efforts: J^T t = Q, where J are the rates
of the actuators' coordinates by those of the inputs (docs/numerics.md, Actuators).
"""

from __future__ import annotations

from typing import NamedTuple

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


def without_effort(drives: Drives | None, name: str) -> str | None:
    """What to do where `name` asks for the effort of an input at which none acts; None for other
    names.

    >>> words = without_effort(Drives((("A", "theta"),), (("B", "s"),)), "A.effort")
    >>> print(words.partition(": ")[0])
    no effort acts at the input A.theta
    """
    owner, _, word = name.rpartition(".")
    if drives is None or word != "effort" or not drives.actuators:
        return None
    acting = [".".join(pair) for pair in drives.actuators]
    joints = [joint for joint, _ in drives.actuators]
    first = joints[0] if joints.count(joints[0]) == 1 else acting[0]
    for joint, coordinate in drives.inputs:
        full = f"{joint}.{coordinate}"
        if owner in (joint, full):
            return (
                f"no effort acts at the input {full}: actuators act at {', '.join(acting)}; "
                f"ask for {first}.effort, or add {full} to actuators"
            )
    return None
