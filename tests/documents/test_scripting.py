"""Every script of the pages on scripting and on fits runs and prints what its page says; the CI job
commits the tables of a changed file, and nothing where nothing has changed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from cli import files
from documents.reading import ROOT, blocks, page

PAGE = page("docs/scripting.md")
FITS = page("docs/fit_examples.md")
WITH_OUTPUT = re.compile(
    r"^## ([^\n]*)\n(?:(?!^## ).)*?^```python\n(.*?)^```\n+```text\n(.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
SCRIPTS = WITH_OUTPUT.findall(PAGE) + WITH_OUTPUT.findall(FITS)
SECONDS = 300.0


def lines(text: str) -> list[str]:
    return [line.rstrip() for line in text.strip().splitlines()]


def test_every_script_has_its_output() -> None:
    assert [code for _, code, _ in SCRIPTS] == blocks(PAGE, "python") + blocks(FITS, "python")
    assert len(SCRIPTS) == 8


@pytest.mark.parametrize(
    ("code", "printed"), [script[1:] for script in SCRIPTS], ids=[script[0] for script in SCRIPTS]
)
def test_a_script_prints_what_the_page_says(code: str, printed: str, tmp_path: Path) -> None:
    if "distributed" in code:
        pytest.importorskip("distributed")
    (tmp_path / "mechanisms").symlink_to(ROOT / "mechanisms")
    (tmp_path / "script.py").write_text(code)
    # -P: the installed package, not the source folder that the tests may be started in
    done = subprocess.run(
        [sys.executable, "-P", "-W", "error::DeprecationWarning:__main__", "script.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=SECONDS,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert lines(done.stdout) == lines(printed)


def git(folder: Path, *words: str) -> str:
    name = ["-c", "user.name=a", "-c", "user.email=a@localhost"]
    done = subprocess.run(
        ["git", *name, *words], cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_the_job_commits_the_tables_of_a_changed_file(tmp_path: Path) -> None:
    (workflow,) = blocks(PAGE, "yaml")
    steps = yaml.safe_load(workflow)["jobs"]["tables"]["steps"]
    assert all(("run" in step) != ("uses" in step) for step in steps)
    write, commit = (step["run"] for step in steps[-2:])

    def job() -> None:
        script = write.replace("mechkin ", f"{sys.executable} -P -m mechkin_cli ", 1)
        for run in (script, commit):
            subprocess.run(["bash", "-e", "-c", run], cwd=work, check=True, capture_output=True)

    server, work = tmp_path / "server", tmp_path / "work"
    git(tmp_path, "init", "--bare", "-b", "main", str(server))
    git(tmp_path, "clone", str(server), str(work))
    git(work, "checkout", "-B", "main")
    (work / "mechanisms").mkdir()
    file = work / "mechanisms" / "crank.yaml"
    file.write_text(files.CRANK + files.TABLES)
    git(work, "add", ".")
    git(work, "commit", "-m", "a crank")
    git(work, "push", "origin", "main")
    job()
    first = git(server, "show", "main:mechanisms/crank/tip.csv")
    job()
    assert git(server, "rev-list", "--count", "main") == "2"
    changed = files.CRANK.replace("r: 2 m", "r: 3 m")
    assert changed != files.CRANK
    file.write_text(changed + files.TABLES)
    job()
    assert git(server, "rev-list", "--count", "main") == "3"
    assert git(server, "show", "main:mechanisms/crank/tip.csv") != first
