"""The examples in docstrings are run."""

from __future__ import annotations

import doctest

import pytest

from mechkin_cli.expressions import expression, fields


@pytest.mark.parametrize("module", [expression, fields])
def test_docstring_examples(module: object) -> None:
    result = doctest.testmod(module)  # type: ignore[arg-type]
    assert result.attempted > 0
    assert result.failed == 0
