"""What a release is made of: pinned steps, few rights, all platforms, one ABI from Python 3.12."""

from __future__ import annotations

import re
import tomllib
from typing import Any

import yaml
from documents.reading import ROOT

WORKFLOW = ROOT / ".github/workflows/release.yml"
TEXT = WORKFLOW.read_text(encoding="utf-8")
JOBS: dict[str, Any] = yaml.safe_load(TEXT)["jobs"]
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_every_action_is_pinned_and_names_its_version() -> None:
    uses = re.findall(r"uses: (\S+)(.*)", TEXT)
    assert len(uses) > 5
    for action, behind in uses:
        assert re.fullmatch(r"[\w-]+/[\w.-]+@[0-9a-f]{40}", action), action
        assert re.fullmatch(r" # v\d+\.\d+\.\d+", behind), action
    for tool in re.findall(r"pipx run (\S+)", TEXT):
        assert re.fullmatch(r"[\w-]+==[\d.]+", tool), tool


def test_only_the_last_step_may_publish() -> None:
    assert yaml.safe_load(TEXT)["permissions"] == {"contents": "read"}
    rights = {name: job.get("permissions") for name, job in JOBS.items()}
    assert rights == {
        "sources": None,
        "wheels": None,
        "publish": {"id-token": "write", "attestations": "write"},
    }
    publish = JOBS["publish"]
    assert publish["if"] == "github.ref_type == 'tag'"
    assert publish["needs"] == ["sources", "wheels"]
    assert not [step for step in publish["steps"] if "checkout" in step.get("uses", "")]
    assert "secrets." not in TEXT


def test_every_platform_of_the_page_has_its_wheel() -> None:
    built = {one["name"] for one in JOBS["wheels"]["strategy"]["matrix"]["include"]}
    page = (ROOT / "docs/versions.md").read_text(encoding="utf-8")
    told = re.findall(r"^\| `([\w-]+)`", page, re.MULTILINE)
    assert built == {*told}


def test_the_stable_abi_begins_where_nanobind_has_it() -> None:
    (override,) = PROJECT["tool"]["scikit-build"]["overrides"]
    assert override == {"if": {"python-version": ">=3.12"}, "wheel": {"py-api": "cp312"}}
    cmake = (ROOT / "mechkin_cli/kernel/python/CMakeLists.txt").read_text(encoding="utf-8")
    assert "${SKBUILD_SABI_COMPONENT}" in cmake
    assert "nanobind_add_module(_kernel STABLE_ABI" in cmake


def test_pythons_are_those_that_are_promised() -> None:
    wheels = PROJECT["tool"]["cibuildwheel"]["build"]
    assert wheels == [f"cp3{minor}-*" for minor in range(11, 15)]
    assert PROJECT["project"]["requires-python"] == ">=3.11"
    assert "Python 3.11 to 3.14" in (ROOT / "docs/versions.md").read_text(encoding="utf-8")
    assert "3.11 3.12 3.13 3.14" in (ROOT / ".ci/versions").read_text(encoding="utf-8")


def test_one_version_everywhere() -> None:
    import mechkin_cli as mk

    (heading,) = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.M)[:1]
    cited = re.search(r"^version: (\S+)", (ROOT / "CITATION.cff").read_text("utf-8"), re.M)
    assert cited is not None
    assert heading == cited[1] == mk.__version__
