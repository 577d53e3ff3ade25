"""How a command answers a question about one mechanism file, in words or JSON."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeVar

from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    model_of,
    parameters,
    put_json,
    refusal,
    say_diagnostics,
    shown,
)
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.model import Model


class _Answer(Protocol):
    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]: ...


Found = TypeVar("Found", bound=_Answer)


def answer(
    file: Path,
    settings: list[str] | None,
    json: bool,
    words: str,
    *,
    ask: Callable[[Model], Found],
    is_answered: Callable[[Found], bool],
    record_of: Callable[[Model, Found], Record],
    show: Callable[[Model, Found], None],
) -> ExitCode:
    """Asks the file's model, and shows the answer or writes one JSON object to stdout; the exit
    code.

    Args:
        words: for a person who waits.
        is_answered: whether the answer holds anything.
    """
    record: Record = {}
    try:
        model = model_of(file, parameters(settings))
        with working(f"{shown(file)}: {words}"):
            found = ask(model)
    except (InvalidFile, UsageError) as error:
        code, record = refusal(file, error)
    else:
        say_diagnostics(found.diagnostics, shown(file))
        code = ExitCode.OK if is_answered(found) else ExitCode.ROWS_MISSING
        if json:
            record = {"file": shown(file), **record_of(model, found)}
        else:
            show(model, found)
    if json:
        put_json(record)
    return code
