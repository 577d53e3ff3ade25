"""The words of command lines: what an option or an argument is, and those that several commands
share."""

from __future__ import annotations

from mechkin_cli.cli.messages import FORMS
from mechkin_cli.record import NamedTuple

TYPE_CHECKING = False  # typing is not loaded for its flag alone
if TYPE_CHECKING:
    from typing import Literal

    Kind = Literal["flag", "text", "whole", "path", "folder"]


class Word(NamedTuple):
    """An option or, without `names`, an argument: the parameter of the command's function that it
    gives, and how help tells it.

    `offers` is the function of `app.py` that a shell is offered values by.
    """

    parameter: str
    help: str
    names: tuple[str, ...] = ()
    kind: Kind = "flag"
    metavar: str | None = None
    repeated: bool = False
    required: bool = False
    default: str | int | None = None
    offers: str | None = None


FILES = Word(
    "files",
    "Mechanism files (YAML, format 1); - reads stdin.",
    kind="path",
    metavar="FILE",
    repeated=True,
    required=True,
    offers="mechanism_files",
)
FILE = FILES._replace(
    parameter="file", help="Mechanism file (YAML, format 1); - reads stdin.", repeated=False
)
SET = Word(
    "set_",
    "Set a parameter, as P1=0.6in; repeatable.",
    ("--set",),
    "text",
    "NAME=VALUE",
    repeated=True,
    offers="parameter_names",
)
MODE = Word(
    "mode",
    "Assembly mode at the first row: its letter, or home for the one drawn.",
    ("--mode",),
    "text",
    "NAME",
    offers="mode_names",
)
TABLE = Word(
    "table",
    "Only this table; may be repeated.",
    ("--table",),
    "text",
    "NAME",
    repeated=True,
    offers="table_names",
)
MESSAGES = Word(
    "messages",
    f"Form of the messages: {' or '.join(FORMS)} (annotations for CI).",
    ("--messages",),
    "text",
    "FORM",
    offers="message_forms",
)
JSON = Word("json", "One JSON object on stdout and nothing else.", ("--json",))
QUIET = Word("quiet", "Only warnings and errors.", ("--quiet",))
