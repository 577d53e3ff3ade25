"""`--format tex`, compiled by LaTeX itself; where there is none, the tests are skipped with a word.

Whatever a title, a label or a unit says, LaTeX finds nothing to complain of.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from sweep.dead_centre_texts import spatial

from tests.cli.test_latex import HOSTILE, text

DOCUMENT = r"""
\documentclass{article}
\usepackage[T1]{fontenc}
\usepackage{booktabs,longtable}
\pagestyle{empty}
\begin{document}
See Table~\ref{tab:NAME}.
\input{NAME.tex}
\end{document}
"""
UNITS = """
  - name: t
    title: units
    columns:
      - {label: I, value: "1 kg*mm^2 + 0*D.effort*1 s^2"}
      - {label: rate, value: D.theta_dot}
      - {label: root, value: sqrt(2*D.effort/(3 kg))}
      - {label: inverse, value: 1/(A.theta_dot*1 m^3)}
      - {label: verdict, value: row.status}
      - {label: effort, value: D.effort, decimals: 0}
    summary: [max, min, mean]
"""


def missing() -> str | None:
    """What is not on this machine, in words."""
    if shutil.which("pdflatex") is None:
        return "LaTeX is not installed (texlive-latex-base)"
    found = subprocess.run(["kpsewhich", "booktabs.sty"], capture_output=True, check=False)
    return None if found.stdout else "the package booktabs is not there (texlive-latex-recommended)"


def compiled(folder: Path, name: str) -> str:
    """The log of LaTeX, which runs twice for the references."""
    if reason := missing():
        pytest.skip(f"tables are not compiled: {reason}")
    (folder / "paper.tex").write_text(DOCUMENT.replace("NAME", name), encoding="utf-8")
    for _ in range(2):
        done = subprocess.run(
            ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "paper"],
            cwd=folder,
            capture_output=True,
            timeout=120,
            check=False,
        )
        assert done.returncode == 0, done.stdout.decode(errors="replace")[-2000:]
    return (folder / "paper.log").read_text(encoding="latin-1")


def complaints(log: str) -> list[str]:
    """Lines of a log that complain; a table may be wider than the page."""
    words = ("LaTeX Warning", "Missing", "undefined", "Package", "! ")
    known = ("Overfull", "Package: ")
    return [
        line
        for line in log.splitlines()
        if any(word in line for word in words) and not line.startswith(known)
    ]


@pytest.mark.parametrize(("to", "step"), [("300", "60"), ("300", "2")], ids=["short", "long"])
def test_hostile_texts(mechkin, write, folder, to: str, step: str) -> None:
    yaml = text(to, step, f"{HOSTILE} (title)", f"{HOSTILE} (label)")
    mechkin("analyze", write("bar.yaml", yaml), "--format", "tex")
    assert complaints(compiled(Path(folder) / "out" / "bar", "drive")) == []


def test_infinite_cells_and_units(mechkin, write, folder) -> None:
    yaml = spatial("RCSR")
    yaml = yaml[: yaml.index("tables:")] + "tables:" + UNITS
    mechkin("analyze", write("crank.yaml", yaml), "--format", "tex")
    made = Path(folder) / "out" / "crank"
    assert r"$-\infty$" in (made / "t.tex").read_text(encoding="utf-8")
    assert complaints(compiled(made, "t")) == []
