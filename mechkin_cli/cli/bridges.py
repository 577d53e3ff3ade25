"""`mechkin import`: a mechanism file from a file of another program. `mechkin export`: back."""

from __future__ import annotations

from pathlib import Path
from shlex import quote

from mechkin_cli import bridges, reading, tables, templates
from mechkin_cli.bridges import ExportOptions, ImportOptions
from mechkin_cli.cli.messages import (
    ExitCode,
    model_of,
    parameters,
    put,
    refusal,
    refuse_stdin,
    say,
    say_diagnostics,
    shown,
    stem_of,
    tell_as,
    values_by_name,
)
from mechkin_cli.cli.new import write_new
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, Place, UsageError
from mechkin_cli.model import Model, loads


def import_(
    file: Path,
    out: Path | None = None,
    template: str | None = None,
    unit: str | None = None,
    rename: list[str] | None = None,
    close: list[str] | None = None,
    messages: str | None = None,
    quiet: bool = False,
) -> ExitCode:
    """Writes the mechanism file that a file of another program becomes; an existing file is never
    written over."""
    tell_as(messages)
    try:
        refuse_stdin(file, "import takes the format from the ending of a file")
        target = out or Path(f"{stem_of(file)}.yaml")
        expected = "TABLE=TEMPLATE, for example --rename 'LCA outer=lower_ball'"
        renamed = values_by_name("--rename", rename or (), expected)
        options = ImportOptions(*_template(template), unit, renamed, tuple(close or ()))
        with working(f"{file}: reading", quiet):
            found = bridges.imported(file, options)
            model = _readable(found.text, file, target)
        write_new(target, found.text)
    except (InvalidFile, UsageError) as error:
        return refusal(file, error)[0]
    say_diagnostics(found.notes, str(file))
    put(f"{target}\n")
    if not quiet:
        mechanism = model.problem.mechanism
        links = sum(name != "ground" for name in mechanism.links)
        say(f"{model.name}: {links} moving links, {len(mechanism.joints)} joints")
        say(f"mechkin analyze {quote(str(target))}")
    return ExitCode.OK


def _readable(text: str, file: Path, target: Path) -> Model:
    """The mechanism that will be written; what is wrong with it is told of the imported file.

    Raises:
        InvalidFile: it cannot be used.
    """
    try:
        return loads(text, str(target), folder=target.parent)
    except InvalidFile as error:
        told = [one._replace(place=Place(str(file), 1, 1)) for one in error.diagnostics]
        raise InvalidFile(told) from error


def _template(name: str | None) -> tuple[str | None, str]:
    """The text of a template, or of a mechanism file that stands for one, and its name."""
    if name is None:
        return None, ""
    path = Path(name)
    if path.suffix in (".yaml", ".yml") or path.exists():
        return reading.read_document(path).text, str(path)
    return templates.template_text(name), f"the template {name}"


def export(
    file: Path,
    to: str | None = None,
    out: Path | None = None,
    run: str | None = None,
    row: list[str] | None = None,
    set_: list[str] | None = None,
    mode: str | None = None,
    messages: str | None = None,
    quiet: bool = False,
) -> ExitCode:
    """Writes a mechanism in the format of another program."""
    tell_as(messages)
    try:
        if to is None:
            raise UsageError(f"name the format: --to {' or --to '.join(bridges.EXPORTS)}")
        options = ExportOptions(run, mode, _rows(row))
        with working(f"{shown(file)}: {to}", quiet):
            model = model_of(file, parameters(set_))
            found = bridges.exported(model, to, options)
        written = tables.write_files(out or Path("out", stem_of(file)), found.files)
    except (InvalidFile, UsageError) as error:
        return refusal(file, error)[0]
    say_diagnostics(found.notes, shown(file))
    put("".join(f"{path}\n" for path in written))
    return ExitCode.OK


def _rows(texts: list[str] | None) -> tuple[int, ...]:
    rows = []
    for text in ",".join(texts or ()).split(",") if texts else ():
        if not (text.strip().isascii() and text.strip().isdigit() and 0 < int(text) < 10**9):
            raise UsageError(f"--row {text}: expected the number of a row, from 1 on")
        rows.append(int(text))
    return tuple(rows)
