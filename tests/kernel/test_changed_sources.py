"""What a change of the sources does, proved on one copy of them with two changes.

A new pair: which files it touches. The copy passes the identity tests with it, and analyses a
quick-return mechanism with it, closed at the pair and carried by it, against elementary
trigonometry.

A fault in the balance of forces: half the gravity, which no other test of the copy has. The
efforts that follow are in equilibrium with what was taken, and do not fit the
energies: the balance of powers, which shares nothing with that of forces, shows it.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from math import atan2, cos, hypot, pi, sin
from pathlib import Path
from typing import Any

import pytest
from kernel.added_pair import ADDITIONS, GENERATED, LETTER, MECHANISM
from kernel.compiler import COMPILER, NARROW, TOOLS_HERE
from kernel.test_power_balance import MECHANISM as LOADED

ROOT = Path(__file__).parents[2]
KEPT = ("mechkin_cli", "schemas", "tests", "docs", "README.md", "LICENSE", "pyproject.toml")
SOURCE = "mechkin_cli/kernel/core/forces/wrenches.hpp"
WEIGHT = "const Wrench weight = force_at(centre, Pack(m.mass) * g);"
FAULT = WEIGHT.replace("Pack(m.mass)", "Pack(0.5) * Pack(m.mass)")
NEAR = 1e-13
"""Some roundings of coordinates of size one."""

OWN = "import sys; sys.meta_path[:] = [f for f in sys.meta_path if isinstance(f, type)]; "
"""Before an import: an editable installation answers for the package itself."""


def test_a_pair_is_known_to_few_files() -> None:
    """The files that name an existing pair of its own kernel entry are those that a new one
    touches."""
    named = [
        str(path.relative_to(ROOT))
        for folder in ("mechkin_cli", "schemas")
        for path in sorted((ROOT / folder).rglob("*"))
        if path.suffix in (".py", ".hpp", ".cpp", ".json", ".pyi")
        and any(quoted in path.read_text(encoding="utf-8") for quoted in ('"Cp"', "'Cp'"))
    ]
    expected = [file for file in ADDITIONS if file.startswith("mechkin_cli")]
    assert named == [*expected, *GENERATED]


def test_no_file_of_the_additions_knows_the_pair_yet() -> None:
    for file, additions in ADDITIONS.items():
        text = (ROOT / file).read_text(encoding="utf-8")
        assert f'"{LETTER}"' not in text
        for before, _ in additions:
            assert text.count(before) == 1, (file, before)


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sources with the new pair, built and installed in `site`."""
    if COMPILER is None:
        pytest.skip("no C++ compiler here")
    folder = tmp_path_factory.mktemp("copy")
    for name in KEPT:
        source = ROOT / name
        if source.is_dir():
            skipped = shutil.ignore_patterns("__pycache__", "*.so")
            shutil.copytree(source, folder / name, ignore=skipped)
        else:
            shutil.copy(source, folder / name)
    for file, additions in ADDITIONS.items():
        text = (folder / file).read_text(encoding="utf-8")
        for before, added in additions:
            text = text.replace(before, added + before)
        (folder / file).write_text(text, encoding="utf-8")
    text = (folder / SOURCE).read_text(encoding="utf-8")
    assert text.count(WEIGHT) == 1
    (folder / SOURCE).write_text(text.replace(WEIGHT, FAULT), encoding="utf-8")
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", NARROW]
    install += ["--no-build-isolation"] if TOOLS_HERE else []
    done = subprocess.run(
        [*install, "--target", str(folder / "site"), str(folder)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-4000:]
    return folder


def python(copy: Path, code: str, *arguments: str) -> str:
    """Runs Python on the copy; what it prints."""
    start = f"{OWN}sys.path[:0] = [{str(copy / 'site')!r}]; "
    command = [sys.executable, "-c", start + code, *arguments]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]
    return done.stdout


def test_the_new_pair_passes_the_identity_tests(copy: Path) -> None:
    run = "import pytest; sys.exit(pytest.main([*sys.argv[1:], '-p', 'no:cacheprovider']))"
    files = [f"tests/kernel/test_{name}_joints.py" for name in ("closing", "tree")]
    said = re.search(r"(\d+) passed", python(copy, run, *files, "-k", LETTER, "-v"))
    assert said is not None
    assert int(said[1]) >= 40
    python(copy, run, "tests/kernel/test_joint_table.py")


def test_the_json_schema_is_generated_with_it(copy: Path) -> None:
    run = "from mechkin_cli.__main__ import main; sys.argv[:] = ['mechkin', 'schema']; main()"
    text = python(copy, run)
    json.loads(text)
    assert f'"const": "{LETTER}"' in text


def analysed(copy: Path, driven: str, names: list[str]) -> dict[str, Any]:
    """Columns of the quick-return mechanism by name, and its mobility."""
    (copy / "quick_return.yaml").write_text(MECHANISM.replace("DRIVEN", driven), encoding="utf-8")
    code = (
        "import json, mechkin_cli as mk; m = mk.load('quick_return.yaml'); "
        "r = m.analyze(sys.argv[1:]); found = {n: r[n].tolist() for n in sys.argv[1:]}; "
        "found['mobility'] = m.mobility().mobility; print(json.dumps(found))"
    )
    return dict(json.loads(python(copy, code, *names)))


def test_a_quick_return_closed_at_the_pair(copy: Path) -> None:
    driven = "O.theta: {from: 0, to: 6.2, count: 63, rate: 1.5 rad/s}"
    found = analysed(copy, driven, ["O.theta", "Q.theta", "A.s", "A.theta", "A.s_dot"])
    assert found["mobility"] == 1
    for row, theta in enumerate(found["O.theta"]):
        x, y = cos(theta), sin(theta) + 2
        arm = atan2(y, x) - atan2(2, 1)
        assert found["A.s"][row] == pytest.approx(hypot(x, y) - hypot(1, 2), abs=NEAR)
        assert found["Q.theta"][row] == pytest.approx(arm, abs=NEAR)
        turns = (found["A.theta"][row] - (theta - arm)) / (2 * pi)
        assert turns == pytest.approx(round(turns), abs=NEAR)
        assert found["A.s_dot"][row] == pytest.approx(1.5 * 2 * cos(theta) / hypot(x, y), abs=NEAR)


def test_a_quick_return_driven_at_the_pair(copy: Path) -> None:
    """The slide is the input: the pair is carried and the loop closes elsewhere."""
    found = analysed(copy, "A.s: {from: 0, to: 0.4, count: 9}", ["A.s", "O.theta"])
    for slide, theta in zip(found["A.s"], found["O.theta"], strict=True):
        reach = hypot(1, 2) + slide
        assert sin(theta) == pytest.approx((reach * reach - 5) / 4, abs=NEAR)


def test_half_the_gravity_in_the_balance_of_forces_shows(copy: Path) -> None:
    """Without the fault the same mechanism balances to 1e-14 (`test_power_balance.py`)."""
    (copy / "loaded.yaml").write_text(LOADED, encoding="utf-8")
    code = (
        "import json, mechkin_cli as mk; r = mk.load('loaded.yaml').analyze(['A.effort']); "
        "print(json.dumps(r['row.power_error'].tolist()))"
    )
    assert min(json.loads(python(copy, code))) > 1e-3
