"""How a command answers a question about one mechanism file: words or JSON, and the exit code."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

import typer

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.given_file import model_of, shown
from mechkin_cli.cli.messages import Record, put_json, refusal, say_diagnostics
from mechkin_cli.cli.parameters import parameters
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.interface import Model


class _Answer(Protocol):
    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]: ...


Found = TypeVar("Found", bound=_Answer)


@dataclass(frozen=True)
class Question(Generic[Found]):
    """What is asked of a model (`words` for a person who waits), whether the answer holds anything,
    and both ways to tell it."""

    ask: Callable[[Model], Found]
    is_answered: Callable[[Found], bool]
    record: Callable[[Model, Found], Record]
    show: Callable[[Model, Found], None]
    words: str


def answer(file: Path, settings: list[str] | None, json: bool, question: Question[Found]) -> None:
    """Asks the file's model, and shows the answer or writes one JSON object to stdout.

    Raises:
        typer.Exit: with the exit code, unless all is well.
    """
    record: Record = {}
    try:
        model = model_of(file, parameters(settings))
        with working(f"{shown(file)}: {question.words}"):
            found = question.ask(model)
    except (InvalidFile, UsageError) as error:
        code, record = refusal(file, error)
    else:
        say_diagnostics(found.diagnostics, shown(file))
        code = ExitCode.OK if question.is_answered(found) else ExitCode.ROWS_MISSING
        if json:
            record = {"file": shown(file), **question.record(model, found)}
        else:
            question.show(model, found)
    if json:
        put_json(record)
    if code:
        raise typer.Exit(code)
