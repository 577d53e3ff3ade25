"""Where fuzzing starts: every mechanism file of the project, every mistake of the tests, and the
words of the format."""

from __future__ import annotations

import re

from building.bad_parts import BAD_PARTS
from building.bad_responses import BAD_RESPONSES
from building.bad_uses import BAD_USES
from reading.bad_files import BAD_FILES
from references import FILE_OF, MECHANISMS

from mechkin_cli.expressions.functions import FUNCTIONS
from mechkin_cli.schema.json_schema import json_schema_text
from mechkin_cli.units.units import UNITS

GOOD = MECHANISMS.parent / "tests" / "reading" / "good"
LONGEST = 20_000
"""Bytes of a seed; longer ones (floods of brackets) slow a fuzzer down."""


def seeds() -> list[bytes]:
    files = [path.read_bytes() for path in sorted([*FILE_OF.values(), *GOOD.glob("*.yaml")])]
    bad = (*BAD_FILES, *BAD_PARTS, *BAD_USES, *BAD_RESPONSES)
    mistakes = [mistake.text.encode() for mistake in bad]
    return [content for content in (*files, *mistakes) if len(content) <= LONGEST]


def words() -> list[bytes]:
    """Keys, functions, units, numbers and punctuation."""
    keys = set(re.findall(r"[a-z][a-z_0-9]+", json_schema_text()))
    marks = [*"{}[],:-#&*!|>'\"%@`?\\~()^/+=", "**", "<<", "---", "...", "!!str"]
    numbers = ["0", "-1", "1e308", "1e-320", "1e999", ".nan", "-.inf", "010", "0x1F", "9" * 22]
    others = ["\n", "\n  ", "\t", " ", "\r", "\x00", "\x85", "\u2028", "\ufeff", "\U0001d6fc", "é"]
    texts = [*sorted(keys), *FUNCTIONS, *UNITS, *marks, *numbers, *others, "&a", "*a", '"\\x00"']
    return [text.encode() for text in texts] + [b"\xff", b"\xc3", b"\xed\xa0\x80"]
