"""The JSON record of an analysis."""

import json

import numpy as np
import pytest

from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.tables import evaluate
from mechkin_cli.tables.json import analysis_record, json_text

EXPECTED = {
    "name": "RCSR",
    "row_count": 4,
    "tables": [
        {
            "name": "table",
            "title": "T",
            "columns": [
                {"label": "theta1", "unit": "deg", "values": [190, 191, 192, 193]},
                {"label": "s2", "unit": "in", "values": [1, 2, -4, None]},
                {"label": "m", "unit": "", "values": ["A", "A", "A", "A"]},
            ],
        }
    ],
    "rows": [
        {"label": "row", "unit": "", "values": [1, 2, 3, 4]},
        {"label": "O1.theta", "unit": "deg", "values": [190, 191, 192, 193]},
        {"label": "mode", "unit": "", "values": ["A", "A", "A", "A"]},
        {
            "label": "status",
            "unit": "",
            "values": ["ok", "ok", "near-singular", "beyond-dead-centre"],
        },
        {"label": "residual", "unit": "", "values": [0, 1e-16, 2e-16, None]},
        {"label": "condition", "unit": "", "values": [2, 2.5, 1e7, None]},
        {"label": "power_error", "unit": "", "values": [None, None, None, None]},
    ],
    "diagnostics": [
        {
            "code": "dead-centre",
            "severity": "warning",
            "message": "the branch ends",
            "place": {"file": "a.yaml", "line": 3, "column": 7},
            "measured": "O1.theta = 192.5 deg",
        }
    ],
}


def test_the_whole_record(source, layout):
    table = evaluate(layout({"theta1": "O1.theta", "s2": "O2.s", "m": "row.mode"}, "T"), source)
    note = Diagnostic(
        "dead-centre",
        "warning",
        "the branch ends",
        Place("a.yaml", 3, 7),
        measured="O1.theta = 192.5 deg",
    )
    record = analysis_record("RCSR", [table], source, [note])
    read = json.loads(json_text(record))
    assert read == EXPECTED
    assert list(read) == list(EXPECTED)


def test_infinities_are_null_and_zero_has_no_sign(source):
    source.condition = np.array([np.inf, -np.inf, -0.0, 1e300])
    record = json.loads(json_text(analysis_record("", [], source)))
    condition = record["rows"][5]["values"]
    assert condition == [None, None, 0, 1e300]
    assert repr(condition[2]) == "0"


def test_the_text_puts_each_list_of_cells_on_one_line():
    record = {"b": [1, None, "ü"], "a": {"c": [], "d": {}}, "e": [{"f": 0.1}]}
    assert json_text(record) == (
        '{\n  "b": [1, null, "ü"],\n  "a": {\n    "c": [],\n    "d": {}\n  },\n'
        '  "e": [\n    {\n      "f": 0.1\n    }\n  ]\n}\n'
    )


@pytest.mark.parametrize("value", [float("nan"), [float("inf")]])
def test_a_number_that_json_does_not_have_is_refused(value):
    with pytest.raises(ValueError, match="not JSON compliant"):
        json_text({"x": value})
