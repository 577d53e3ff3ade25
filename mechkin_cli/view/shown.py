"""What a page shows: runs, their branches, and what is read of an analysis."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from mechkin_cli.sweep import Readable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.building import Built, ViewSettings
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.modes import Modes
    from mechkin_cli.tables import Columns


class ShownAnalysis(Readable, Protocol):
    """An analysis whose model can be asked for the other assembly modes of its run."""

    @property
    def model(self) -> ShownModel:
        """Of the file."""
        ...


class ShownModel(Protocol):
    """What a page reads of a model."""

    @property
    def name(self) -> str:
        """The mechanism's name."""
        ...

    @property
    def built(self) -> Built:
        """The file, checked."""
        ...

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        ...

    @property
    def view_settings(self) -> ViewSettings:
        """How the file wants to be shown."""
        ...

    def modes(self, *, run: str | None = None) -> Modes:
        """All assembly modes at the first row of a run."""
        ...

    def analyze(self, *, tables: Sequence[str], mode: str) -> ShownAnalysis:
        """Runs the sweep in a mode."""
        ...

    def respond(self, name: str, *, tables: Sequence[str], mode: str) -> ShownAnalysis:
        """Runs a response in a mode."""
        ...


class ShownBranch(NamedTuple):
    """A run in one assembly mode; `forces`: whether arrows of forces may be read."""

    name: str
    analysis: Readable
    forces: bool = True


class ShownRun(NamedTuple):
    """A run of the file with its branches, the file's own one first, and its other tables."""

    name: str
    title: str
    branches: tuple[ShownBranch, ...]
    tables: tuple[Columns, ...] = ()
