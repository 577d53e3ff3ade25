"""The examples in docstrings are run."""

from __future__ import annotations

import doctest

from mechkin_cli.expressions import expression


def test_docstring_examples() -> None:
    result = doctest.testmod(expression)
    assert result.attempted > 0
    assert result.failed == 0
