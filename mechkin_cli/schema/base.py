"""What all sections share: frozen, no unknown keys; and how a rule of ours refuses a value.

Modules with models evaluate their annotations at once: as texts, pydantic would compile each of
them again, on the way of every run.
"""

from typing import Any, ClassVar

from pydantic import BaseModel, ConfigDict
from pydantic_core import PydanticCustomError


class Section(BaseModel):
    """A mapping of the file with fixed keys.

    The text below a field is its help text. `advice` answers keys that people are likely to try and
    that the format does not have.
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        defer_build=True,
    )
    advice: ClassVar[dict[str, str]] = {}


def refuse(code: str, message: str, hint: str | None = None, *at: str | int) -> PydanticCustomError:
    """The error that a validator raises.

    `at` leads from the validated value to the key or item in it that is wrong.
    """
    context: dict[str, Any] = {"text": message, "hint": hint, "at": at}
    return PydanticCustomError(code, "{text}", context)
