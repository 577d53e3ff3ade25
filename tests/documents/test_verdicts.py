"""What the page of verdicts says is what rows have and what the command prints."""

import re
from pathlib import Path

import pytest
from documents.reading import blocks, page
from references import RCSR

import mechkin_cli as mk
from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files
from mechkin_cli.tolerances import CONDITION_NEAR_SINGULAR
from mechkin_cli.verdict import Proof

VERDICTS = page("docs/verdicts.md")


def words_of(heading: str) -> list[str]:
    """The first cells of the table below a heading."""
    (section,) = re.findall(rf"^## {heading}\n(.*?)(?=^## |\Z)", VERDICTS, re.M | re.DOTALL)
    return re.findall(r"^\| `([a-z -]+)` \|", section, re.MULTILINE)


def test_statuses() -> None:
    assert words_of("Status of a row") == [status.label for status in mk.Status]


def test_proofs() -> None:
    assert words_of("Proofs") == [proof.label for proof in sorted(Proof, reverse=True)]


def test_the_limit_of_the_condition() -> None:
    (limit,) = re.findall(r"its condition is above (\S+):", VERDICTS)
    assert float(limit) == CONDITION_NEAR_SINGULAR


@pytest.mark.parametrize("line", ["errors", "proof"])
def test_the_lines_of_the_summary_are_those_of_the_command(
    line: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    analyze_files(
        AnalyzeCommand([RCSR], tmp_path, ["csv"], errors=line == "errors", certify=line == "proof")
    )
    (said,) = [x for x in capsys.readouterr().err.splitlines() if x.startswith(f"  {line}")]
    assert said + "\n" in blocks(VERDICTS, "text")
