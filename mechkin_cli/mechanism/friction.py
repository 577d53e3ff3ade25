"""Coulomb friction of joints: of each pair what rubs, and what its contacts carry.

One friction force, the coefficient times the normal load of the joint, acts against the velocity of
the surfaces, which is made of slides and of turns by a radius. The normal load is a weighted sum of
magnitudes that are linear in the joint's force F and moment M about its point (docs/friction.md).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Literal, NamedTuple

from mechkin_cli.mechanism.vectors import ZERO, Vector, cross
from mechkin_cli.tape.scalars import cos, square_root

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Place
    from mechkin_cli.mechanism.model import Attached

Motion = Literal["along", "square", "all"]
"""Along (about) the joint's axis, square to it, or in every direction."""


class Rubbing(NamedTuple):
    """The friction of a joint in SI.

    `at_rest`, `sliding`: coefficients; `speed`: from one to the other, None where the coefficient
    falls at once. The lengths are None where they are not given; `across`: the direction of the
    width; `flank`: half the angle of the thread; `place`: where the file says it.
    """

    joint: str
    at_rest: float
    sliding: float
    speed: float | None = None
    radius: float | None = None
    length: float | None = None
    collar: float | None = None
    width: float | None = None
    flank: float | None = None
    across: Attached | None = None
    place: Place | None = None


class Contact(NamedTuple):
    """A magnitude in the normal load, `weight` times (z: the joint's axis, F_r = F - (z.F) z)

    - radial: |share F_r + tilt M x z|,
    - along: |share u.F + tilt u.(M x z) + roll z.M|, u: the direction, as drawn,
    - total: share |F|.
    """

    kind: Literal["radial", "along", "total"]
    weight: float = 1.0
    share: float = 0.0
    tilt: float = 0.0
    roll: float = 0.0
    direction: Vector = ZERO


Contacts = Callable[[Rubbing, Vector, float], Iterator[Contact]]
"""The contacts of a friction at a joint with an axis as drawn and a pitch (m per rad)."""


class FrictionLaw(NamedTuple):
    """How a pair rubs: in which of its turns and slides, by which contacts, from which keys.

    `needs` are keys that must be given; `missed`: what is not counted without a key.
    """

    contacts: Contacts
    turns: Motion | None = None
    slides: Motion | None = None
    needs: tuple[str, ...] = ()
    may: tuple[str, ...] = ()
    missed: tuple[tuple[str, Literal["tilting moment", "axial force", "moment about it"]], ...] = ()


def _bearings(rubbing: Rubbing) -> tuple[tuple[float, float], ...]:
    """Share and tilt of the bearings along an axis: one, or two `length` apart."""
    if rubbing.length is None:
        return ((1.0, 0.0),)
    return (0.5, 1.0 / rubbing.length), (0.5, -1.0 / rubbing.length)


def journal(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """Bearings that take radial force and tilting moment, and a collar for the axial force."""
    for share, tilt in _bearings(rubbing):
        yield Contact("radial", 1.0, share, tilt)
    if rubbing.collar is not None:
        assert rubbing.radius is not None
        yield Contact("along", rubbing.collar / rubbing.radius, 1.0, direction=axis)


def guide(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """Shoes at both ends of a length, on both sides of a width.

    With `across` each shoe has a face along the width and one square to it; without, it takes its
    part of force and tilting moment as one vector, and its part of the moment about the axis in
    full.
    """
    width, across = rubbing.width, rubbing.across
    for share, tilt in _bearings(rubbing):
        if across is None or width is None:
            yield Contact("radial", 1.0, share, tilt)
            continue
        yield Contact("along", 1.0, share, tilt, direction=across.vector)
        up = cross(axis, across.vector)
        for side in (1.0, -1.0):
            roll = side * share / width
            yield Contact("along", 1.0, 0.5 * share, 0.5 * tilt, roll, up)
    if across is None and width is not None:
        yield Contact("along", 2.0 / width, roll=1.0)


def thread(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """The flanks of a thread, by the force square to the helix on the mean cylinder."""
    radius = rubbing.radius
    assert radius is not None
    turn = square_root(radius * radius + pitch * pitch)
    flank = 1.0 if rubbing.flank is None else cos(rubbing.flank)
    yield Contact(
        "along", 1.0 / flank, radius / turn, roll=-pitch / (turn * radius), direction=axis
    )


def ball(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """A sphere in its socket."""
    yield Contact("total", 1.0, 1.0)


def plane(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """A sphere on a plane."""
    yield Contact("along", 1.0, 1.0, direction=axis)


def groove(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """A sphere in a groove."""
    yield Contact("radial", 1.0, 1.0)
