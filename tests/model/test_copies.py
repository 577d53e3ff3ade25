"""Models and what they answer cross processes: pickled, copied, with other parameters."""

import copy
import pickle
import sys

import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.show import Listed


def pickled(model: mk.Model) -> mk.Model:
    copied: mk.Model = pickle.loads(pickle.dumps(model))
    return copied


@pytest.mark.parametrize("stem", ["rcsr", "stewart", "five_link_suspension"])
@pytest.mark.parametrize(
    "again", [lambda m: pickle.loads(pickle.dumps(m)), copy.deepcopy, copy.copy]
)
def test_a_copy_gives_the_same_bytes(stem, again) -> None:
    model = mk.load(FILE_OF[stem])
    name = next(iter(model.problem.mechanism.coordinates))
    first = model.analyze([name], tables=[])
    other = again(model).analyze([name], tables=[])
    assert first[name].tobytes() == other[name].tobytes()
    assert again(model).stem == stem


def test_a_copy_keeps_parameters() -> None:
    model = mk.load(FILE_OF["rcsr"], {"s1": "5.05 in"}).with_parameters({"P1": 0.51})
    other = pickle.loads(pickle.dumps(model))
    parameters = other.problem.parameters
    assert parameters["s1"].value == pytest.approx(5.05 * 0.0254, rel=1e-15)
    assert parameters["P1"].value == pytest.approx(0.51 * 0.0254, rel=1e-15)
    assert model.analyze()["O4.theta"].tobytes() == other.analyze()["O4.theta"].tobytes()
    study = {"P1": np.linspace(0.5, 0.52, 5)}
    assert (model.vary(study)["O4.theta"] == other.vary(study)["O4.theta"]).all()


PICKLED = [lambda r: pickle.loads(pickle.dumps(r)), copy.deepcopy]


@pytest.mark.parametrize("again", PICKLED)
@pytest.mark.parametrize(
    ("stem", "asked"),
    [
        ("rcsr", {"quantities": ["O4.theta_ddot"], "tables": ["table_04"], "mode": "B"}),
        ("rcsr", {"closed_at": ["O2"], "lanes": 2, "threads": 1}),
        ("rcsr_csr", {"tables": []}),
        ("five_link_suspension", {}),
        ("planar_shaper", {}),
    ],
)
def test_a_copy_of_an_analysis_has_the_same_rows(again, stem, asked) -> None:
    run = mk.load(FILE_OF[stem]).analyze(**asked)
    other = again(run)
    for name in (*run.model.problem.mechanism.coordinates, "row.condition"):
        assert run[name].tobytes() == other[name].tobytes()
    assert other.tables.keys() == run.tables.keys()
    for one, two in zip(run.tables, other.tables, strict=True):
        for a, b in zip(one.columns, two.columns, strict=True):
            assert (a.label, a.unit, a.decimals) == (b.label, b.unit, b.decimals)
            assert a.values.tobytes() == b.values.tobytes()
    assert other.result.mode == run.result.mode
    assert other.result.session.closed_at == run.result.session.closed_at
    assert list(map(str, other.diagnostics)) == list(map(str, run.diagnostics))


@pytest.mark.parametrize("again", PICKLED)
def test_a_copy_of_a_response_keeps_parameters(again) -> None:
    model = mk.load(FILE_OF["rcsr_response"]).with_parameters({"P1": 0.49})
    run = model.respond()
    assert (run["O4.theta"] != mk.load(model.built.document.file).respond()["O4.theta"]).any()
    other = again(run)
    assert run["O4.theta"].tobytes() == other["O4.theta"].tobytes()
    assert other.model.problem.parameters["P1"].value == pytest.approx(0.49 * 0.0254, rel=1e-15)


@pytest.mark.parametrize("again", PICKLED)
def test_answers_are_copied(again) -> None:
    model = mk.load(FILE_OF["rcsr"])
    run = model.analyze()
    assert np.array_equal(again(run.errors)["theta4"], run.errors["theta4"])
    for answer in (run.tables, model.solve(161.0), model.modes(certify=True), model.ranges()):
        assert len(again(answer) if hasattr(answer, "__len__") else [again(answer)]) > 0
    for answer in (model.mobility(), run.certificate, run.summary(), run.peak("O1.effort")):
        assert repr(again(answer)) == repr(answer)


CAM = """
format: 1
plane: xy
units: {length: mm, angle: deg}
links: {cam: {}, follower: {}}
joints:
  A: {type: R, links: [ground, cam], point: [0, 0]}
  B: {type: P, links: [ground, follower], point: [0, 50], axis: [0, 1]}
couplings:
  K:
    type: function
    of: A.theta
    gives: B.s
    law: {law: cycloidal, from: 0, to: 9 mm, duration: 60 deg}
    follower: {type: translating, contact: flat, base_radius: 30 mm}
"""


@pytest.fixture(scope="module")
def answers() -> list[Listed]:
    """One of every class of answers, and a few more."""
    model = mk.load(FILE_OF["rcsr"])
    run = model.analyze()
    study = {"vary": {"P1": ["0.49 in", "0.51 in"]}, "keep": [{"of": "O4.theta", "as": "max"}]}
    response = mk.load(FILE_OF["rcsr_response"])
    free = response.respond()
    target = {"of": "O4.theta", "at": [161.0], "is": [float(run["O4.theta"][0])]}
    return [
        model,
        model.parameters,
        run,
        next(iter(run.tables)),
        run.errors,
        run.certificate,
        free,
        free.errors,
        model.modes(certify=True),
        model.ranges(),
        model.mobility(),
        mk.loads(CAM).cam(points=8),
        model.vary({"P1": [0.49, 0.5]}, ["O4.theta"]),
        response.vary({"P1": [0.49, 0.5]}, ["O4.theta"], run=response.runs[0]),
        model.sensitivities(["O4.theta"], ["P1"]),
        response.sensitivities(["O4.theta"], ["P1"], run=response.runs[0]),
        model.tolerances({"P1": 0.001}, ["O4.theta"], samples=100),
        model.fit(target, {"P1": (0.4, 0.6)}, starts=1),
        model.study(study),
        mk.load(FILE_OF["engine_mounts"]).vibration(row=2),
    ]


def is_of_mechkin(one: type) -> bool:
    """Not what a dataclass with slots was made of, which lives until garbage is collected."""
    named = one.__module__.startswith("mechkin_cli.")
    return named and getattr(sys.modules[one.__module__], one.__name__) is one


def test_every_class_of_answers_is_copied(answers: list[Listed]) -> None:
    """Before and after they are asked, as what is found only then is copied, too."""
    classes = {one for one in Listed.__subclasses__() if is_of_mechkin(one)}
    assert {type(one) for one in answers} == classes
    for answer in answers:
        before = [again(answer) for again in PICKLED]
        text = repr(answer)
        for other in (*before, *(again(answer) for again in PICKLED)):
            assert type(other) is type(answer)
            assert repr(other) == text


@pytest.mark.parametrize(
    "raised",
    [
        lambda: mk.loads("format: 1\nlinks: {a: {mas: 1}}\n"),
        lambda: mk.load(FILE_OF["rcsr"]).analyze(["O4.thet"]),
        lambda: mk.load(FILE_OF["rcsr"]).analyze()["1 +"],
    ],
)
def test_a_copy_of_an_error_says_the_same(raised) -> None:
    with pytest.raises(mk.MechkinError) as caught:
        raised()
    other = pickle.loads(pickle.dumps(caught.value))
    assert type(other) is type(caught.value)
    assert str(other) == str(caught.value)
    assert vars(other) == vars(caught.value)
