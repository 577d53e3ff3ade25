"""The schema of `mechkin bench --json`."""

NUMBER = {"type": ["number", "null"]}
MEASUREMENT = {
    "type": "object",
    "additionalProperties": False,
    "required": ["family", "curve", "setting", "level", "rows", "microseconds", "ratio"],
    "properties": {
        **{name: {"type": "string"} for name in ("scene", "family", "curve", "setting")},
        "level": {"enum": ["position", "motion", "everything"]},
        "rows": {"type": "integer", "minimum": 1},
        **{name: {"type": "number"} for name in ("microseconds", "least", "spread", "ratio")},
        **dict.fromkeys(("position", "velocity", "acceleration", "loads"), NUMBER),
    },
}
MECHANISM = {
    "type": "object",
    "additionalProperties": False,
    "required": ["name", "rows", "places", "unknowns", "equations", "measurements", "skipped"],
    "properties": {
        "name": {"type": "string"},
        "exact": {"type": "string"},
        **{name: {"type": "integer"} for name in ("rows", "places", "unknowns", "equations")},
        "measurements": {"type": "array", "items": MEASUREMENT},
        "skipped": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["family", "reason"],
                "properties": {"family": {"type": "string"}, "reason": {"type": "string"}},
            },
        },
    },
}
TABLE = {
    "type": "object",
    "required": ["title", "rows", "notes"],
    "properties": {"rows": {"type": "array", "items": {"type": "object"}}},
}
SCHEMA = {
    "type": "object",
    "required": ["format", "machine", "mechanisms", "tables"],
    "properties": {
        "format": {"const": 1},
        "machine": {"type": "object", "additionalProperties": {"type": "string"}},
        "mechanisms": {"type": "array", "items": MECHANISM},
        "tables": {"type": "object", "additionalProperties": TABLE},
    },
}
