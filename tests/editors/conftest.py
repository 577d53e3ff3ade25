"""The language server, started once; tests are skipped with a word where it is not there."""

from collections.abc import Iterator

import pytest
from editors.language_server import Server, missing


@pytest.fixture(scope="session")
def editor() -> Iterator[Server]:
    if reason := missing():
        pytest.skip(f"the schema is not tried in an editor: {reason}")
    server = Server()
    yield server
    server.close()
