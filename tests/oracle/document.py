"""A mechanism file as nested dictionaries and lists whose every scalar is text, and back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml
from yaml.cyaml import CEmitter
from yaml.representer import SafeRepresenter
from yaml.resolver import BaseResolver

Document = dict[str, Any]


class _TextDumper(CEmitter, SafeRepresenter, BaseResolver):
    """Writes every scalar as it stands, quoted only where YAML needs quotes."""

    def __init__(self, stream: Any, **options: Any) -> None:
        emitter = {k: options.get(k) for k in ("width", "allow_unicode")}
        CEmitter.__init__(self, stream, **emitter)
        SafeRepresenter.__init__(self, default_flow_style=None, sort_keys=False)
        BaseResolver.__init__(self)

    def ignore_aliases(self, data: Any) -> bool:
        return True


def document(source: str | Path | Document) -> Document:
    """Plain data of a file (a path), of the text of one, or a copy of plain data."""
    if isinstance(source, dict):
        source = to_text(source)
    elif isinstance(source, Path) or "\n" not in source:
        source = Path(source).read_text(encoding="utf-8")
    # the base loader keeps every scalar as text
    data: Document = yaml.load(source, Loader=yaml.CBaseLoader)
    return data


def to_text(data: Document) -> str:
    """The text of a file; leaf lists and mappings on one line."""
    text: str = yaml.dump(data, Dumper=_TextDumper, width=10_000)
    return text
