"""What a plain analysis loads: start-up time is a property of the product."""

from __future__ import annotations

import json
import subprocess
import sys
from functools import cache

import pytest
from references import RCSR

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


@cache
def loaded_by(script: str) -> set[str]:
    command = [sys.executable, "-P", "-c", script, str(RCSR)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return {name.split(".")[0] for name in json.loads(done.stdout)}


@pytest.mark.parametrize(
    "library", ["scipy", "rich", "typer", "mpmath", "matplotlib", "pandas", "pydantic"]
)
def test_an_analysis_does_without(library: str) -> None:
    assert library not in loaded_by(ANALYSIS)


@pytest.mark.parametrize("library", ["numpy", "pydantic", "yaml", "scipy", "rich", "typer"])
def test_the_package_itself_loads_nothing(library: str) -> None:
    assert library not in loaded_by(PACKAGE)


@pytest.mark.parametrize("library", ["numpy", "pydantic_core", "yaml"])
def test_what_an_analysis_needs_is_seen_by_this_test(library: str) -> None:
    assert library in loaded_by(ANALYSIS)
