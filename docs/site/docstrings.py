"""Docstrings as mkdocstrings expects them: a section `Example:` becomes one of `Examples:`."""

from __future__ import annotations

from typing import Any

import griffe


class Examples(griffe.Extension):
    """Renames the section in all docstrings."""

    def on_instance(self, *, obj: griffe.Object, **_: Any) -> None:
        """Called once for each object that was read."""
        if obj.docstring is not None:
            lines = obj.docstring.value.splitlines()
            renamed = ["Examples:" if line == "Example:" else line for line in lines]
            obj.docstring.value = "\n".join(renamed)
