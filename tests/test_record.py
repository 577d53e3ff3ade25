"""The package's records mean what the library's mean."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import typing
from types import ModuleType
from typing import Any

import pytest

from mechkin_cli import record

SOURCE = """
class Pair(NamedTuple):
    a: int
    b: str = "b"
    c: tuple[int, ...] = ()

    def twice(self):
        return 2 * self.a

class Nothing(NamedTuple):
    pass

class Longer(Pair):
    def twice(self):
        return 4 * self.a

@dataclass
class Open:
    a: int
    b: list[int] = field(default_factory=list)

@dataclass(frozen=True)
class Point:
    x: float
    y: float = 0.0
    seen: dict[str, int] = field(default_factory=dict, init=False, repr=False, compare=False)

@dataclass(frozen=True)
class Named(Point):
    name: str = "n"

    def __post_init__(self):
        if not self.name:
            raise ValueError("no name")

@dataclass(frozen=True, slots=True)
class Small:
    a: int
    b: int = 2

@dataclass(frozen=True, eq=False)
class Same:
    a: int

@dataclass(frozen=True, repr=False)
class One:
    a: int
"""
CASES = [
    "Pair(1)",
    "Pair(1, c=(2,))",
    "Pair(b='x', a=3)._replace(b='y')",
    "Pair(1)._asdict()",
    "Pair(1) == (1, 'b', ())",
    "Pair._make([1, 2, 3])",
    "Pair._make([1])",
    "Pair(1)._replace(d=1)",
    "Pair()",
    "Pair(1, 2, 3, 4)",
    "Pair(1, d=4)",
    "Pair._fields, Pair._field_defaults, Pair.__match_args__",
    "Pair(4).twice(), Longer(4).twice(), Longer(4)",
    "hasattr(Pair(1), '__dict__'), Pair.__bases__ != (), isinstance(Pair(1), tuple)",
    "setattr(Pair(1), 'a', 2)",
    "Nothing(), Nothing._fields",
    "Open(1), Open(1, [2]), Open(1) == Open(1), Open(1) == Open(2)",
    "hash(Open(1))",
    "Open()",
    "Point(1.0), Point(1.0) == Point(1.0, 0.0), hash(Point(1.0)) == hash(Point(1.0))",
    "Point(1.0).seen",
    "setattr(Point(1.0), 'x', 2.0)",
    "delattr(Point(1.0), 'x')",
    "Point(1.0) == Named(1.0)",
    "Named(1.0, 2.0, 'm'), Named(1.0).name, Named(1.0) == Named(1.0)",
    "Named(1.0, name='')",
    "replace(Named(1.0), y=5.0)",
    "replace(Named(1.0), seen={})",
    "replace(Named(1.0), z=5.0)",
    "[one.name for one in fields(Named)], [one.name for one in fields(Named(1.0))]",
    "is_dataclass(Named), is_dataclass(Pair), is_dataclass(Named(1.0))",
    "Named.__match_args__",
    "asdict(Named(1.0)), asdict(Open(1, [2])), asdict(Open(Small(1), [Small(2), 3]))",
    "Small(1), Small(1) == Small(1, 2), hash(Small(1)) == hash(Small(1)), {Small(1): 1}[Small(1)]",
    "hasattr(Small(1), '__dict__')",
    "Same(1) == Same(1)",
    "One(1) == One(1), hash(One(1)) == hash(One(1))",
]


def made(library: Any) -> dict[str, Any]:
    module = ModuleType("made")
    vars(module).update(library)
    exec(compile("from __future__ import annotations\n" + SOURCE, "made", "exec"), vars(module))
    return vars(module)


OWN = made({name: getattr(record, name) for name in dir(record) if name[0] != "_"})
THEIRS = made(vars(dataclasses) | {"NamedTuple": typing.NamedTuple})


def outcome(text: str, names: dict[str, Any]) -> str:
    try:
        return repr(eval(text, names))
    except Exception as error:
        return f"{type(error).__name__}: {error}"


@pytest.mark.parametrize("text", CASES)
def test_records_behave_as_those_of_the_library(text: str) -> None:
    own, theirs = outcome(text, OWN), outcome(text, THEIRS)
    # the library words what cannot be changed in several ways
    assert own.partition(":")[0] == theirs.partition(":")[0]
    if "Error" not in own:
        assert own == theirs


@pytest.mark.parametrize("text", ["Point(1.0, 2.0)", "Named(1.0)", "Small(3)", "Open(1, [2])"])
def test_the_library_takes_them(text: str) -> None:
    one = eval(text, OWN)
    assert dataclasses.is_dataclass(one)
    names = [field.name for field in dataclasses.fields(one)]
    assert names == [field.name for field in dataclasses.fields(eval(text, THEIRS))]
    assert dataclasses.replace(one) == one
    assert dataclasses.asdict(one) == dataclasses.asdict(eval(text, THEIRS))


@pytest.mark.parametrize("value", ["Pair(1)", "Point(1.0)", "Small(3)", "Open(1, [2])"])
def test_they_are_copied(value: str) -> None:
    one = eval(value, OWN)
    assert copy.copy(one) == one
    assert copy.deepcopy(one) == one


def test_they_are_pickled() -> None:
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.units.dimension import Dimension

    for one in (Diagnostic("a", "error", "b"), Dimension(length=1)):
        assert pickle.loads(pickle.dumps(one)) == one


def test_a_field_without_a_default_does_not_follow_one_with_a_default() -> None:
    with pytest.raises(TypeError):
        exec("class Wrong(NamedTuple):\n    a: int = 1\n    b: int\n", dict(OWN))
