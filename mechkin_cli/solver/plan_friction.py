"""The friction of joints as records of the kernel's plan, lengths in the kernel's unit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from mechkin_cli.mechanism.model import Attached
from mechkin_cli.solver.codes import ContactCode, FreeCode
from mechkin_cli.solver.records import Contact, Friction

if TYPE_CHECKING:
    from mechkin_cli.mechanism.friction import Motion, Rubbing
    from mechkin_cli.solver.layout import Layout

NO_MOTION = -1
"""Stands for turns or slides that do not rub."""


def friction_records(layout: Layout) -> Iterator[Friction | Contact]:
    """Each friction, followed by its contacts."""
    for rubbing in layout.mechanism.frictions:
        yield from _records(layout, rubbing)


def _records(layout: Layout, rubbing: Rubbing) -> Iterator[Friction | Contact]:
    joint, unit = layout.mechanism.joints[rubbing.joint], layout.length
    law, axis = joint.type.friction, joint.axis
    assert law is not None
    yield Friction(
        layout.place_number[joint.name],
        _code(law.turns),
        _code(law.slides),
        layout.link_number[axis.link],
        rubbing.speed is not None,
        layout.vector(axis),
        0.0 if rubbing.radius is None else rubbing.radius / unit,
        joint.pitch / unit,
        rubbing.at_rest,
        rubbing.sliding,
        1.0 if rubbing.speed is None else rubbing.speed / unit,
    )
    for contact in law.contacts(rubbing, axis.vector, joint.pitch):
        yield Contact(
            ContactCode[contact.kind.upper()],
            # a couple goes with one length more than a force
            contact.weight,
            contact.share,
            contact.tilt * unit,
            contact.roll * unit,
            layout.vector(Attached(axis.link, contact.direction)),
        )


def _code(motion: Motion | None) -> int:
    return NO_MOTION if motion is None else FreeCode[motion.upper()]
