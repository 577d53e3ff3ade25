"""`actuators:` - the coordinates at which efforts act, when not at the inputs; and `drive: tie`."""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.building.coordinates import CODE, is_coordinate_at
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.drives import Drives
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.motion import Motion
from mechkin_cli.schema.motion import FollowingInput, MotionSection

EFFORT = "effort"


def build_drives(
    fields: Fields,
    names: tuple[str, ...],
    section: MotionSection | None,
    joints: Mapping[str, Joint],
    motion: Motion,
) -> Drives:
    """Where efforts act; what is wrong is noted in `fields`."""
    errors = fields.error_count
    actuators = tuple(
        (joint, coordinate)
        for number, name in enumerate(names)
        if _is_actuator(fields, ("actuators", number), name, joints, names[:number])
        for joint, _, coordinate in (name.rpartition("."),)
    )
    drives = Drives(tuple(motion.driven), actuators, motion.tied)
    if fields.error_count == errors and names:
        _check_count(fields, drives, section)
    if fields.error_count > errors:
        # nothing is said of the efforts that follow from what is wrong here
        for joint in joints.values():
            fields.refused.update(f"{n}.{EFFORT}" for n in (joint.name, *joint.coordinates))
        return Drives(tuple(motion.driven), (), motion.tied)
    return drives


def _is_actuator(
    fields: Fields,
    path: Path,
    name: str,
    joints: Mapping[str, Joint],
    before: tuple[str, ...],
) -> bool:
    if not is_coordinate_at(fields, path, name, joints):
        return False
    if name in before:
        fields.error("actuator-twice", path, f"{name} is an actuator already", "name it once")
        return False
    joint = joints[name.rpartition(".")[0]]
    if not joint.carries:
        text = f"{joint.name} is no joint of the machine and carries no effort"
        fields.error(CODE, path, text, "name coordinates of joints between its links")
        return False
    return True


def _check_count(fields: Fields, drives: Drives, section: MotionSection | None) -> None:
    """At least as many actuators as freedoms; more share the load."""
    count, freedoms = len(drives.actuators), drives.freedoms
    names = ", ".join(".".join(pair) for pair in drives.inputs)
    if not freedoms:
        if section is None or not section.inputs:
            text = "without inputs nothing moves that actuators could drive"
            fields.error("too-few-actuators", ("actuators",), text, "add inputs under motion")
        return
    if count < freedoms:
        fields.error(
            "too-few-actuators",
            ("actuators",),
            f"{count} actuator{'s cannot' if count > 1 else ' cannot'} carry the efforts of "
            f"{freedoms} inputs that move on their own: {names}",
            "name as many coordinates as inputs, or tie inputs to others ({with: ..., drive: tie})",
            measured=str(count),
            limit=f"at least {freedoms}",
        )
    elif count > freedoms:
        more = count - freedoms
        place = fields.document.place(("actuators",))
        text = (
            f"there {'is one actuator' if more == 1 else f'are {more} actuators'} more than "
            f"freedoms ({count} for {freedoms}): of the efforts that keep up the motion these are "
            "the ones of least sum of squares, moments taken by the size of the mechanism"
        )
        hint = f"name {freedoms} coordinates for efforts that nothing else could be"
        fields.note(Diagnostic("shared-effort", "note", text, place, hint=hint))


def note_own_motors(fields: Fields, section: MotionSection | None, names: tuple[str, ...]) -> None:
    """Says of inputs that follow others, where the file does not, that each has its own motor."""
    if section is None or names:
        return
    own = [
        name
        for name, item in section.inputs.items()
        if isinstance(item, FollowingInput) and item.drive is None
    ]
    if not own:
        return
    place = fields.document.key_place(("motion", "inputs", own[0]))
    text = f"{', '.join(own)} {'has a motor' if len(own) == 1 else 'have motors'} of "
    text += "its own" if len(own) == 1 else "their own"
    hint = "write drive: tie where the motor of the input that it follows moves it, else drive: own"
    fields.note(Diagnostic("own-motor", "note", text, place, hint=hint))
