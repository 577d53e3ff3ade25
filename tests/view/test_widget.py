"""The page in a notebook: what its cell shows, and the values that Python and the page share."""

from __future__ import annotations

import html
import json
import re

import numpy as np
import pytest
from view.test_following import CRANK

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError


def test_a_cell_shows_the_page_that_is_written(tmp_path) -> None:
    m = mk.loads(CRANK)
    page = m.view()
    written = m.view(tmp_path / "page.html")
    (inside,) = re.findall(r'srcdoc="([^"]*)"', page._repr_html_())
    assert html.unescape(inside) == page.html == written.read_text(encoding="utf-8")
    assert 'sandbox="allow-scripts allow-downloads allow-modals"' in page._repr_html_()
    assert page.write(tmp_path / "again.html").read_bytes() == written.read_bytes()
    assert re.fullmatch(r"Page of \d+ kB: write\(path\) makes a file of it", repr(page))
    assert m.analyze().view().html.startswith("<!doctype html>")


def tip(widget) -> list[float]:
    (found,) = json.loads(widget._data)["points"]
    return found["place"][:2]


def test_a_changed_value_is_shown_and_read() -> None:
    pytest.importorskip("anywidget")
    w = mk.loads(CRANK).widget(modes=False)
    assert (w.parameters, w.row, tip(w)) == ({"r": 40, "e": 20}, 0, [40, 20])
    w.parameters = {"r": "4.5 cm"}
    assert w.parameters == pytest.approx({"r": 45, "e": 22.5}, rel=1e-15)
    np.testing.assert_allclose(tip(w), [45, 22.5], rtol=1e-15)
    assert dict(w.model.parameters) == pytest.approx(w.parameters, rel=1e-15)
    w.parameters = {"e": 20.0}  # from now on of its own
    w.parameters = {"r": 41.0}
    assert w.parameters == {"r": 41, "e": 20}
    np.testing.assert_allclose(tip(w), [41, 20], rtol=1e-15)
    w.row = 2
    assert w.row == 2


def test_what_the_page_reaches_is_not_computed_here() -> None:
    pytest.importorskip("anywidget")
    w = mk.loads(CRANK).widget(modes=False)
    w._reach = ["r"]
    heard = []
    w.observe(lambda change: heard.append(change["new"]), "parameters")
    w._reach = ["r", "e"]
    w.parameters = {"r": 41.0, "e": 20.5}  # as the page sends it
    assert (heard, tip(w)) == ([{"r": 41, "e": 20.5}], [40, 20])
    assert w.model.parameters["r"] == 41
    w._reach = ["r"]
    w.parameters = {"e": 7.0}
    assert tip(w) == [41, 7]


def test_what_no_parameter_can_have_is_refused() -> None:
    traitlets = pytest.importorskip("traitlets")
    pytest.importorskip("anywidget")
    w = mk.loads(CRANK).widget(modes=False)
    for value, words in (({"rr": 1.0}, "mean r"), ({"r": float("nan")}, "nan"), ({"r": "x"}, "x")):
        with pytest.raises(traitlets.TraitError, match=words):
            w.parameters = value
    assert w.parameters == {"r": 40, "e": 20}


def test_without_anywidget_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    from mechkin_cli.view import notebook

    notebook._widget_class.cache_clear()
    monkeypatch.setitem(__import__("sys").modules, "anywidget", None)
    with pytest.raises(UsageError, match=r"pip install 'mechkin\[notebook\]'"):
        mk.loads(CRANK).widget(modes=False)
    notebook._widget_class.cache_clear()
