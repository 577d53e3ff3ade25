"""How a model is copied and pickled, and how it shows itself."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mechkin_cli.listing import Listed, Listing

if TYPE_CHECKING:
    from pathlib import Path

    from mechkin_cli.building.build import Built
    from mechkin_cli.interface.model import Model
    from mechkin_cli.named import Named
    from mechkin_cli.tables.layout import TableLayout


class Kept(Listed):
    """What a model is kept as: the text, or the data, that it was read from."""

    built: Built
    stem: str

    @property
    def tables(self) -> Named[TableLayout]:
        """Layouts of the file's tables."""
        raise NotImplementedError

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied as the text of the file and of the tables that it names."""
        document = self.built.read.document
        given = (document.text, document.file, dict(document.overrides), document.folder)
        return _rebuilt, (*given, self.stem, document.is_data, dict(document.tables))

    @property
    def listing(self) -> Listing:
        """Links, joints, inputs and tables; nothing is solved for it."""
        mechanism = self.built.problem.mechanism
        joints = tuple(
            (
                joint.name,
                joint.letter,
                ", ".join(f"{joint.name}.{c}" for c in joint.type.coordinates),
            )
            for joint in mechanism.joints.values()
        )
        inputs = ", ".join(driven.name for driven in self.built.problem.motion.inputs)
        found = {
            "loops": str(mechanism.loops),
            "inputs": inputs or "none",
            "runs": ", ".join(self.built.runs),
            "tables": ", ".join(table.name for table in self.tables),
        }
        notes = tuple(f"{name}: {text}" for name, text in found.items() if text)
        return Listing(
            f"Model of {mechanism.name}", ("joint", "type", "coordinates"), joints, notes
        )


def _rebuilt(
    text: str,
    file: str,
    overrides: Mapping[str, str],
    folder: Path | None,
    stem: str,
    is_data: bool,
    tables: Mapping[str, bytes],
) -> Model:
    """A model of the text that another had, or of the data that its text was made from."""
    from mechkin_cli.building.build import build
    from mechkin_cli.building.source import open_data, open_text
    from mechkin_cli.interface.model import Model

    if is_data:
        import json

        return Model(build(open_data(json.loads(text), file, overrides, folder, tables)), stem)
    return Model(build(open_text(text, file, overrides, folder, tables)), stem)
