"""`Model.view`: the page of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

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

    def view(
        self,
        path: str | PathLike[str],
        *,
        run: str | None = None,
        mode: str | None = None,
        modes: bool = True,
    ) -> Path:
        """Writes a page that shows the mechanism in motion, with curves, tables and notes: one file
        of HTML that needs nothing else.

        Args:
            path: of the page.
            run: `sweep` or a response alone; None: all runs of the file.
            mode: assembly mode at the first row instead of the file's choice.
            modes: show the other assembly modes, too.

        Returns:
            The path of the page, which is written whole or not at all.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
            UsageError: an unknown run or mode, or the page cannot be written there.

        Example:
            >>> from tempfile import TemporaryDirectory
            >>> from mechkin_cli import load
            >>> with TemporaryDirectory() as folder:
            ...     load("mechanisms/rcsr.yaml").view(f"{folder}/rcsr.html").name
            'rcsr.html'
        """
        from mechkin_cli.interface.model import Model
        from mechkin_cli.interface.viewing import analyses_of, view_page, write_view

        assert isinstance(self, Model)
        return write_view(path, view_page(analyses_of(self, run, mode), modes)[0])
