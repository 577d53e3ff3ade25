"""The same mechanism in random unit systems, in bare numbers or with units: the same answers.

The templates use every field of the schema that has a dimension, and every number in them matters.
`MECHKIN_RANDOM` multiplies the number of unit systems.
"""

from __future__ import annotations

import os
import random
import re
import tempfile
from collections.abc import Iterator
from functools import cache
from math import inf
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

import numpy as np
import pytest
from random_families.unit_systems import (
    WORDS,
    factor,
    places,
    random_words,
    with_number,
    written,
)

import mechkin_cli as mk
from mechkin_cli.building.tables import problem_of
from mechkin_cli.mechanism import is_told
from mechkin_cli.schema.base import DimensionRule, Section, fields_of
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.verdict import SWEEP

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
SI = {
    "length": "m",
    "angle": "rad",
    "mass": "kg",
    "force": "N",
    "time": "s",
    "angular_rate": "rad/s",
}
FOLDER = Path(__file__).parent / "unit_templates"
CURVES = {
    "push.csv": ("length", "force", [(0.0, 1.0), (0.02, 4.0), (0.04, 2.0), (0.06, 3.0)]),
    "slide.csv": ("time", "length", [(0.0, 0.0), (0.2, 0.03), (0.4, 0.05), (0.6, 0.02)]),
    "wind.csv": ("time", "force", [(0.0, 1.0), (0.2, 4.0), (0.4, 2.0), (0.6, 3.0)]),
    "brake.csv": ("angular_rate", "moment", [(-20.0, 0.3), (0.0, 0.1), (9.0, -0.4), (20.0, -0.9)]),
    "swirl.csv": ("time", "moment", [(0.0, 0.1), (0.2, 0.4), (0.4, 0.2), (0.6, 0.3)]),
}
"""CSV files beside the templates: kinds and rows in SI."""
TEMPLATES = {path.stem: path.read_text() for path in sorted(FOLDER.glob("*.template"))}
ROUNDING = 1e-10
"""Parts of the largest number of its kind: conversions round at 1e-16, conditions are below 1e3."""

KIND_OF_DIMENSION = {
    "length": "length",
    "angle": "angle",
    "time": "time",
    "length/time": "velocity",
    "length/time^2": "acceleration",
    "length/time^3": "jerk",
    "angle/time": "angular_rate",
    "angle/time^2": "angular_acceleration",
    "angle/time^3": "angular_jerk",
    "mass*length/time^2": "force",
    "mass*length^2/time^2": "moment",
    "mass*length^2/time^3": "power",
    "mass/length/time^2": "pressure",
    "": "number",
}
NEITHER = ("row.", "transmission_angle", ".mechanical_advantage", ".finite_", ".screw_")
"""Quantities left out: verdicts, and what is no matter of units."""
COEFFICIENTS = (".per_acceleration", ".per.", ".without_acceleration", ".reduced_inertia")
"""Left out of responses and of sweeps with many inputs, for time's sake."""
ENERGIES = ("row.kinetic_energy", "row.potential_energy", "row.work", "row.dissipated")
BALANCES = {
    "work": "moment",
    "drive": "moment",
    "work_fluctuation": "moment",
    **dict.fromkeys(("flywheel", "estimate", "least_inertia", "largest_inertia"), "inertia"),
    **dict.fromkeys(("cosine", "sine", "amplitude"), ""),
}
"""Kinds of columns of balances; harmonics have the kind that their table is called by."""

Answers = dict[str, tuple[str, np.ndarray[Any, Any]]]


def answers(
    which: str,
    folder: Path,
    words: dict[str, str],
    rng: random.Random,
    explicit: float,
    text: str = "",
) -> Answers:
    """Kind and SI values of all quantities, by name."""
    for file, (x, y, rows) in CURVES.items():
        lines = [f"{a / factor(x, words)!r},{b / factor(y, words)!r}" for a, b in rows]
        (folder / file).write_text("\n".join(["x,y", *lines]) + "\n")
    (folder / "m.yaml").write_text(written(text or TEMPLATES[which], words, rng, explicit))
    model = mk.load(folder / "m.yaml")
    found = dict(each for run in model.runs for each in read(model, run, words))
    return found | dict(cams_of(model, words)) | dict(shown(model, words))


@cache
def wanted_of(which: str) -> Answers:
    """The answers of a template in SI."""
    with tempfile.TemporaryDirectory() as folder:
        return answers(which, Path(folder), SI, random.Random(which), 0.0)


