"""Questions to a model, and their answers as bytes: the same on a fresh model, in whatever order.

`python tests/session/questions.py 3000` asks so many in random order of all kept mechanisms.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

import mechkin_cli as mk

MECHANISMS = Path(__file__).parents[2] / "mechanisms"

Question = Callable[..., object]


def kept() -> list[Path]:
    """The files of all kept mechanisms."""
    return sorted(path for path in MECHANISMS.rglob("*.yaml") if path.parent.name != "studies")


def plain(value: object, depth: int = 0) -> object:
    """What an answer holds, by value; floats by their bits."""
    if depth > 12:
        raise RecursionError(f"{type(value)} has no end")
    if isinstance(value, float | np.floating):
        return float(value).hex()
    if value is None or isinstance(value, str | int | bool | np.integer | np.bool_):
        return str(value)
    if isinstance(value, np.ndarray):
        if value.dtype == object:
            return [plain(each, depth + 1) for each in value.ravel()]
        return value.shape, value.tobytes()
    if isinstance(value, Mapping):
        return [(str(k), plain(v, depth + 1)) for k, v in value.items()]
    if isinstance(value, tuple | list):
        return [plain(each, depth + 1) for each in value]
    if is_dataclass(value) and not isinstance(value, type):
        shown = [f.name for f in fields(value) if f.repr]
        return [(name, plain(getattr(value, name), depth + 1)) for name in shown]
    return str(value)


def rows(analysis: Any) -> object:
    """Everything of a run but how long it took."""
    texts = [
        (table.name, [plain(column.values) for column in table.columns])
        for table in analysis.tables
    ]
    quantities = [(name, plain(analysis[name])) for name in analysis]
    said = [str(each) for each in analysis.diagnostics]
    return texts, quantities, said, plain(analysis.result.letter), analysis.complete


def questions(model: mk.Model, random_: random.Random) -> Iterator[tuple[str, Question]]:
    """One question of each kind that the mechanism has, with arguments drawn."""
    runs = [run for run in model.runs if run != "sweep"]
    mode = random_.choice(["A", "B", "C", "Z"])
    names = sorted(model.quantities)
    some = random_.sample(names, min(3, len(names)))
    if "sweep" in model.runs:
        cut = random_.choice([*model.problem.mechanism.joints, "nowhere"])
        lanes, threads = random_.choice([1, 2, 4]), random_.choice([1, 2])
        yield "analyze()", lambda m: rows(m.analyze())
        yield f"analyze(mode={mode})", lambda m: rows(m.analyze(mode=mode))
        yield f"analyze(closed_at={cut})", lambda m: rows(m.analyze(closed_at=[cut]))
        yield (
            f"analyze(lanes={lanes}, threads={threads})",
            lambda m: rows(m.analyze(lanes=lanes, threads=threads)),
        )
        yield f"analyze({some})", lambda m: rows(m.analyze(some, tables=()))
        yield "errors", lambda m: errors_of(m.analyze(some[:1]))
        yield "certify", lambda m: proofs_of(m.certify())
        given = inputs_of(model, random_)
        yield f"solve({given})", lambda m: plain(m.solve(given))
        yield "ranges()", lambda m: plain(m.ranges())
    for run in runs:
        yield f"respond({run})", lambda m, run=run: rows(m.respond(run))
        yield f"respond({run}, mode={mode})", lambda m, run=run: rows(m.respond(run, mode=mode))
    yield "modes()", lambda m: plain(m.modes())
    yield "mobility()", lambda m: plain(m.mobility())
    parameters = [
        (name, quantity.value)
        for name, quantity in model.problem.parameters.items()
        if isinstance(quantity.value, float) and quantity.value
    ]
    if parameters and "sweep" in model.runs:
        name, value = random_.choice(parameters)
        other = {name: float(value) * random_.choice([1.0, 1.001, 0.99])}
        units = model.problem.units
        dimension = model.problem.parameters[name].dimension
        other = {name: float(units.from_si(other[name], dimension))}
        yield f"with_parameters({other})", lambda m: rows(m.with_parameters(other).analyze())
        yield (
            f"with_parameters({other}).analyze(mode={mode})",
            lambda m: rows(m.with_parameters(other).analyze(mode=mode)),
        )
        several = {name: [other[name], other[name] * 1.0005]}
        yield f"vary({several})", lambda m: varied(m, several, some)
        yield f"sensitivities({name})", lambda m: slopes_of(m, some[:1], name)


def inputs_of(model: mk.Model, random_: random.Random) -> dict[str, float]:
    """Values of all inputs near a row of the sweep."""
    motion = model.problem.motion
    row = random_.randrange(motion.rows)
    return {item.name: float(item.written[row]) for item in motion.inputs}


def varied(model: mk.Model, several: Mapping[str, Any], some: list[str]) -> object:
    """All that the variants have of some quantities."""
    variants = model.vary(several, some)
    return [plain(variants[name]) for name in some], plain(variants.status)


def errors_of(analysis: Any) -> object:
    """True errors of the tables' cells."""
    errors = analysis.errors
    return str(errors), [plain(column) for column in errors.columns]


def proofs_of(certificate: Any) -> object:
    """What is proven of the rows."""
    said = [str(each) for each in certificate.diagnostics]
    return str(certificate), plain(certificate.status), plain(certificate.tubes), said


def slopes_of(model: mk.Model, some: list[str], name: str) -> object:
    """What a change of a parameter does to a quantity."""
    slopes = model.sensitivities(some, [name])
    return str(slopes), plain(slopes.matrix(some[0]))


def answer(model: mk.Model, question: Question) -> object:
    """An answer, or the error that was raised."""
    try:
        return question(model)
    except mk.MechkinError as error:
        return type(error).__name__, str(error)


def differing(path: Path, seed: int, number: int) -> tuple[int, list[str]]:
    """How many questions were asked of one model in random order, and those whose answer is not
    that of a fresh model."""
    random_ = random.Random(f"{path.stem} {seed}")
    model, found = mk.load(path), []
    asked = list(questions(model, random_))
    order = [random_.choice(asked) for _ in range(number)]
    for k, (text, question) in enumerate(order):
        if answer(model, question) != answer(mk.load(path), question):
            found.append(f"{path.stem}: {text} after {[before for before, _ in order[:k]]}")
    return number, found


def main() -> None:
    """Asks as many questions as the command line says."""
    wanted, count, seed = int(sys.argv[1]), 0, 0
    while count < wanted:
        for path in kept():
            number, found = differing(path, seed, 8)
            count += number
            for each in found:
                print(each, flush=True)
        seed += 1
        print(f"{count} questions", flush=True)


if __name__ == "__main__":
    main()
