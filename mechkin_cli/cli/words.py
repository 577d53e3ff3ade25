"""Command lines: what an option, an argument and a command are, and the words that several commands
share."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Mapping
from importlib import import_module

from mechkin_cli.cli.messages import FORMS
from mechkin_cli.record import NamedTuple

TYPE_CHECKING = False  # typing is not loaded for its flag alone
if TYPE_CHECKING:
    from typing import Any, Literal

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


class Command(NamedTuple):
    """A command; `home` is the module and the function that do it."""

    name: str
    home: str
    help: str
    words: tuple[Word, ...]
    has_model: bool = True

    def call(self, given: Mapping[str, Any]) -> int:
        """Does it, and gives the exit code.

        Args:
            given: the values of parameters; those left out have their defaults.
        """
        # no command multiplies large matrices: one thread of BLAS per core would only be started
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        module, function = self.home.split(":")
        known = "mechkin_cli.model.model" in sys.modules
        if self.has_model:
            from mechkin_cli.model import Model  # noqa: F401
        work = getattr(import_module(f"mechkin_cli.cli.{module}"), function)
        if not known:
            # modules live as long as the process: looking for garbage among them takes long
            gc.freeze()
        gc.enable()
        return int(work(**given) or 0)


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
