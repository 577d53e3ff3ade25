"""How a model wants to be shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from mechkin_cli.building.build import Built
    from mechkin_cli.view.settings import ViewSettings


class Described(Protocol):
    """What is built of a file."""

    @property
    def built(self) -> Built:
        """The file, checked."""
        ...


class Viewed:
    """The page of a model."""

    @property
    def view_settings(self: Described) -> ViewSettings:
        """How the file wants to be shown (`view:`), in SI."""
        if self.built.view is not None:
            return self.built.view
        from mechkin_cli.view.settings import ViewSettings

        return ViewSettings()
