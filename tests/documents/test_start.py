"""docs/start.md lists the templates that there are."""

import re

from documents.reading import page

from mechkin_cli.templates import template_names


def test_every_template_is_listed() -> None:
    assert sorted(re.findall(r"^\| `([\w-]+)` \|", page("docs/start.md"), re.MULTILINE)) == (
        template_names()
    )
