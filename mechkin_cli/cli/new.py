"""`mechkin new`: a mechanism file to start from."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from mechkin_cli.cli.messages import put, say
from mechkin_cli.diagnostics import UsageError


def new(
    name: Annotated[
        str | None, typer.Argument(metavar="NAME", help="The file to write; .yaml is added.")
    ] = None,
    template: Annotated[
        str,
        typer.Option(
            "--template", metavar="TEMPLATE", help="Template to start from; --list names them."
        ),
    ] = "four-bar",
    list_: Annotated[bool, typer.Option("--list", help="List the templates.")] = False,
) -> None:
    """Write a commented mechanism file that runs, to start from.

    An existing file is never written over.
    """
    from mechkin_cli.templates import purpose, template_names, template_text

    if list_:
        names = template_names()
        width = max(map(len, names))
        put("".join(f"{one:{width}}  {purpose(template_text(one))}\n" for one in names))
        return
    if name is None:
        raise UsageError(
            "name the file to write: mechkin new NAME; mechkin new --list tells of what"
        )
    stem = Path(name).name
    if not stem[:1].isalnum() and not stem.startswith("_"):
        raise UsageError(
            f"{name!r} is no name for a file: it begins with a letter or digit; such as "
            "mechkin new pump"
        )
    text = template_text(template)
    path = Path(name if name.endswith((".yaml", ".yml")) else f"{name}.yaml")
    _write_anew(path, text)
    say(f"{path}: {purpose(text)}")
    say(f"mechkin analyze {quote(str(path))}")


def _write_anew(path: Path, text: str) -> None:
    """Writes a file that is not there yet, whole or not at all.

    Raises:
        UsageError: there is one, or it cannot be written.
    """
    try:
        with path.open("x", encoding="utf-8", newline="\n") as file:
            try:
                file.write(text)
                file.flush()
            except BaseException:
                path.unlink(missing_ok=True)
                raise
    except FileExistsError:
        raise UsageError(f"{path} is there already; choose another name") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"cannot write {path}: {reason}") from None
