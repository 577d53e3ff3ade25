"""From the bytes of a YAML file to plain data in which every value knows its line and column.

text -> events -> nodes -> plain data. Hides PyYAML; turns errors of syntax and validation into
messages with a place.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.reading.document import *
    from mechkin_cli.reading.edits import *
    from mechkin_cli.reading.text import *
    from mechkin_cli.reading.yaml import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "document": "Document KeyPath document_from_data document_from_text explain is_mechanism "
        "is_study read_document",
        "edits": "with_values",
        "text": "MOST_BYTES MOST_DIAGNOSTICS MOST_TABLE_BYTES NotRegular decoded read_regular "
        "shortened",
        "yaml": "CORRECT_FIRST in_order",
    },
)
