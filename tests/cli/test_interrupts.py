"""Ctrl-C while modules are loaded: one line, exit code 130, whatever is being imported."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from cli import files

PROGRAM = """
import os, signal, sys

class Interrupting:
    def __init__(self, module):
        self.module = module
    def find_spec(self, name, path=None, target=None):
        if name == self.module:
            sys.meta_path.remove(self)
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Interrupting(sys.argv[1]))
sys.argv = ["mechkin", *sys.argv[2:]]
from mechkin_cli.__main__ import main
main()
"""
LOADED = [
    "mechkin_cli.cli.run",
    "mechkin_cli.cli.messages",
    "mechkin_cli.cli.analyze",
    "mechkin_cli.model.model",
    "mechkin_cli.kernel._kernel",
    "mechkin_cli.tables.folder",
    "mechkin_cli.tables.csv",
    "numpy",
    "numpy.linalg",
    "yaml",
]


def interrupted(module: str, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    (folder / "crank.yaml").write_text(files.CRANK, encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-P", "-c", PROGRAM, module, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize(
    ("module", "arguments"),
    [
        *((module, ["analyze", "crank.yaml"]) for module in LOADED),
        ("yaml", ["check", "crank.yaml"]),
        ("typer", ["check", "--help"]),
        ("typer", ["--help"]),
        ("mechkin_cli.schema.json_schema", ["schema"]),
        ("mechkin_cli.modes.modes", ["modes", "crank.yaml"]),
        ("mechkin_cli.schema.loads", ["mobility", "crank.yaml"]),
    ],
)
def test_an_interrupt_while_importing_is_quiet(
    tmp_path: Path, module: str, arguments: list[str]
) -> None:
    found = interrupted(module, tmp_path, *arguments)
    assert (found.returncode, found.stdout) == (130, "")
    assert found.stderr == "mechkin: interrupted; files written so far are whole\n"
    assert sorted(path.name for path in tmp_path.rglob("*") if path.is_file()) == ["crank.yaml"]


def test_nothing_is_interrupted_where_the_module_is_not_loaded(tmp_path: Path) -> None:
    assert interrupted("no.such.module", tmp_path, "check", "crank.yaml").returncode == 0
