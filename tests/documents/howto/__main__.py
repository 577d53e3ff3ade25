"""Writes files and what commands print into the pages of docs/howto; names select some of them."""

from __future__ import annotations

import contextlib
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from documents.howto.pages import FENCE, PAGES, WHOLE, blocks, content, printed, saved


def written(page: str) -> str:
    """The page with the files and outputs as they are now; a block that shows a part of a file is
    left as it is."""
    found = iter(blocks(page))
    out = ""
    last = 0
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        saved(page, Path(folder))
        shown = ""
        for match in FENCE.finditer(page):
            block = next(found)
            text = block.text
            is_whole = not text or text.startswith(WHOLE) or block.language == "csv"
            if block.file is not None and is_whole:
                text = content(block.file)
            elif block.language == "sh":
                shown = printed(block.text)
            elif block.language == "text":
                text = shown
            out += page[last : match.start()] + f"```{block.language}\n{text}```"
            last = match.end()
    return out + page[last:]


if __name__ == "__main__":
    for path in PAGES:
        if not sys.argv[1:] or path.stem in sys.argv[1:]:
            path.write_text(written(path.read_text(encoding="utf-8")), encoding="utf-8")
