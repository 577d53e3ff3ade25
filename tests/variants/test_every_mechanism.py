"""Variants of every mechanism kept with parameters: in one call as one at a time, byte for byte."""

from __future__ import annotations

import numpy as np
import pytest
from references import FILE_OF
from variants.recordings import WITH_PARAMETERS, near

import mechkin_cli as mk

COUNT = 5


def some_quantities(model: mk.Model) -> list[str]:
    """Coordinates, an effort, a reaction, a point, derived ones, verdicts: what there is."""
    known = model.problem.quantities()
    kinds: dict[str, list[str]] = {}
    for name, quantity in known.items():
        kinds.setdefault(quantity.kind, []).append(name)
    wanted = [*model.problem.mechanism.coordinates[:6], "row.residual", "row.condition"]
    for kind in ("effort", "force", "omega", "point", "mechanical_advantage", "screw_axis", "slip"):
        wanted += kinds.get(kind, [])[-1:]
    return list(dict.fromkeys(wanted))


@pytest.mark.parametrize("plain", [True, False], ids=["natively", "with derived quantities"])
@pytest.mark.parametrize("stem", WITH_PARAMETERS)
def test_as_one_at_a_time(stem: str, plain: bool) -> None:
    model = mk.load(FILE_OF[stem])
    values = near(model.built, COUNT, seed=7, spread=0.003)
    values[:, 1] = values[:, 0]
    values[:, 1][0] *= 1.0005
    known, units = model.problem.parameters, model.problem.units
    given = {
        name: np.asarray(units.from_si(row, known[name].dimension))
        for name, row in zip(known, values, strict=True)
    }
    texts = some_quantities(model)
    if plain:
        derived = {"mechanical_advantage", "screw_axis"}
        quantities = model.problem.quantities()
        texts = [t for t in texts if t not in quantities or quantities[t].kind not in derived]
    result = model.vary(given, texts)
    for number in range(COUNT):
        one = {name: float(row[number]) for name, row in given.items()}
        names = [text for text in texts if not text.startswith("row.")]
        if number in result.errors:
            with pytest.raises(type(result.errors[number])):
                model.with_parameters(one).analyze(names, tables=[])
            continue
        analysis = model.with_parameters(one).analyze(names, tables=[])
        assert analysis.result.status.tobytes() == result.codes[number].tobytes()
        for text in texts:
            assert analysis[text].tobytes() == result[text][number].tobytes(), text


def test_renamed_parameters() -> None:
    text = FILE_OF["rcsr"].read_text(encoding="utf-8")
    other = text.replace("P1", "first_crank").replace("alpha4", "twist")
    one, two = mk.loads(text, "rcsr"), mk.loads(other, "rcsr")
    lengths, angles = [0.49, 0.5, 0.52], [15.0, 15.2, 14.9]
    texts = ["O4.theta", "O1.effort"]
    a = one.vary({"P1": lengths, "alpha4": angles}, texts)
    b = two.vary({"twist": angles, "first_crank": lengths}, texts)
    for name in texts:
        assert a[name].tobytes() == b[name].tobytes()


def test_a_parameter_that_nothing_needs() -> None:
    text = FILE_OF["rcsr"].read_text(encoding="utf-8")
    more = text.replace("parameters:\n", "parameters:\n  colour: 3\n")
    one, two = mk.loads(text, "rcsr"), mk.loads(more, "rcsr")
    a = one.vary({"P1": [0.49, 0.52]}, ["O4.theta"])
    b = two.vary({"P1": [0.49, 0.52], "colour": [1, 7]}, ["O4.theta"])
    assert a["O4.theta"].tobytes() == b["O4.theta"].tobytes()


def test_far_variants_keep_their_branch() -> None:
    """A long way in the parameters leads to the place that many short ways lead to."""
    model = mk.load(FILE_OF["rcsr"])
    far = {"P1": 0.35, "P2": 1.1, "s1": 5.6}
    own = {"P1": 0.5, "P2": 0.8, "s1": 5.0}
    whole = model.with_parameters(far).analyze(tables=[])
    steps = 40
    fractions = np.arange(1, steps + 1) / steps
    values = {name: own[name] + fractions * (far[name] - own[name]) for name in far}
    result = model.vary(values, ["O4.theta", "O2.theta"])
    assert result.complete.all()
    for name in ("O4.theta", "O2.theta"):
        turns = np.abs(np.diff(result[name][:, 0]))
        assert turns.max() < 10.0
        assert np.abs(result[name][-1] - whole[name]).max() < 1e-9
