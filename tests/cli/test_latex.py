"""`--format tex`: the numbers are those of the CSV, the text is LaTeX whatever it says."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pytest

HOSTILE = r"50% {x}_1 \input{/etc/passwd} $y$ & #1 ~ ^ [z] *q* `a' <b> | \\ end"
# two rows are beyond a dead centre; the last table is longer than a page
FOUR_BAR = """\
format: 1
name: four-bar
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
links:
  crank: {}
  coupler: {}
  rocker: {mass: 2, center_of_mass: [150, 40], inertia: 4000}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, coupler], point: [60, 0]}
  C: {type: R, links: [coupler, rocker], point: [140, 80]}
  D: {type: R, links: [ground, rocker], point: [160, 0]}
motion:
  inputs: {A.theta: {from: 0, to: TO, step: STEP, rate: 10 rad/s}}
tables:
  - name: drive
    title: 'TITLE'
    summary: [max, peak, rms]
    columns:
      - {label: 'LABEL', value: A.theta, decimals: 0}
      - {label: torque, value: A.effort, decimals: 2}
      - {label: small, value: A.effort*1e-12}
      - {label: load, value: D.force.y}
      - {label: ok, value: row.status}
"""
BACKSLASHED = re.compile(r"\\[a-zA-Z]+(?:\{\})?|\\.")


def text(to: str = "300", step: str = "15", title: str = "Drive", label: str = "theta") -> str:
    """The file."""
    quoted = {"TITLE": title.replace("'", "''"), "LABEL": label.replace("'", "''")}
    words = {"TO": to, "STEP": step, **quoted}
    return re.sub("TO|STEP|TITLE|LABEL", lambda found: words[found[0]], FOUR_BAR)


def table_rows(tex: str, number: int = 0) -> list[list[str]]:
    """The cells of a tabular, heads first."""
    inside = re.findall(r"\\toprule\n(.*?)\\bottomrule\n\\end\{tabular\}", tex, re.DOTALL)[number]
    lines = [line for line in inside.splitlines() if line.endswith(r"\\")]
    return [line.removesuffix(r" \\").split(" & ") for line in lines]


def value(cell: str) -> float:
    """The number that a reader sees."""
    plain = cell.replace("$-$", "-").replace(r"$\times10^{", "e").replace("}$", "")
    return float(plain)


@pytest.fixture
def both(mechkin, write, folder):
    """TeX and CSV of a file's first table."""

    def run(yaml: str) -> tuple[str, list[list[str]]]:
        mechkin("analyze", write("bar.yaml", yaml), "--format", "tex,csv")
        out = Path(folder) / "out" / "bar"
        rows = list(csv.reader((out / "drive.csv").read_text(encoding="utf-8").splitlines()))
        return (out / "drive.tex").read_text(encoding="utf-8"), rows

    return run


def test_numbers_are_those_of_the_csv(both) -> None:
    tex, rows = both(text())
    found = table_rows(tex)[1:]
    assert len(found) == len(rows) - 1 == 21
    compared = 0
    for cells, numbers in zip(found, rows[1:], strict=True):
        assert cells[-1] == numbers[-1].replace("_", r"\_")
        for cell, number in zip(cells[:-1], numbers[:-1], strict=True):
            assert (cell == "--") == (number == "")
            if number:
                digits = len(cell.partition("$\\times")[0].partition(".")[2])
                scale = 10.0 ** int(cell.partition("^{")[2].rstrip("}$") or 0)
                close = 0.5000001 * 10.0**-digits * scale
                assert value(cell) == pytest.approx(float(number), rel=0, abs=close)
                compared += 1
    assert compared > 30


def test_decimals_of_a_column_stand_in_line(both) -> None:
    tex, _ = both(text())
    for column in zip(*table_rows(tex)[1:], strict=True):
        numbers = [cell.partition("$\\times")[0] for cell in column if re.search(r"\d", cell)]
        assert len({len(cell.partition(".")[2]) for cell in numbers}) <= 1


def test_heads_have_units_and_the_rules_are_those_of_booktabs(both) -> None:
    tex, _ = both(text())
    head = table_rows(tex)[0]
    assert head[0] == r"theta {[}$^{\circ}$]"
    assert head[1] == r"torque {[}N\,mm]"
    assert head[4] == "ok"
    assert r"\begin{tabular}{rrrrl}" in tex
    assert tex.startswith("% \\usepackage{booktabs}\n\\begin{table}\n")
    assert tex.count(r"\toprule") == tex.count(r"\midrule") == tex.count(r"\bottomrule") == 2
    assert r"\hline" not in tex


def test_verdicts_are_notes(both) -> None:
    tex, rows = both(text())
    notes = tex.partition(r"\begin{flushleft}")[2]
    beyond = [row[-1] for row in rows[1:] if row[-1] != "ok"]
    assert beyond
    assert all(status.replace("_", r"\_") in notes for status in beyond)
    assert r"\par" in notes


def test_the_summary_stands_below_as_a_table(both) -> None:
    tex, _ = both(text())
    summary = table_rows(tex, 1)
    rows = table_rows(tex)[1:]
    assert [row[0] for row in summary] == ["", "max", "at", "peak", "at", "rms", "rows"]
    torques = [value(row[1]) for row in rows if row[1] != "--"]
    assert value(summary[1][1]) == max(torques)
    assert abs(value(summary[3][1])) == max(map(abs, torques))


def test_a_table_longer_than_a_page_is_broken_over_pages(both) -> None:
    tex, rows = both(text(to="60", step="1"))
    assert len(rows) == 62
    assert tex.count(r"\begin{longtable}{rrrrl}") == tex.count(r"\end{longtable}") == 1
    assert r"\begin{table}" not in tex
    body = tex.partition(r"\endfoot")[2].partition(r"\end{longtable}")[0]
    assert len([line for line in body.splitlines() if line]) == 61
    assert tex.count(r"torque {[}N\,mm]") == 3  # on the first page, on all others, in the summary


def test_hostile_texts_stay_texts(both) -> None:
    tex, _ = both(text(title=HOSTILE, label=HOSTILE))
    allowed = {
        *(r"\begin", r"\end", r"\centering", r"\caption", r"\label", r"\toprule", r"\midrule"),
        *(r"\bottomrule", r"\par", r"\medskip", r"\footnotesize", r"\circ", r"\times"),
        *(r"\textbackslash", r"\textasciitilde", r"\textasciicircum", r"\textless"),
        *(r"\textgreater", r"\textbar", r"\textasciigrave", r"\usepackage"),
    }
    assert set(re.findall(r"\\[a-zA-Z]+", tex)) <= allowed
    body = tex.partition("\n")[2]
    bare = BACKSLASHED.sub("", body)
    assert bare.count("{") == bare.count("}")
    assert not re.search(r"[#%_~`]", bare)
    # mathematics opens and closes in each line, and no row ends in options
    assert all(BACKSLASHED.sub("", line).count("$") % 2 == 0 for line in body.splitlines())
    assert not re.search(r"\\\\\s*[\[*]", body)
    caption = re.search(r"\\caption\{(.*)\}\\label", body)
    assert caption is not None
    assert caption[1].startswith(r"50\% \{x\}\_1 \textbackslash{}input\{/etc/passwd\} \$y\$ \& \#1")
