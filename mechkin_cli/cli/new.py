"""`mechkin new`: a mechanism file to start from. `mechkin schema`: JSON Schemas for editors."""

from __future__ import annotations

from pathlib import Path
from shlex import quote

from mechkin_cli import schema as schemas, tables, templates
from mechkin_cli.cli.messages import ExitCode, content_of, put, say
from mechkin_cli.diagnostics import UsageError


def new(name: str | None = None, template: str = "four-bar", list_: bool = False) -> ExitCode:
    """Writes a commented mechanism file that runs, to start from.

    An existing file is never written over.
    """
    if list_:
        names = templates.template_names()
        width = max(map(len, names))
        lines = (f"{n:{width}}  {templates.purpose(templates.template_text(n))}\n" for n in names)
        put("".join(lines))
        return ExitCode.OK
    if name is None:
        raise UsageError(
            "name the file to write: mechkin new NAME; mechkin new --list lists the templates"
        )
    stem = Path(name).name
    if not stem[:1].isalnum() and not stem.startswith("_"):
        raise UsageError(
            f"{name!r} is no name for a file: it begins with a letter or digit; such as "
            "mechkin new pump"
        )
    text = templates.template_text(template)
    path = Path(name if name.endswith((".yaml", ".yml")) else f"{name}.yaml")
    write_new(path, text)
    say(f"{path}: {templates.purpose(text)}")
    say(f"mechkin analyze {quote(str(path))}")
    return ExitCode.OK


def write_new(path: Path, text: str) -> None:
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
    except FileNotFoundError:
        raise UsageError(f"there is no folder {path.parent}; make it first") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"cannot write {path}: {reason}; choose another place") from None


MECHANISM = "mechanism"


def committed(name: str) -> Path:
    """The committed file of a schema."""
    return Path(f"schemas/{name}.schema.json")


def schema(out: Path | None = None, check: bool = False, study: bool = False) -> ExitCode:
    """Prints the JSON Schema of mechanism files, or compares it."""
    name = "study" if study else MECHANISM
    if check:
        names = [name]
        if not study and out is None:
            # studies are not everybody's
            names += [one for one in schemas.SCHEMAS if one != name and committed(one).exists()]
        fresh = [_is_up_to_date(one, out or committed(one)) for one in names]
        return ExitCode.OK if all(fresh) else ExitCode.DIFFERENCES
    text = schemas.json_schema_text(name)
    if out is not None:
        tables.write_files(out.parent, {out.name: text.encode()})
    else:
        put(text)
    return ExitCode.OK


def _is_up_to_date(name: str, path: Path) -> bool:
    """Whether the file has the schema; says so, or what to do."""
    if content_of(path) == schemas.json_schema_text(name).encode():
        say(f"{path} is up to date")
        return True
    option = "" if name == MECHANISM else f"--{name} "
    say(f"{path} is not up to date; run: mechkin schema {option}--out {path}")
    return False
