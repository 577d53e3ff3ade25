"""Names of points stand wherever coordinates can, and mean the same numbers."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest
import yaml
from building.named_places import with_named_places
from building.sound import SOUND
from references import FILE_OF, MECHANISMS

import mechkin_cli as mk
from mechkin_cli import templates

LOADED = SOUND.replace("columns: [O.theta]", "columns: [D.s, O.effort, p.position.y]")
KEPT = sorted([*FILE_OF.values(), *Path(templates.__file__).parent.glob("*.yaml")])
Data = dict[str, Any]


def read(path: Path) -> Data:
    data: Data = yaml.load(path.read_text(encoding="utf-8"), yaml.BaseLoader)
    for table in data.get("tables", ()):
        table.pop("published", None)
    return data


def analyses(data: Data, folder: Path) -> list[mk.Analysis]:
    text = str(yaml.dump(data, sort_keys=False, width=10**6))
    model = mk.loads(text, "same.yaml", folder=folder)
    runs = [model.analyze()] if "motion" in data else []
    return [*runs, *(model.respond(name) for name in data.get("responses", {}))]


def cells(values: Any) -> Any:
    return values.texts() if hasattr(values, "texts") else values.tobytes()


def numbers(data: Data, folder: Path) -> list[Any]:
    found: list[Any] = []
    for run in analyses(data, folder):
        for table in run.tables:
            columns = [(column.label, cells(column.values)) for column in table.columns]
            found.append((table.name, columns))
    return found


@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.stem)
def test_every_file_kept_here_computes_the_same_bytes(path: Path) -> None:
    data = read(path)
    named = copy.deepcopy(data)
    if not with_named_places(named):
        pytest.skip("it has a chain and no places")
    assert numbers(named, path.parent) == numbers(data, path.parent)


def test_the_place_counts() -> None:
    data = yaml.load(LOADED, yaml.BaseLoader)
    before = numbers(data, MECHANISMS)
    with_named_places(data)
    data["points"]["place_1"]["at"] = ["0", "1", "0"]
    assert numbers(data, MECHANISMS) != before


def test_a_parameter_reaches_every_place_that_its_point_names() -> None:
    data = yaml.load(LOADED, yaml.BaseLoader)
    with_named_places(data)

    def longer(text: str) -> list[Any]:
        run = mk.loads(text).with_parameters({"r": "50 mm"}).analyze()
        return [cells(column.values) for column in run.tables[0].columns]

    assert longer(str(yaml.dump(data, sort_keys=False))) == longer(LOADED)
    assert longer(LOADED) != [cells(c.values) for c in mk.loads(LOADED).analyze().tables[0].columns]


def test_a_point_that_is_wrong_is_told_once_where_it_is_written() -> None:
    text = (
        SOUND.replace("center_of_mass: [0, 20, 0]", "center_of_mass: p")
        .replace("point: [0, r, 10]", "point: p")
        .replace("{p: {link: crank,", "{p: {link: crunk,")
    )
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    (error,) = caught.value.diagnostics
    assert error.code == "unknown-link"
    assert "did you mean crank?" in str(error)
