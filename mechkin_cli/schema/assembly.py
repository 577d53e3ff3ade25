"""`assembly:` - which way of assembling the mechanism is meant at the first row."""

from typing import Annotated, Self

from pydantic import ConfigDict, Field, model_validator

from mechkin_cli.schema.base import Section, refuse
from mechkin_cli.schema.scalars import AngleOrLength, Coordinate, Text, WholeNumber


class AssemblySection(Section):
    """The mode followed; left out, an assembled home drawing, else the mode nearest to it."""

    model_config = ConfigDict(json_schema_extra={"not": {"required": ["near", "mode"]}})

    near: dict[Coordinate, AngleOrLength] = Field(default_factory=dict)
    """Take the mode nearest to these coordinates, for example {O4.theta: 37}."""
    mode: Text | None = None
    """Take the mode of this letter, as `mechkin modes` names it."""
    turns: Annotated[WholeNumber, Field(ge=0, le=1000)] = 1
    """Turns of helical joints to either side within which modes are looked for."""

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.near and self.mode is not None:
            text = "near and mode both choose the assembly mode"
            raise refuse("two-choices", text, "keep one of them", "mode")
        return self
