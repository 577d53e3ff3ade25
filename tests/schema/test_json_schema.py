"""What editors are told agrees with the reader, and the committed JSON Schema is fresh."""

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml
from reading.bad_files import BAD_FILES, BadFile

from mechkin_cli.schema.json_schema import json_schema, json_schema_text

TESTS = Path(__file__).parent.parent
# to editors, which are written in JavaScript, $ is the end; to Python also a line break before it
PATTERNS = json_schema_text().replace('$"', '\\\\Z"')
VALIDATOR = jsonschema.Draft202012Validator(json.loads(PATTERNS))


class EditorLoader(yaml.SafeLoader):
    """YAML as editors read it: only true and false are booleans (YAML 1.2)."""


EditorLoader.yaml_implicit_resolvers = {
    first: [
        (tag, pattern) for tag, pattern in resolvers if not tag.endswith((":bool", ":timestamp"))
    ]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
EditorLoader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("true|false"), list("tf"))


def accepts(text: str) -> bool:
    try:
        data = yaml.load(text, Loader=EditorLoader)
    except (yaml.YAMLError, RecursionError):
        return False
    return VALIDATOR.is_valid(with_text_keys(data))


def with_text_keys(data: Any) -> Any:
    """The data as JSON has it: keys are texts, also those that are numbers or words to YAML."""
    if isinstance(data, list):
        return [with_text_keys(item) for item in data]
    if isinstance(data, dict):
        return {key_text(key): with_text_keys(value) for key, value in data.items()}
    return data


def key_text(key: Any) -> str:
    return str(key).lower() if isinstance(key, bool) else str(key)


def parts(schema: Any) -> list[dict[str, Any]]:
    """Every mapping inside a schema, itself included."""
    if isinstance(schema, list):
        return [part for item in schema for part in parts(item)]
    if isinstance(schema, dict):
        return [schema, *(part for item in schema.values() for part in parts(item))]
    return []


def test_is_a_json_schema() -> None:
    jsonschema.Draft202012Validator.check_schema(json_schema())


def test_the_committed_file_is_fresh() -> None:
    committed = TESTS.parent / "schemas" / "mechanism.schema.json"
    assert committed.read_text(encoding="utf-8") == json_schema_text()


@pytest.mark.parametrize(
    "path", sorted((TESTS / "reading" / "good").glob("*.yaml")), ids=lambda path: path.stem
)
def test_good_files_are_accepted(path: Path) -> None:
    assert accepts(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("bad", BAD_FILES, ids=lambda bad: repr(bad.text[-40:]))
def test_bad_files_are_refused_where_a_schema_can_tell(bad: BadFile) -> None:
    assert accepts(bad.text) is not bad.editor


def test_fixed_lengths_are_written_for_every_editor() -> None:
    schema = json_schema()
    vector = schema["$defs"]["LengthVector"]
    assert (vector["items"], vector["minItems"], vector["maxItems"]) == (
        {"$ref": "#/$defs/Length"},
        3,
        3,
    )
    assert not any("prefixItems" in part for part in parts(schema))


def test_mappings_with_fixed_keys_are_closed() -> None:
    open_ones = [
        part
        for part in parts(json_schema())
        if part.get("type") == "object" and part.get("additionalProperties") is not False
    ]
    assert open_ones == []


def test_numbers_may_be_texts() -> None:
    assert json_schema()["$defs"]["Length"]["type"] == ["number", "string"]


def test_each_key_of_the_file_has_a_help_text() -> None:
    silent = [name for name, part in json_schema()["properties"].items() if not part["description"]]
    assert silent == []


def test_nothing_may_be_null() -> None:
    assert not any(part.get("type") == "null" for part in parts(json_schema()))
