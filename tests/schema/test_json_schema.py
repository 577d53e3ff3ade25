"""What editors are told agrees with the reader, and the committed JSON Schema is fresh."""

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml
from reading.bad_files import BAD_FILES, BadFile

from mechkin_cli.schema.json_schema import (
    BY_KEY,
    BY_SECTION,
    SCHEMAS,
    has_example,
    json_schema,
    json_schema_text,
)

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


@pytest.fixture(params=SCHEMAS)
def schema(request: pytest.FixtureRequest) -> dict[str, Any]:
    """Each of the schemas."""
    return SCHEMAS[request.param]()


def test_is_a_json_schema(schema: dict[str, Any]) -> None:
    jsonschema.Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("name", SCHEMAS)
def test_the_committed_file_is_fresh(name: str) -> None:
    committed = TESTS.parent / "schemas" / f"{name}.schema.json"
    assert committed.read_text(encoding="utf-8") == json_schema_text(name)


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


def test_mappings_with_fixed_keys_are_closed(schema: dict[str, Any]) -> None:
    open_ones = [
        part
        for part in parts(schema)
        if part.get("type") == "object"
        and part.get("additionalProperties") is not False
        # a word decides which of the closed forms is meant
        and not all("if" in rule for rule in part.get("allOf", [{}]))
    ]
    assert open_ones == []


def test_no_editor_has_to_guess_which_form_is_meant(schema: dict[str, Any]) -> None:
    alternatives = [form for part in parts(schema) for form in part.get("oneOf", [])]
    assert alternatives
    assert all(form.keys() == {"required"} for form in alternatives)


def test_every_key_has_words_and_an_example_that_fits(schema: dict[str, Any]) -> None:
    definitions = schema["$defs"]
    sections = {"": schema} | definitions
    checked = 0
    for name, section in sections.items():
        for key, value in section.get("properties", {}).items():
            assert value.get("description"), (name, key)
            assert has_example(value, definitions), (name, key)
            for example in value.get("examples", []):
                whole = {"$defs": definitions} | value
                jsonschema.Draft202012Validator(whole).validate(example)
                checked += 1
    assert checked > (90 if "MechanismFile" in definitions else 10)


def test_every_measured_key_says_its_unit() -> None:
    definitions = json_schema()["$defs"]
    lead = definitions["HelicalJoint"]["properties"]["lead"]["description"]
    assert lead.endswith("Unit: that of length, the file's or its own.")
    force = definitions["ForceOnLink"]["properties"]["force"]["description"]
    assert force.endswith("Unit: that of force, the file's or its own.")
    measures = ("length", "mass", "moment of inertia", "force", "moment", "time", "angle")
    for name, definition in definitions.items():
        for key, value in definition.get("properties", {}).items():
            kind = value.get("$ref", "").rpartition("/")[2]
            said = definitions.get(kind, {}).get("description", "").partition(":")[0]
            if said in measures:
                assert f"Unit: that of {said}," in value["description"], (name, key)


def test_every_example_of_the_table_stands_at_a_key() -> None:
    sections = {"StudyFile": SCHEMAS["study"]()} | json_schema()["$defs"]
    sections |= SCHEMAS["study"]()["$defs"]
    keys = {key for section in sections.values() for key in section.get("properties", {})}
    assert set(BY_KEY) <= keys
    for section, key in BY_SECTION:
        assert key in sections[section]["properties"]


def test_the_schema_has_a_name_of_its_own() -> None:
    assert json_schema()["$id"] == "urn:mechkin:schema:mechanism:1"


def test_numbers_may_be_texts() -> None:
    assert json_schema()["$defs"]["Length"]["type"] == ["number", "string"]


def test_each_key_of_the_file_has_a_help_text() -> None:
    forms = [json_schema()["$defs"][name] for name in ("MechanismFile", "PlaneFile")]
    keys = [item for form in forms for item in form["properties"].items()]
    assert [name for name, part in keys if not part["description"]] == []


def test_nothing_may_be_null(schema: dict[str, Any]) -> None:
    assert not any(part.get("type") == "null" for part in parts(schema))
