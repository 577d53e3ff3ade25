"""A mechanism file that is measured."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.model import Model


class Subject(NamedTuple):
    """Its name in tables, the model of it, and its file, or the text of one that is known."""

    name: str
    model: Model
    source: Path | str

    @contextmanager
    def on_disk(self) -> Iterator[Path]:
        """The file, as long as it is needed."""
        if isinstance(self.source, Path):
            yield self.source.resolve()
            return
        with TemporaryDirectory(prefix="mechkin-bench-") as folder:
            file = Path(folder) / "mechanism.yaml"
            file.write_text(self.source, encoding="utf-8")
            yield file
