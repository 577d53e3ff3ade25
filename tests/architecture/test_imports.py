"""Data flows one way: a room knows the rooms before it, by their doors; no circle of files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from architecture.package import (
    FILES,
    ROOT,
    defined_names,
    imported_names,
    imports,
    of_every,
    offered_names,
    room,
)

BASE = {
    "arguments",
    "diagnostics",
    "exact",
    "lazy",
    "memo",
    "record",
    "row_notes",
    "show",
    "tolerances",
    "verdict",
}
"""What all rooms may know."""

ORDER = [
    "kernel",
    "units",
    "tape",
    "expressions",
    "reading",
    "schema",
    "mechanism",
    "idle",
    "structure",
    "plan",
    "tables",
    "session",
    "search",
    "assembly",
    "derived",
    "proofs",
    "mobility",
    "modes",
    "building",
    "sweep",
    "response",
    "statics",
    "vibration",
    "vibration",
    "balances",
    "errors",
    "cams",
    "view",
    "plots",
    "analysis",
    "variants",
    "sensitivities",
    "fit",
    "studies",
    "live",
    "model",
    "templates",
    "bridges",
    "bench",
    "cli",
]
"""The rooms; each knows those before it."""

HOMES = {
    "anywidget": {"view"},
    "traitlets": {"view"},
    "yaml": {"reading"},
    "pydantic": {"schema"},
    "pydantic_core": {"schema"},
    "annotated_types": {"schema"},
    "typer": {"cli"},
    "click": {"cli"},
    "rich": {"cli"},
    "pandas": {"analysis", "sensitivities", "studies"},
    "scipy": {"bench", "fit", "variants"},
    "pyarrow": {"tables"},
    "distributed": {"studies"},
    "matplotlib": {"analysis", "plots"},
    "ezdxf": {"bridges"},
}
"""Libraries that only some rooms may import."""

DOORLESS = {"bench", "cli", "kernel", "templates", "tolerances"}
"""Rooms whose modules are imported by name."""

PRODUCT = [path for path in FILES if room(path) not in {"bench", "templates"}]


def is_known(own: str, other: str) -> bool:
    if other in BASE or own == other or own.startswith("__"):
        return True
    if own in BASE:
        return other == "kernel"
    return ORDER.index(other) < ORDER.index(own)


@of_every(FILES)
def test_no_arrow_points_up(path: Path) -> None:
    wrong = [
        f"line {line}: {room(path)} -> {module}"
        for line, module in imports(path)
        if module.startswith("mechkin_cli.") and not is_known(room(path), module.split(".")[1])
    ]
    assert wrong == []


@of_every(PRODUCT)
def test_other_rooms_are_entered_by_the_door(path: Path) -> None:
    wrong = [
        f"line {line}: {module}"
        for line, module in imports(path)
        if module.startswith("mechkin_cli.")
        and module.count(".") > 1
        and module.split(".")[1] not in {room(path), *DOORLESS}
        and not room(path).startswith("__")
    ]
    assert wrong == []


@of_every(PRODUCT)
def test_a_room_does_not_enter_by_its_own_door(path: Path) -> None:
    door = f"mechkin_cli.{room(path)}"
    names = [name for module, name in imported_names(path) if module == door]
    wrong = [name for name in names if f"{door}.{name}" not in MODULES]
    assert wrong == [] or room(path) in DOORLESS


@of_every(FILES)
def test_libraries_stay_in_their_rooms(path: Path) -> None:
    wrong = [
        f"line {line}: {module}"
        for line, module in imports(path)
        if room(path) not in HOMES.get(module.split(".")[0], {room(path)})
    ]
    assert wrong == []


def test_every_room_has_its_place() -> None:
    known = {*BASE, *ORDER, "__init__", "__main__"}
    assert {room(path) for path in FILES} <= known


def module_of(path: Path) -> str:
    parts = path.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__")


MODULES = {module_of(path): path for path in PRODUCT}
DOORS = {module_of(path): path for path in PRODUCT if offered_names(path)}
"""The doors whose names are loaded when they are first used."""
OFFERED = {
    (module_of(path), name): module
    for path in PRODUCT
    if path.name == "__init__.py"
    for module, name in (*imported_names(path), *offered_names(path))
    if name != "*"
}
"""(room, name) -> the file that the door takes it from."""


def refused(path: Path, doors: dict[str, set[str]]) -> list[str]:
    """What a file takes from doors that do not offer it."""
    return [
        f"{module}: {name}"
        for module, name in imported_names(path)
        if name not in doors.get(module, {name}) and f"{module}.{name}" not in MODULES
    ]


@of_every(FILES)
def test_doors_offer_what_is_taken_from_them(path: Path) -> None:
    """For type checkers a door has all public names of its chapters."""
    assert refused(path, {d: {n for _, n in offered_names(p)} for d, p in DOORS.items()}) == []


def test_a_name_behind_the_door_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "probe.py"
    path.write_text("from mechkin_cli.session import Session, hidden\n", encoding="utf-8")
    assert refused(path, {"mechkin_cli.session": {"Session"}}) == ["mechkin_cli.session: hidden"]


@pytest.mark.parametrize("door", sorted(DOORS))
def test_type_checkers_find_the_names_of_doors_where_they_are_loaded(door: str) -> None:
    """Every chapter is imported for type checkers, and none as a whole that has a name which the
    door takes from another."""
    offered = offered_names(DOORS[door])
    imported = set(imported_names(DOORS[door]))
    missing = [
        f"{module}: {name}"
        for module, name in offered
        if not {(module, "*"), (module, name)} & imported
    ]
    assert missing == []
    twice = [
        f"{module}: {name}"
        for module, star in imported
        if star == "*"
        for name in defined_names(MODULES[module])
        if OFFERED.get((door, name), module) != module
    ]
    assert twice == []


def files_known(path: Path) -> Iterator[str]:
    """The files that one depends on, by whatever kind of import, through doors."""
    own = module_of(path)
    for module, name in imported_names(path):
        found = OFFERED.get((module, name), module)
        found = f"{found}.{name}" if f"{found}.{name}" in MODULES else found
        if found in MODULES and found != own and MODULES[found].name != "__init__.py":
            yield found


def circles(known: dict[str, set[str]]) -> list[set[str]]:
    """Sets of files each of which depends on all others of its set (Tarjan)."""
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    stack: list[str] = []
    found = []

    def visit(own: str) -> None:
        number[own] = lowest[own] = len(number)
        stack.append(own)
        for other in known.get(own, ()):
            if other not in number:
                visit(other)
                lowest[own] = min(lowest[own], lowest[other])
            elif other in stack:
                lowest[own] = min(lowest[own], number[other])
        if lowest[own] == number[own]:
            at = stack.index(own)
            if len(stack) - at > 1:
                found.append(set(stack[at:]))
            del stack[at:]

    for own in known:
        if own not in number:
            visit(own)
    return found


def test_no_circle_of_files() -> None:
    """Imports for type checkers and inside functions counted."""
    known = {module_of(path): set(files_known(path)) for path in PRODUCT}
    assert circles(known) == []


def test_a_circle_is_seen() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == [{"a", "b", "c"}]
