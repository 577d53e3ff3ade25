"""The text of CSV files that a file names, as it was when it was first read."""

from __future__ import annotations

from pathlib import Path

from mechkin_cli.reading.document import Document
from mechkin_cli.reading.limits import MOST_BYTES
from mechkin_cli.regular_file import NotRegular, read_regular


class BadTable(Exception):
    """What is wrong with a CSV file; `line` and `column` count from 1, line 0 is the whole file."""

    def __init__(self, line: int, column: int, message: str, hint: str) -> None:
        super().__init__(message)
        self.line, self.column, self.message, self.hint = line, column, message, hint


def table_path(document: Document, name: str) -> Path:
    """Where a file lies that a document names."""
    return Path(name) if document.folder is None else document.folder / name


def table_text(document: Document, name: str, most: int = MOST_BYTES) -> str:
    """The text of a file that a document names, of at most so many bytes.

    Raises:
        BadTable: it cannot be read.
    """
    if name not in document.tables:
        document.tables[name] = _content(table_path(document, name), most)
    return _text(document.tables[name])


def _content(file: Path, most: int) -> bytes:
    try:
        content = read_regular(file, most)
    except NotRegular:
        raise BadTable(0, 0, "is not a regular file", "name a CSV file") from None
    except FileNotFoundError:
        hint = "the path leads from the folder of the file that names it"
        raise BadTable(0, 0, "does not exist", hint) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise BadTable(0, 0, f"cannot be read: {reason}", "check its rights") from None
    if len(content) > most:
        text = f"is too large for a table: more than {most >> 20} MiB (limit {most} bytes)"
        raise BadTable(0, 0, text, "keep fewer rows: the curve between them is smooth")
    return content


def _text(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        text = f"the byte 0x{content[error.start]:02X} is not UTF-8 text"
        raise BadTable(line, 1, text, "save the file as UTF-8") from None
