"""What a plain analysis loads: start-up time is a property of the product."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import pytest
from references import RCSR

from mechkin_cli.cli.commands import COMMANDS as PARSED

ANALYSIS = """
import json, sys
import mechkin_cli as mk
analysis = mk.load(sys.argv[1]).analyze()
assert analysis.rows > 1 and analysis.tables
print(json.dumps(sorted(sys.modules)))
"""
PACKAGE = """
import json, sys
import mechkin_cli
print(json.dumps(sorted(sys.modules)))
"""


COMMAND = """
import json, sys
from mechkin_cli.__main__ import main
sys.argv = ["mechkin", "analyze", sys.argv[1], "--quiet", "--out", sys.argv[2]]
try:
    main()
except SystemExit as ended:
    assert not ended.code
print(json.dumps(sorted(sys.modules)))
"""


LINE = """
import io, json, sys
from mechkin_cli.__main__ import main
place = {"FILE": sys.argv[1], "DIR": sys.argv[2]}
sys.argv = ["mechkin", *(place.get(word, word) for word in sys.argv[3:])]
stdout, sys.stdout = sys.stdout, io.StringIO()
try:
    main()
except SystemExit as ended:
    assert not ended.code
print(json.dumps(sorted(sys.modules)), file=stdout)
"""
COMMANDS = [
    ["check", "FILE"],
    ["mobility", "FILE"],
    ["modes", "FILE"],
    ["ranges", "FILE"],
    ["tables", "FILE", "--check"],
    ["view", "FILE", "--out", "DIR/view.html"],
    ["analyze", "FILE", "--out", "DIR"],
    ["analyze", "FILE", "--out", "DIR", "--quiet"],
]
HEAVY = {"typer", "click", "rich", "pydantic", "pydantic_core", "scipy"}


@cache
def modules_of(script: str, *arguments: str) -> frozenset[str]:
    command = [sys.executable, "-P", "-c", script, str(RCSR), *arguments]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return frozenset(json.loads(done.stdout))


def loaded_by(script: str) -> set[str]:
    return {name.split(".")[0] for name in modules_of(script)}


@pytest.mark.parametrize(
    "library", ["scipy", "rich", "typer", "mpmath", "matplotlib", "pandas", "pydantic_core"]
)
def test_an_analysis_does_without(library: str) -> None:
    assert library not in loaded_by(ANALYSIS)


@pytest.mark.parametrize("library", ["numpy", "pydantic", "yaml", "scipy", "rich", "typer"])
def test_the_package_itself_loads_nothing(library: str) -> None:
    assert library not in loaded_by(PACKAGE)


@pytest.mark.parametrize("library", ["numpy", "yaml"])
def test_what_an_analysis_needs_is_seen_by_this_test(library: str) -> None:
    assert library in loaded_by(ANALYSIS)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("tables")


@pytest.mark.parametrize(
    ("module", "needed_by"),
    [
        ("analysis.stream", "runs in blocks"),
        ("response.result", "responses"),
        ("response.runs", "responses"),
        ("statics.rest", "coordinates at rest"),
        ("balances.runs", "balances"),
        ("mobility.families", "drawings that are singular as driven"),
        ("mobility.configurations", "mobility"),
        ("proofs.rows", "proofs"),
        ("tables.json", "JSON"),
        ("tables.summary", "summaries"),
        ("fit.result", "fits"),
        ("sensitivities.first_order", "sensitivities"),
        ("studies.study", "studies"),
        ("view.page", "the page of a view"),
    ],
)
def test_a_sweep_leaves_out_what_its_file_does_not_ask_for(
    module: str, needed_by: str, written: Path
) -> None:
    assert f"mechkin_cli.{module}" not in modules_of(COMMAND, str(written)), needed_by
    assert find_spec(f"mechkin_cli.{module}") is not None  # the name is that of a module


@pytest.mark.parametrize("library", ["threading", "csv"])
def test_a_command_does_without(library: str, written: Path) -> None:
    """Without threads the process is ended at once, and its memory is not taken apart."""
    assert library not in modules_of(COMMAND, str(written))


def test_what_writes_tables_is_seen_by_this_test(written: Path) -> None:
    assert "mechkin_cli.tables.csv" in modules_of(COMMAND, str(written))


def loaded_by_line(folder: Path, *words: str, **environment: str) -> set[str]:
    command = [sys.executable, "-P", "-c", LINE, str(RCSR), str(folder)]
    done = subprocess.run(
        [*command, *(word.replace("DIR/", f"{folder}/") for word in words)],
        check=True,
        capture_output=True,
        text=True,
        env=os.environ | environment,
    )
    names = {name.split(".")[0] for name in json.loads(done.stdout)}
    assert "mechkin_cli" in names
    return names


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_commands_load_neither_typer_nor_pydantic(words: list[str], tmp_path: Path) -> None:
    assert not HEAVY & loaded_by_line(tmp_path, *words)


def test_the_version_loads_no_library(tmp_path: Path) -> None:
    assert not (HEAVY | {"numpy", "yaml"}) & loaded_by_line(tmp_path, "--version")


@pytest.mark.parametrize("words", [[], *([name] for name in sorted(PARSED))], ids=str)
def test_help_loads_no_numpy(words: list[str], tmp_path: Path) -> None:
    assert "numpy" not in loaded_by_line(tmp_path, *words, "--help")


@pytest.mark.parametrize(
    "line",
    [
        "mechkin an",
        "mechkin analyze a",
        "mechkin analyze FILE --table ",
        "mechkin analyze FILE --set ",
        "mechkin analyze FILE --format ",
        "mechkin ranges FILE --input ",
        "mechkin view FILE --run ",
        "mechkin study a.yaml --format ",
    ],
)
def test_completion_loads_no_numpy(line: str, tmp_path: Path) -> None:
    line = line.replace("FILE", str(RCSR))
    words = {"COMP_WORDS": line, "COMP_CWORD": str(len(line.split(" ")) - 1)}
    loaded = loaded_by_line(tmp_path, _MECHKIN_COMPLETE="complete_bash", **words)
    assert "typer" in loaded
    assert "numpy" not in loaded
