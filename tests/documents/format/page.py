"""`docs/format.md`: every key of a file, made from the JSON Schemas, a table for each part."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, NamedTuple

from documents.format.kinds import Definitions, Schema

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "format.md"
MARK = "<!-- made by `python -P tests/documents/format`; a test compares it -->\n"
_UNIT = re.compile(r" Unit: that of [^.]*\.")
_LEFT_OUT = re.compile(r"(?:;|\.) [Ll]eft out, (.*?)(?:\.(?= |$)|$)")


WORDS = ("type", "law")


class Row(NamedTuple):
    """A key with all that a page tells of it; `within` are the forms that have it."""

    path: str
    told: str
    kind: str
    absent: str
    example: str


def page() -> str:
    """The whole page: what is written by hand above the mark, and what is made below it."""
    by_hand, mark, _ = PAGE.read_text(encoding="utf-8").partition(MARK)
    if not mark:
        raise ValueError(f"{PAGE} lost the line {MARK}")
    mechanism, study = (schema(name) for name in ("mechanism", "study"))
    parts = Definitions(mechanism)
    space, plane = parts.parts["MechanismFile"], parts.parts["PlaneFile"]
    text = "\n## A mechanism\n\n" + _part(parts, space, "")
    text += "".join(_below(parts, space, key) for key in space["properties"])
    text += "\n## In a plane\n\n" + _plane(parts, space, plane)
    text += "\n## A study\n\n" + _part(Definitions(study), study, "")
    text += "".join(_below(Definitions(study), study, key) for key in study["properties"])
    return by_hand + mark + text


def schema(name: str) -> Schema:
    """A schema as it is committed."""
    path = ROOT / "schemas" / f"{name}.schema.json"
    found: Schema = json.loads(path.read_text(encoding="utf-8"))
    return found


def rows_below(parts: Definitions, section: Schema, key: str) -> dict[Row, list[str]]:
    """The rows of all that lies below a key of a section, with the forms that have each."""
    rows: dict[Row, list[str]] = {}
    _collect(parts, section["properties"][key], "", "", rows)
    return rows


def _collect(
    parts: Definitions, value: Schema, before: str, within: str, rows: dict[Row, list[str]]
) -> None:
    forms = parts.forms(value)
    for form in forms:
        own = " ".join(filter(None, (within, form.named)))
        needed = form.schema.get("required", [])
        for key, inner in form.schema["properties"].items():
            path = f"{before}{key}"
            if len(forms) > 1 and key in WORDS and "const" in inner:
                row = _choice(path, [one.schema for one in forms], key)
            else:
                row = _row(parts, path, inner, key in needed)
            rows.setdefault(row, []).append(own)
            _collect(parts, inner, f"{path}.", own, rows)


def _choice(path: str, forms: list[Schema], key: str) -> Row:
    """The key whose word says which form a mapping is."""
    words = [one["properties"][key]["const"] for one in forms if key in one["properties"]]
    kind = ", ".join(f"`{word}`" for word in dict.fromkeys(words))
    all_have_it = len(words) == len(forms)
    absent = "**needed**" if all_have_it else "one of the other forms"
    return Row(path, "Which form it is.", kind, absent, f"`{words[0]}`")


def _row(parts: Definitions, path: str, value: Schema, needed: bool) -> Row:
    said = _UNIT.sub("", value["description"])
    clause = _LEFT_OUT.search(said)
    absent = clause[1] if clause else "-"
    if clause:
        said = said[: clause.start()] + "." + said[clause.end() :]
    if needed:
        absent = "**needed**"
    elif "default" in value:
        absent = f"`{value['default']}`"
    return Row(path, said, parts.kind(value), absent, _example(parts, value))


def _example(parts: Definitions, value: Schema) -> str:
    while True:
        if value.get("examples"):
            return f"`{_yaml(value['examples'][0])}`"
        if "const" in value or "enum" in value or "default" in value:
            word = value.get("const", value.get("default"))
            return f"`{word if word is not None else value['enum'][0]}`"
        value = _first(parts, value)


def _first(parts: Definitions, value: Schema) -> Schema:
    if "$ref" in value:
        return parts.resolved(value)
    first: Schema = value["then"] if "then" in value else value["items"]
    return first


def _yaml(value: Any) -> str:
    """A value in YAML's flow style, on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_yaml(one)}" for key, one in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_yaml(one) for one in value) + "]"
    text = str(value).lower() if isinstance(value, bool) else str(value)
    return f'"{text}"' if text.startswith("#") else text


def _part(parts: Definitions, section: Schema, title: str) -> str:
    """The table of a section's own keys."""
    rows: dict[Row, list[str]] = {}
    needed = section.get("required", [])
    for key, value in section["properties"].items():
        rows[_row(parts, key, value, key in needed)] = []
    return title + _table(rows)


def _below(parts: Definitions, section: Schema, key: str) -> str:
    """The part of the page for what lies below a key; nothing where nothing does."""
    rows = rows_below(parts, section, key)
    if not rows:
        return ""
    said = "".join(f"{line}\n" for line in _sections_said(parts, section["properties"][key]))
    return f"\n### {key}\n\n{said}{_table(rows)}"


def _sections_said(parts: Definitions, value: Schema) -> list[str]:
    """What the forms that may stand there are: one sentence, or a list of them."""
    forms = parts.forms(value)
    if len(forms) == 1:
        words = forms[0].schema["description"].replace("\n\n", " ")
        return [words, ""]
    firsts = [(one.named, one.schema["description"].partition("\n")[0]) for one in forms]
    return [*(f"- {named}: {words}" for named, words in firsts), ""]


def _plane(parts: Definitions, space: Schema, plane: Schema) -> str:
    """What is otherwise in a plane than in space: rows that space does not have."""
    without = [f"`{key}`" for key in space["properties"] if key not in plane["properties"]]
    text = "A file with `plane: xy` has no " + ", ".join(without) + ", and these keys are other:\n"
    for key in plane["properties"]:
        there = rows_below(parts, space, key)
        here = rows_below(parts, plane, key)
        other = {row: within for row, within in here.items() if row not in there}
        text += f"\n### {key} in a plane\n\n{_table(other)}" if other else ""
    return text


def _within(forms: list[str]) -> str:
    return ", ".join(dict.fromkeys(filter(None, forms)))


def _table(rows: dict[Row, list[str]]) -> str:
    """The rows as Markdown; with a column for the forms where there are several."""
    several = any(any(within) for within in rows.values())
    heads = ["key", *(["in"] if several else []), "what it is", "value", "left out", "example"]
    lines = [heads, ["---"] * len(heads)]
    for row, within in rows.items():
        forms = [_within(within)] if several and row.told != "Which form it is." else [""] * several
        lines.append([f"`{row.path}`", *forms, row.told, row.kind, row.absent, row.example])
    cells = [[cell.replace("|", "\\|") for cell in line] for line in lines]
    return "".join(f"| {' | '.join(line)} |\n" for line in cells)
