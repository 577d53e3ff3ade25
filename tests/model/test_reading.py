"""Results as mappings, at the prompt, in notebooks and as data frames."""

from __future__ import annotations

import re
import subprocess
import sys
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest
from cli import files
from references import RCSR

import mechkin_cli as mk


@pytest.fixture(scope="module")
def rcsr() -> Any:
    return mk.load(RCSR).analyze()


@pytest.fixture
def crank() -> Any:
    return mk.loads(files.CRANK + files.TABLES).analyze()


def test_a_run_is_a_mapping_of_its_quantities(crank) -> None:
    names = list(crank)
    assert len(crank) == len(names) == len(set(names))
    assert tuple(names) == crank.keys()
    assert names[0] == "O.theta"
    assert {"O.effort", "tip.position", "row.status", "row.residual"} <= set(names)
    assert "tip.position" in crank
    assert "tip.position.x" not in names
    assert "nothing" not in crank
    assert 3 not in crank


def test_every_name_has_values_and_a_unit(rcsr) -> None:
    for name in rcsr:
        assert len(rcsr[name]) == rcsr.rows
        assert isinstance(rcsr.unit(name), str)
    assert rcsr.unit("O4.theta") == "deg"
    assert rcsr.unit("norm(O3.force)") == "lbm*in/s^2"
    assert rcsr.unit("row.status") == ""


def test_tables_go_by_number_and_by_name(rcsr) -> None:
    tables = rcsr.tables
    assert tables["table_04"] is tables[1]
    assert isinstance(tables, tuple)
    assert tables[-1].name == "table_18"
    assert [one.name for one in tables[:2]] == tables.keys()[:2]
    assert "table_04" in tables
    assert tables[1] in tables
    assert "table_4" not in tables
    with pytest.raises(mk.UsageError, match="there is no 'table_33' here; did you mean table_03"):
        tables["table_33"]
    assert rcsr.model.tables["table_04"].name == "table_04"


def shown(rcsr: Any) -> list[Any]:
    model = rcsr.model
    return [
        *(model, rcsr, model.modes(), model.ranges(outputs=["O4.theta"]), model.mobility()),
        *(rcsr.errors, rcsr.certificate),
    ]


class Balanced(HTMLParser):
    """Checks that tags are closed in order; keeps the text."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.said: list[str] = []

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.said.append(data)


def test_everything_shows_itself(rcsr) -> None:
    for one in shown(rcsr):
        text, page = repr(one), Balanced()
        assert "object at 0x" not in text
        assert max(map(len, text.splitlines())) <= 250
        assert len(text.splitlines()) < 40
        page.feed(one._repr_html_())
        assert page.open == []
        assert any("RCSR" in said or "O1.theta" in said for said in page.said)


def test_numbers_shown_are_those_of_the_result(rcsr) -> None:
    found = rcsr.model.modes()
    text = repr(found)
    for mode in found.modes:
        assert f"{mode.coordinates['O4.theta']:.6g}" in text
    assert "27 of 27 rows solved" in repr(rcsr)
    cell = rcsr.tables["table_03"].columns[3].values[0]
    assert f"<td>{cell:.3f}</td>" in rcsr._repr_html_()


def test_names_of_the_file_are_text_in_a_page() -> None:
    name = "<script>alert(1)</script>\x1b[31m"
    model = mk.loads(files.CRANK.replace("name: crank", f"name: '{name[:-5]}'") + files.TABLES)
    for one in (model, model.analyze()):
        assert "<script>" not in one._repr_html_()
        assert "&lt;script&gt;" in one._repr_html_()


def test_long_lists_are_shortened_with_a_word() -> None:
    text = files.CRANK.replace("step: 45", "step: 0.01") + files.TABLES
    analysis = mk.loads(text).analyze()
    rows = re.findall("<tr>", analysis._repr_html_())
    assert len(rows) < 60
    assert "<td>...</td>" in analysis._repr_html_()


def test_a_table_as_a_data_frame(rcsr) -> None:
    pytest.importorskip("pandas")
    frame = rcsr.to_pandas("table_03")
    table = rcsr.tables["table_03"]
    assert list(frame.columns) == [column.label for column in table.columns]
    for column in table.columns:
        assert frame[column.label].to_numpy().tobytes() == np.asarray(column.values).tobytes()
        assert frame.attrs["units"][column.label] == column.unit
    assert frame.attrs["title"].startswith("Table III")


def test_quantities_as_a_data_frame(crank) -> None:
    pytest.importorskip("pandas")
    frame = crank.to_pandas(["O.theta", "tip.position", "row.status"])
    expected = ["O.theta", *(f"tip.position.{axis}" for axis in "xyz"), "row.status"]
    assert list(frame.columns) == expected
    angles = np.deg2rad([0.0, 45.0, 90.0])
    assert frame["tip.position.y"].to_numpy() == pytest.approx(2 * np.sin(angles), abs=1e-15)
    assert frame.attrs["units"]["tip.position.y"] == "m"
    assert list(frame["row.status"]) == ["ok"] * 3


def test_the_only_table_needs_no_name(crank) -> None:
    pytest.importorskip("pandas")
    assert mk.loads(files.CRANK).analyze().to_pandas().attrs["name"] == "sweep"
    with pytest.raises(mk.UsageError, match=r"which table.*tables are tip, drive"):
        crank.to_pandas()
    with pytest.raises(mk.UsageError, match="there is no 'tipp' here"):
        crank.to_pandas("tipp")


def test_without_pandas_it_says_what_to_install(crank, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(mk.UsageError, match=r"pip install 'mechkin\[pandas\]'"):
        crank.to_pandas("tip")


def test_help_shows_what_there_is() -> None:
    command = [sys.executable, "-P", "-c", "import mechkin_cli as mk; help(mk)"]
    said = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout
    for name in mk.__all__:
        assert re.search(rf"\b{name}\b", said), name
    public = [name for name in dir(mk.Analysis) if not name.startswith("_")]
    methods = {name for name in public if callable(getattr(mk.Analysis, name))}
    methods |= {
        name for name in dir(mk.Model) if name[0] != "_" and callable(getattr(mk.Model, name))
    }
    described = mk.__doc__ or ""
    hidden = {
        "live_record",
        "of",
        "response",
        "response_graph",
        "session_of",
    }  # what other rooms call
    assert [name for name in sorted(methods - hidden) if f".{name}(" not in described] == []


def test_the_public_names_are_listed() -> None:
    command = [sys.executable, "-P", "-c", "import mechkin_cli as mk; print(*dir(mk))"]
    said = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout
    assert set(said.split()) == set(mk.__all__)
