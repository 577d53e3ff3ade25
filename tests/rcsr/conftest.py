"""One run of mechanisms/dissertation/rcsr.yaml for all tests of this folder."""

from __future__ import annotations

import pytest
from references import RCSR

import mechkin_cli as mk


@pytest.fixture(scope="session")
def analysis():
    return mk.load(RCSR).analyze()


@pytest.fixture(scope="session")
def tables(analysis):
    """Values by label, by the name of the table."""
    return {
        table.name: {column.label: column.values for column in table.columns}
        for table in analysis.tables
    }
