"""What a file does not mean does not change its tables: order, comments, style, quotes, extras."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import pytest
import yaml
from references import FILE_OF

import mechkin_cli as mk

FILES = ["rcsr", "bennett", "rchch"]
Data = dict[str, Any]


def read(name: str) -> Data:
    data: Data = yaml.load(FILE_OF[name].read_text(encoding="utf-8"), yaml.BaseLoader)
    for table in data.get("tables", ()):
        table.pop("published", None)
    return data


def written(data: Data, **style: Any) -> str:
    return str(yaml.dump(data, sort_keys=False, width=10**6, **style))


def shuffled(data: Any, dice: random.Random) -> Any:
    """The keys of fixed mappings in another order; names keep theirs, which are the rows of
    tables."""
    if isinstance(data, list):
        return [shuffled(item, dice) for item in data]
    if not isinstance(data, dict):
        return data
    keys = list(data)
    dice.shuffle(keys)
    return {key: shuffled(data[key], dice) for key in keys}


def in_another_order(data: Data) -> str:
    dice = random.Random(3)
    named = {"joints", "links"}
    moved: Data = shuffled({k: v for k, v in data.items() if k not in named}, dice)
    for key in named & data.keys():
        moved[key] = {name: shuffled(value, dice) for name, value in data[key].items()}
    return written(dict(reversed(moved.items())))


def with_comments(data: Data) -> str:
    lines = written(data).splitlines()
    return "# head\n" + "".join(f"{line}  # {i}: [odd, 'text'\n\n" for i, line in enumerate(lines))


def with_unused_parameters(data: Data) -> str:
    more = {"unused_a": "3 kg*m^2", "unused_b": "2*unused_a", "unused_c": "sqrt(2)"}
    return written({**data, "parameters": {**more, **data.get("parameters", {})}})


def with_units_spelled_out(data: Data) -> str:
    names = {"length": "m", "angle": "deg", "mass": "kg", "force": "N", "time": "s"}
    return written({**data, "units": {**names, **data.get("units", {})}})


CHANGES: dict[str, Callable[[Data], str]] = {
    "block style": lambda data: written(data, default_flow_style=False),
    "flow style": lambda data: written(data, default_flow_style=True),
    "single quotes": lambda data: written(data, default_style="'"),
    "double quotes": lambda data: written(data, default_style='"'),
    "another order of keys and sections": in_another_order,
    "comments": with_comments,
    "unused parameters": with_unused_parameters,
    "units spelled out": with_units_spelled_out,
}


def tables(text: str) -> list[Any]:
    analysis = mk.loads(text, "same.yaml").analyze()
    return [
        (table.name, table.title, [(c.label, c.unit, cells(c.values)) for c in table.columns])
        for table in analysis.tables
    ]


def cells(values: Any) -> Any:
    return values.texts() if hasattr(values, "texts") else values.tobytes()


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("change", CHANGES)
def test_the_tables_stay_bit_for_bit(name: str, change: str) -> None:
    data = read(name)
    assert tables(CHANGES[change](data)) == tables(written(data))


@pytest.mark.parametrize("name", FILES)
def test_what_it_means_does(name: str) -> None:
    data = read(name)
    first = next(iter(data["motion"]["inputs"].values()))
    key = "from" if "from" in first else "at"
    assert first[key] != "1.5"
    changed = written(data).replace(f"{key}: {first[key]}", f"{key}: 1.5", 1)
    changed = changed.replace(f"{key}: '{first[key]}'", f"{key}: 1.5", 1)
    assert tables(changed) != tables(written(data))
