"""Kept files with other numbers, whose fields get any text: what the page then shows is the
command's, byte for byte. `MECHKIN_RANDOM` says how many files; two else."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from live.test_cells import verdict_texts, with_values
from references import FILE_OF
from view.browser import Browser
from view.test_page_of_live_files import columns, told

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.verdict import SWEEP

FILES = int(os.environ.get("MECHKIN_RANDOM", "2"))
TEXTS = 6
"""Written into fields of each page."""

NUMBER = re.compile(r"(?<![\w.#\"'])-?\d+(?:\.\d+)?(?![\w.\"':])")

WRITE = """(async (name, text) => {
  const { dimensions } = window.mechkin;
  const row = [...document.querySelectorAll('#dimensions .dimension')]
    .find((each) => each.getAttribute('aria-label') === name);
  const field = row.querySelector('input[type=number]');
  const settled = new Promise((done) => {
    dimensions.addEventListener('settle', done, { once: true });
    setTimeout(done, 20000);
  });
  field.value = text;
  const isNumber = Number.isFinite(field.valueAsNumber);
  field.dispatchEvent(new Event('input'));
  field.dispatchEvent(new Event('change'));
  if (isNumber) await settled;
  return dimensions.values;
})"""


def altered(rng: np.random.Generator, text: str) -> str:
    """Some places and parameters a little other than in the file."""
    head, joints, rest = re.split(r"^(joints:)$", text, maxsplit=1, flags=re.MULTILINE)

    def other(found: re.Match[str]) -> str:
        if rng.random() > 0.1:
            return found[0]
        return f"{float(found[0]) * (1.0 + 0.02 * rng.standard_normal()):.6g}"

    end = re.search(r"^\w+:$", rest, flags=re.MULTILINE)
    at = end.start() if end else len(rest)
    return head + joints + NUMBER.sub(other, rest[:at]) + rest[at:]


def field_text(rng: np.random.Generator, own: float) -> str:
    """What someone may write: a number near the file's, a large step, or no sense at all."""
    size = abs(own) or 1.0
    kinds = [
        f"{own + 0.02 * size * rng.standard_normal():.6g}",
        f"{own + 0.3 * size * rng.standard_normal():.17g}",
        rng.choice(["0", "-1", "1e300", "-1e-300", "1e999", "x", "", "--", f"{-own:g}"]),
    ]
    return str(rng.choice(kinds, p=[0.5, 0.3, 0.2]))


@pytest.mark.parametrize("seed", range(FILES))
def test_whatever_is_written_the_page_shows_the_numbers_of_the_command(
    browser: Browser, tmp_path: Path, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    model, page = None, tmp_path / "page.html"
    while model is None:  # until a file is whole and its page computes
        name = str(rng.choice(list(FILE_OF)))
        model = shown(browser, page, name, altered(rng, FILE_OF[name].read_text(encoding="utf-8")))
    parameters = browser.evaluate("window.mechkin.dimensions.parameters")
    leaves = browser.evaluate("window.mechkin.data.live.left")
    for _ in range(TEXTS):
        one = parameters[rng.integers(len(parameters))]
        text = field_text(rng, one["value"])
        values = browser.evaluate(f"{WRITE}({one['name']!r}, {text!r})")
        changed = {each["name"]: values[each["name"]] for each in parameters}
        is_changed = any(changed[each["name"]] != each["value"] for each in parameters)
        # beside the name of a case that fails stands all that it takes to see it again
        compare(browser, model, changed if is_changed else {}, leaves, (seed, one["name"], text))
    browser.evaluate("window.mechkin.dimensions.resetAll()")
    # the browser complains of words in a field for numbers, and places beyond single precision are
    # nowhere in the picture
    expected = ("The specified value", "THREE.BufferGeometry.computeBoundingSphere()")
    assert [text for text in browser.told()["said"] if not text.startswith(expected)] == []


def shown(browser: Browser, page: Path, name: str, text: str) -> mk.Model | None:
    """The model of a file whose page is open; None where it has errors or computes nothing."""
    try:
        model = mk.loads(text, name, folder=FILE_OF[name].parent)
        model.view(page, modes=False)
    except (InvalidFile, UsageError):
        return None
    browser.open(page)
    return model if browser.evaluate("Boolean(window.mechkin.dimensions)") else None


def compare(
    browser: Browser, model: mk.Model, values: dict[str, float], leaves: Any, where: Any
) -> None:
    varied = with_values(model, values)
    analysis = varied.analyze() if SWEEP in model.runs else varied.respond()
    verdicts, mine = verdict_texts(analysis), told(browser)
    for table in analysis.tables:
        left = [one["label"] for one in leaves if one["table"] == table.name] if values else []
        theirs = columns(csv_bytes(table).decode(), left)
        assert columns(mine[table.name], left) == theirs, (where, values)
    rows = "rows" if SWEEP in model.runs else f"{model.runs[0]}.rows"
    left = [one["label"] for one in leaves if one["table"] == rows] if values else []
    kept = [label for label in verdicts if label not in left]
    header, *cells = columns(mine[rows], left)
    assert header == kept
    status = kept.index("status")
    assert [row[status] for row in cells] == verdicts["status"], (where, values)