def read(model: mk.Model, run: str, words: dict[str, str]) -> Iterator[tuple[str, Any]]:
    """The quantities and tables of a run, whose columns are plain numbers, and the balances of a
    sweep."""
    known = problem_of(model.problem, run).quantities()
    has_few = run == SWEEP and len(model.built.file.motion.inputs) <= 3
    neither = NEITHER if has_few else NEITHER + COEFFICIENTS
    kinds = {
        name: kind_of(str(found.dimension))
        for name, found in known.items()
        if is_told(name)
        if name in ENERGIES or not any(part in name for part in neither)
        if name not in model.problem.parameters
    }
    if run == SWEEP:
        found = model.analyze(list(kinds))
    elif model.response(run).search is None:
        found = model.respond(run, list(kinds))
    else:
        found = model.equilibrium(run, list(kinds))
    assert set(found["row.status"]) == {"ok"}, (run, words)
    for name, kind in kinds.items():
        yield f"{run}: {name}", (kind, np.asarray(found[name]) * factor(kind, words))
    asked = {table.name for table in model.built.file.tables}
    for table in found.tables:
        for column in table.columns if table.name in asked else ():
            yield f"{table.name}: {column.label}", ("", np.asarray(column.values))
    for name, table in found.balances.items():
        for label, own in BALANCES.items():
            if label in table:
                kind = own or name
                yield f"{name}: {label}", (kind, np.asarray(table[label]) * factor(kind, words))


def cams_of(model: mk.Model, words: dict[str, str]) -> Iterator[tuple[str, Any]]:
    """The cams of all followers."""
    for name, coupling in model.built.file.couplings.items():
        if getattr(coupling, "follower", None) is not None:
            cam = model.cam(name, points=30)
            length, angle = factor("length", words), factor("angle", words)
            yield f"{name}: profile", ("length", np.asarray(cam.profile) * length)
            yield f"{name}: radius", ("", 1.0 / (np.asarray(cam.radius) * length))
            yield f"{name}: pressure angle", ("angle", np.asarray(cam.pressure_angle) * angle)


def shown(model: mk.Model, words: dict[str, str]) -> Iterator[tuple[str, Any]]:
    """What a page is told of sizes and directions, which is in SI whatever the file's units, and
    of its sliders, which is in these."""

    def numbers(value: Any) -> Iterator[float]:
        if isinstance(value, float):
            yield value
        elif isinstance(value, (tuple, list)):
            for item in value:
                yield from numbers(item)

    settings = model.view_settings
    for name in ("joint_radius", "arrow_length", "camera", "speed", "between", "shapes"):
        given = getattr(settings, name)
        for number, value in enumerate(given.values() if name == "shapes" else [given]):
            yield f"{name} {number}", (name, np.array([*numbers(value)]))
    for name, ends in settings.parameters.items():
        kind = kind_of(str(model.problem.parameters[name].dimension))
        yield f"slider of {name}", (kind, np.array(ends) * factor(kind, words))


def kind_of(dimension: str) -> str:
    """The kind of a dimension; of other quotients powers of mass and length, angles in rad."""
    if dimension in KIND_OF_DIMENSION:
        return KIND_OF_DIMENSION[dimension]
    found = re.findall(r"(/?)([a-z]+)(?:\^([0-9]+))?", dimension)
    powers = [(name, f"{'-' if over else ''}{power or 1}") for over, name, power in found]
    assert {name for name, _ in powers} <= {"mass", "length", "angle", "time"}, dimension
    words = (
        name if power == "1" else f"{name}^{power}" for name, power in powers if name != "angle"
    )
    return " ".join(words) or "number"


def worst(found: Answers, wanted: Answers) -> float:
    """The largest difference in parts of the largest number of its kind."""
    sizes: dict[str, float] = {}
    for kind, values in wanted.values():
        sizes[kind] = max(sizes.get(kind, 0.0), float(np.nanmax(np.abs(values), initial=0.0)))
    assert found.keys() == wanted.keys()
    if any(values.shape != wanted[name][1].shape for name, (_, values) in found.items()):
        return inf
    gone = {name: np.isnan(values) for name, (_, values) in wanted.items()}
    assert all(np.array_equal(np.isnan(found[name][1]), gone[name]) for name in gone)
    return max(
        float(np.nanmax(np.abs(values - wanted[name][1]), initial=0.0)) / (sizes[kind] or 1.0)
        for name, (kind, values) in found.items()
    )


@pytest.mark.parametrize("which", TEMPLATES)
@pytest.mark.parametrize("explicit", [0.0, 1.0, 0.5], ids=["bare", "with units", "mixed"])
def test_the_same_answers_in_any_units(which: str, explicit: float, tmp_path: Path) -> None:
    rng = random.Random(f"{which} {explicit}")
    wanted = wanted_of(which)
    for _ in range(3 * TIMES):
        words = random_words(rng)
        error = worst(answers(which, tmp_path, words, rng, explicit), wanted)
        assert error < ROUNDING, (words, error)


