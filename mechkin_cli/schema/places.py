"""A place in the home drawing: its coordinates, or the name of a point that is drawn there."""

import re
from typing import Annotated, Any, Final, TypeVar

from mechkin_cli.schema.alternatives import Choice, Tag
from mechkin_cli.schema.rules import Named
from mechkin_cli.schema.scalars import NAME_PATTERN, LengthVector, Name

_NAME: Final = re.compile(NAME_PATTERN)


def name_or_vector(value: Any) -> str:
    """The form of a place: a name, or else coordinates."""
    is_name = isinstance(value, str) and _NAME.search(value.strip())
    return "(name)" if is_name else "(vector)"


_Vector = TypeVar("_Vector")
NamedOr = Annotated[
    Annotated[Name, Tag("(name)")] | Annotated[_Vector, Tag("(vector)")], Choice(name_or_vector)
]
"""The name of a point, or coordinates: of space or of a plane."""

NamedOrGiven = Annotated[NamedOr[LengthVector], Named("NamedOrGiven")]
