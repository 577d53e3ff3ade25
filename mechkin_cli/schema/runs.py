"""The runs of a file by name: the sweep of `motion:`, and each of `responses:`."""

import re
from typing import Annotated, Any, Final

from mechkin_cli.runs import SWEEP
from mechkin_cli.schema.base import refuse
from mechkin_cli.schema.rules import After, Limits, Named, Shown
from mechkin_cli.schema.scalars import NAME_PATTERN

DEVICE: Final = re.compile("con|prn|aux|nul|com[0-9]|lpt[0-9]", re.IGNORECASE)
"""Names that are devices on Windows, whatever follows them behind a point."""

# JSON Schema has no flag for ignoring case
TAKEN_FOR_EDITORS: Final = (
    "^([Ss][Ww][Ee][Ee][Pp]|[Cc][Oo][Nn]|[Pp][Rr][Nn]|[Aa][Uu][Xx]|[Nn][Uu][Ll]|[Cc][Oo][Mm][0-9]"
    "|[Ll][Pp][Tt][0-9]|.{101,})$"
)

RunName = Annotated[
    str,
    Limits(pattern=NAME_PATTERN),
    Shown(("string",), "a run: sweep, or the name of a response", ("sweep", "start_up")),
    Named("RunName"),
]


def _with_a_run(names: tuple[str, ...]) -> tuple[str, ...]:
    for index, name in enumerate(names):
        if name in names[:index]:
            raise refuse("named-twice", f"the run {name} is named twice", "name it once", index)
    return names


RunNames = Annotated[tuple[RunName, ...], Limits(min_length=1), After(_with_a_run)]


def free_run_names(responses: dict[str, Any]) -> dict[str, Any]:
    """The responses, if each can have its name: files are called after them."""
    seen: dict[str, str] = {}
    for name in responses:
        twin = seen.setdefault(name.casefold(), name)
        code = "reserved-name"
        if name.casefold() == SWEEP:
            text = "sweep is the run along the inputs of motion:"
        elif DEVICE.fullmatch(name):
            text = f"{name} is a device on Windows, no file"
        elif len(name) > MOST_LETTERS:
            text = f"a name of {len(name)} letters is too long for a file (limit {MOST_LETTERS})"
        elif twin != name:
            code = "name-clash"
            text = f"files of {twin} and {name} would be the same where case does not count"
        else:
            continue
        raise refuse(code, text, "rename it", name, "[key]")
    return responses


MOST_LETTERS: Final = 100
"""Letters of a run's name, as of a table's."""