@pytest.mark.parametrize("entry", WORDS)
def test_each_unit_by_itself(entry: str, tmp_path: Path) -> None:
    """In a few templates each, in all with `MECHKIN_RANDOM=2`."""
    rng = random.Random(entry)
    few = rng.sample(sorted(TEMPLATES), 5 if TIMES == 1 else len(TEMPLATES))
    for which in few:
        wanted = wanted_of(which)
        for word in WORDS[entry]:
            assert worst(answers(which, tmp_path, SI | {entry: word}, rng, 0.0), wanted) < ROUNDING


@pytest.mark.parametrize("which", TEMPLATES)
def test_every_number_matters(which: str, tmp_path: Path) -> None:
    """A number that were read in a wrong unit would be seen: even a hundredth of it is.

    Of the many numbers of a long template every third is tried, or all with `MECHKIN_RANDOM=2`.
    """
    template = TEMPLATES[which]
    rng = random.Random(0)
    wanted = wanted_of(which)
    for place in list(places(template))[:: 3 if TIMES == 1 else 1]:
        if float(place[1]) == 0.0 or only_chooses(template, place):
            continue
        try:
            changed = answers(which, tmp_path, SI, rng, 0.0, with_number(template, place, 1.01))
        except mk.InvalidFile:  # as of a module that no longer goes with the distance of the axes
            continue
        assert worst(changed, wanted) > 100 * ROUNDING, place[0]


_CHOOSING = ("near:", "window:", "step:", "vector:", "axis:", "across:")


def only_chooses(template: str, place: re.Match[str]) -> bool:
    """Whether a number is a direction, or only says which rows, which assembly or how much of a
    curve or surface are meant."""
    before = template[: place.start()].splitlines()[-1]
    after = template[place.end() :].splitlines()[0]
    is_last_row = before.endswith("to: ") and "step:" in after
    is_first_moment = before.endswith("time: {from: ")
    directs = any(key in before for key in _CHOOSING)
    directs = directs or "backlash:" in before  # amid which a sweep stands
    is_end = ("curve:" in before or "surface:" in before) and re.search(
        r"(from: |to: |\b[uv]: \[[^]]*)$", before
    )
    return is_last_row or is_first_moment or directs or bool(is_end)


def dimensional_fields() -> set[tuple[str, str]]:
    """Section and key of every field of the schema that holds a number with a dimension."""
    found: set[tuple[str, str]] = set()
    waiting, seen = [MechanismFile], {MechanismFile}
    while waiting:
        section = waiting.pop()
        for key, field in fields_of(section).items():
            for part in parts(field.annotation):
                if isinstance(part, DimensionRule) and part.name != "dimensionless number":
                    found.add((declaring(section, field.name), key))
                elif isinstance(part, type) and issubclass(part, Section) and part not in seen:
                    seen.add(part)
                    waiting.append(part)
    return found


def used_fields(value: Any) -> Iterator[tuple[str, str]]:
    """The fields that a checked file gives a value."""
    if isinstance(value, Section):
        for key, field in fields_of(type(value)).items():
            given = getattr(value, field.name)
            if field.required or given != field.default:
                yield declaring(type(value), field.name), key
            yield from used_fields(given)
    elif isinstance(value, dict):
        for item in value.values():
            yield from used_fields(item)
    elif isinstance(value, tuple):
        for item in value:
            yield from used_fields(item)


def declaring(section: type[Section], name: str) -> str:
    return next(base.__name__ for base in section.__mro__ if name in base.__annotations__)


def parts(annotation: Any) -> Iterator[Any]:
    """The types and rules of an annotation."""
    if get_origin(annotation) is Annotated:
        inner, *rules = get_args(annotation)
        yield from rules
        yield from parts(inner)
    elif get_origin(annotation) in (Union, UnionType, dict, tuple):
        for argument in get_args(annotation):
            yield from parts(argument)
    else:
        yield annotation


def test_the_templates_use_every_dimensional_field(tmp_path: Path) -> None:
    used: set[tuple[str, str]] = set()
    for which in TEMPLATES:
        answers(which, tmp_path, SI, random.Random(0), 0.0)
        used.update(used_fields(mk.load(tmp_path / "m.yaml").built.file))
    wanted = dimensional_fields()
    assert len(wanted) > 100
    # directions of pulleys in space: those of the templates are in a plane
    assert wanted - used == {("PathPart", "axis"), ("PathPart", "swivel")}
