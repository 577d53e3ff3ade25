"""Models cross processes: pickled, copied, with other parameters."""

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk

MECHANISMS = Path(__file__).parents[2] / "mechanisms"


def pickled(model: mk.Model) -> mk.Model:
    copied: mk.Model = pickle.loads(pickle.dumps(model))
    return copied


@pytest.mark.parametrize("stem", ["rcsr", "stewart", "five_link_suspension"])
@pytest.mark.parametrize(
    "again", [lambda m: pickle.loads(pickle.dumps(m)), copy.deepcopy, copy.copy]
)
def test_a_copy_gives_the_same_bytes(stem, again) -> None:
    model = mk.load(MECHANISMS / f"{stem}.yaml")
    name = next(iter(model.problem.mechanism.coordinates))
    first = model.analyze([name], tables=[])
    other = again(model).analyze([name], tables=[])
    assert first[name].tobytes() == other[name].tobytes()
    assert again(model).stem == stem


def test_a_copy_keeps_parameters() -> None:
    model = mk.load(MECHANISMS / "rcsr.yaml", {"s1": "5.05 in"}).with_parameters({"P1": 0.51})
    other = pickle.loads(pickle.dumps(model))
    parameters = other.problem.parameters
    assert parameters["s1"].value == pytest.approx(5.05 * 0.0254, rel=1e-15)
    assert parameters["P1"].value == pytest.approx(0.51 * 0.0254, rel=1e-15)
    assert model.analyze()["O4.theta"].tobytes() == other.analyze()["O4.theta"].tobytes()
    study = {"P1": np.linspace(0.5, 0.52, 5)}
    assert (model.vary(study)["O4.theta"] == other.vary(study)["O4.theta"]).all()
