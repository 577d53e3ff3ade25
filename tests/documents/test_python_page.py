"""The example of the page on Python runs and gives what it says."""

import re

import pytest
from documents.reading import ROOT, blocks, page, ran

import mechkin_cli as mk


def test_the_python_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    (code,) = blocks(page("docs/python.md"), "python")
    analysis = ran(code, "r")
    assert isinstance(analysis, mk.Analysis)
    assert analysis["O4.theta"].shape == (27,)
    for expression in re.findall(r'r\["(.*?)"\]', code):
        assert analysis[expression].shape[0] == 27
