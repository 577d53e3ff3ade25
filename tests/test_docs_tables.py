"""A file in the docs with what is printed of it: the text behind it is what mechkin prints."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from references import RCSR

DOCS = RCSR.parents[2] / "docs"
# a block ends at its own fence: else two blocks would be one, with the words between them
BLOCK = r"((?:(?!```).*\n)*)```"
SHOWN = re.compile(rf"^```yaml\n{BLOCK}\n\n```text\n{BLOCK}$", re.MULTILINE)
EXAMPLES = [
    (page.name, file, text)
    for page in sorted(DOCS.glob("*.md"))
    for file, text in SHOWN.findall(page.read_text(encoding="utf-8"))
]

ENDS = {"verdicts.md": 4}
"""Exit codes of pages whose example has rows without a position; the others end with 0."""


@pytest.mark.parametrize(("page", "file", "text"), EXAMPLES, ids=[page for page, *_ in EXAMPLES])
def test_the_text_is_what_is_printed(page: str, file: str, text: str, tmp_path: Path) -> None:
    (tmp_path / "file.yaml").write_text(file, encoding="utf-8")
    command = [sys.executable, "-m", "mechkin_cli", "analyze", "file.yaml"]
    run = subprocess.run(
        command, cwd=tmp_path, env={"COLUMNS": "80"}, capture_output=True, text=True
    )
    assert run.returncode == ENDS.get(page, 0), run.stderr
    assert run.stdout.strip() == text.strip()


def test_there_are_examples() -> None:
    assert "summaries.md" in [page for page, *_ in EXAMPLES]
