"""Data flows one way: a room knows only the rooms below it, and few rooms know a heavy library."""

from __future__ import annotations

from pathlib import Path

import pytest
from architecture.package import FILES, NAMES, ROOT, imports, room

BASE = {
    "arrays",
    "diagnostics",
    "elimination",
    "exact",
    "legible",
    "listing",
    "named",
    "nearest",
    "proof",
    "reductions",
    "regular_file",
    "runs",
    "status",
    "tolerances",
    "uniqueness",
    "version",
}
KERNEL = BASE | {"kernel"}
UNITS = BASE | {"units"}
TAPE = KERNEL | {"tape"}
EXPRESSIONS = TAPE | UNITS | {"expressions"}
MECHANISM = EXPRESSIONS | {"mechanism"}
SOLVER = MECHANISM | {"solver"}
FREEDOMS = SOLVER | {"freedoms"}
ANALYSIS = FREEDOMS | {"analysis"}
BUILDING = FREEDOMS | {"reading", "schema", "building", "tables.layout", "view.settings"}
VIEW = ANALYSIS | {"tables", "view"}
PLOTS = VIEW | {"plots"}
FITTING = BASE | {"fitting"}
STUDIES = BASE | {"tables", "studies"}
INTERFACE = BUILDING | PLOTS | {"fitting", "studies", "interface"}
BENCHMARK = INTERFACE | {"benchmark"}
ALLOWED = {
    **dict.fromkeys(BASE, BASE),
    "kernel": KERNEL,
    "units": UNITS,
    "tape": TAPE,
    "expressions": EXPRESSIONS,
    "reading": BASE | {"reading"},
    "schema": BASE | {"schema"},
    "mechanism": MECHANISM,
    "solver": SOLVER,
    "freedoms": FREEDOMS,
    "analysis": ANALYSIS,
    "tables": EXPRESSIONS | {"tables"},
    "building": BUILDING,
    "view": VIEW,
    "plots": PLOTS,
    "studies": STUDIES,
    "fitting": FITTING,
    "interface": INTERFACE,
    "benchmark": BENCHMARK,
    "templates": BASE | {"templates"},
    "cli": BENCHMARK | {"cli", "templates"},
    "__init__": INTERFACE,
    "__main__": {"cli"},
}
"""What each room may import: rooms, or single modules of a room."""

HOMES = {
    "yaml": {"reading"},
    "pydantic": {"schema"},
    "pydantic_core": {"schema"},
    "annotated_types": {"schema"},
    "typer": {"cli"},
    "click": {"cli"},
    "rich": {"cli"},
    "pandas": {"interface"},
    "scipy": {"benchmark", "studies", "fitting"},
    "pyarrow": {"studies"},
    "distributed": {"studies"},
    "pinocchio": {"benchmark"},
    "casadi": {"benchmark"},
    "mujoco": {"benchmark"},
    "matplotlib": {"plots"},
}
"""Libraries that only one room may import."""


def allowed(path: Path, module: str) -> bool:
    parts = module.split(".")[1:]
    known = ALLOWED[room(path)]
    return any(".".join(parts[: k + 1]) in known for k in range(len(parts)))


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_no_arrow_points_up(path: Path) -> None:
    wrong = [
        f"line {line}: {room(path)} -> {module}"
        for line, module in imports(path)
        if module.startswith("mechkin_cli.") and not allowed(path, module)
    ]
    assert wrong == []


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_libraries_stay_in_their_rooms(path: Path) -> None:
    wrong = [
        f"line {line}: {module}"
        for line, module in imports(path)
        if room(path) not in HOMES.get(module.split(".")[0], {room(path)})
    ]
    assert wrong == []


WITHIN_ANALYSIS = {
    "assembly": set(),
    "balances": {"derived", "sweep"},
    "dense": {"derived", "sweep"},
    "errors": {"derived", "response", "sweep"},
    "derived": set(),
    "mobility": {"assembly"},
    "modes": {"proof", "assembly"},
    "ranges": {"assembly"},
    "response": {"assembly", "sweep"},
    "sweep": {"assembly", "derived", "mobility", "proof"},
}
"""What each room of `analysis/` knows of the others: no circles."""


@pytest.mark.parametrize("path", [p for p in FILES if room(p) == "analysis"], ids=str)
def test_rooms_of_analysis_have_no_circles(path: Path) -> None:
    own = path.relative_to(ROOT).parts[1].removesuffix(".py")
    known = WITHIN_ANALYSIS.get(own, set()) | {own}
    others = [module.split(".")[2:3] for _, module in imports(path)]
    asked = {
        name[0]
        for name, (_, module) in zip(others, imports(path), strict=True)
        if module.startswith("mechkin_cli.analysis.") and name
    }
    assert asked <= known


def test_every_room_has_its_arrows() -> None:
    assert {room(path) for path in FILES} <= set(ALLOWED)
