"""`mechkin bench` measures what it says: errors are true ones, and every method is a sound one."""

import json
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace

import jsonschema
import numpy as np
import pytest
from benchmark.schema import SCHEMA
from references import FILE_OF, RCSR, exact

import mechkin_cli as mk
from benchmarks import scenes
from benchmarks.closure import true_values
from benchmarks.peers import FAMILIES
from benchmarks.responses.pendulum import exact_motion
from mechkin_cli.bench import runs
from mechkin_cli.bench.chain import TreeBody
from mechkin_cli.bench.measurement import Bench, Measurement, errors_of
from mechkin_cli.bench.methods import ANALYZED
from mechkin_cli.bench.report import (
    CURVES,
    NAMES,
    ReportTable,
    bench_table,
    best_table,
    csv_text,
    markdown,
    record,
    summary,
    svg,
    write,
)
from mechkin_cli.bench.runs import TEXT, Rounds, bench, exact_values, methods_of
from mechkin_cli.bench.scene import BenchScene
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel.functions import widths

ONCE = Rounds(1, 1)
HAND = ("dense", "scipy", "stepping", "Pinocchio")
"""Families whose making takes no compiler."""


def chosen(*families: str) -> dict[str, runs.Family]:
    return {family: FAMILIES[family] for family in families}


def short(text: str) -> str:
    """The RCSR file with few rows."""
    return text.replace("step: 0.25 deg", "step: 2 deg")


@pytest.fixture(scope="module")
def rcsr() -> BenchScene:
    return BenchScene("RCSR", mk.loads(short(scenes.texts()["RCSR"]())))


@pytest.fixture(scope="module")
def platform() -> BenchScene:
    return BenchScene("platform", mk.loads(scenes.platform(9)))


@pytest.fixture(scope="module")
def measured(rcsr: BenchScene) -> Bench:
    return bench(rcsr, ONCE, chosen(*HAND))


def errors(scene: BenchScene, values: dict, true: dict) -> dict:
    lengths = frozenset(scene.chain.coordinates[k] for k in scene.chain.lengths)
    return errors_of(scene.asked, lengths, values, true)


def test_what_is_right_is_what_40_digits_say() -> None:
    scene = BenchScene("RCSR", mk.load(RCSR))
    true = true_values(scene)
    inch = mk.load(RCSR).problem.units.to_si(
        1.0, mk.load(RCSR).problem.quantities()["O2.s"].dimension
    )
    units = {"O2.theta": np.pi / 180, "O4.theta": np.pi / 180, "O2.s": inch}
    names = {"theta2": "O2.theta", "s2": "O2.s", "theta4": "O4.theta"}
    names |= {"omega4": "O4.theta_dot", "alpha4": "O4.theta_ddot", "s2_dot": "O2.s_dot"}
    for header, name in names.items():
        wanted = np.array(exact("rcsr")[header], float) * units.get(
            name, inch if ".s" in name else 1
        )
        miss = np.abs(np.asarray(true[name][0], float) - wanted)
        # the reference takes lengths as written, the bench the nearest doubles
        assert miss.max() < 1e-14 * np.abs(wanted).max(), name


@pytest.mark.parametrize("name", ["RCSR", "RSSR", "7R", "RCHCH", "Stewart", "platform on laws"])
def test_double_double_and_the_closure_of_another_formula_agree(name: str) -> None:
    """But for the rounding of the file's numbers to doubles, from which the closure starts."""
    scene = BenchScene(name, mk.loads(scenes.texts()[name]()))
    exact, said = exact_values(scene)
    assert said == TEXT
    worst = errors(scene, true_values(scene), exact)
    assert worst["position"] < 5e-15
    assert worst["velocity"] < 2e-14
    assert worst["acceleration"] < 2e-14
    assert worst["position"] > 0.0


def test_reactions_have_errors_too(measured: Bench) -> None:
    everything = [m for m in measured.measurements if m.level == "everything"]
    assert {m.family for m in everything} == {"mechkin", "dense"}
    assert all(0.0 < m.loads < 1e-12 for m in everything)


def test_errors_rest_on_nothing_of_the_kernel(rcsr: BenchScene) -> None:
    """Another mechanism in the exact closure is seen as an error of that size."""
    moved = BenchScene("RCSR", rcsr.model)
    first, *rest = rcsr.chain.bodies
    assert isinstance(first, TreeBody)
    frame = first.by.before
    off = first.by._replace(before=frame._replace(o=(frame.o[0], frame.o[1] + 1e-6, frame.o[2])))
    moved.__dict__["chain"] = replace(rcsr.chain, bodies=(first._replace(by=off), *rest))
    found = rcsr.found("motion", rcsr.kernel("motion", rcsr.followed)())
    assert errors(rcsr, found, true_values(rcsr))["position"] < 1e-14
    assert 1e-8 < errors(rcsr, found, true_values(moved))["position"] < 1e-4


@pytest.mark.parametrize("name", ["RSSR", "7R", "RCHCH", "Stewart", "platform on laws"])
def test_the_exact_closure_holds_for_every_kind_of_loop(name: str) -> None:
    scene = BenchScene(name, mk.loads(scenes.texts()[name]()))
    found = scene.found("motion", scene.kernel("motion", scene.followed)())
    worst = errors(scene, found, true_values(scene))
    assert worst["position"] < 1e-14
    assert worst["velocity"] < 2e-14
    assert worst["acceleration"] < 5e-14


def test_a_train_of_loops_with_redundant_constraints_is_measured() -> None:
    from benchmarks import train

    motion = "{from: 0 deg, to: 40 deg, step: 10 deg}"
    scene = BenchScene("train", mk.loads(train.text(3, motion)))
    found = bench(scene, ONCE, chosen(*(("CasADi",) if "casadi" in sys.modules else ())))
    assert all(name == "CasADi" and "redundant" in why for name, why in found.skipped.items())
    exact_enough = [m for m in found.measurements if m.curve == ANALYZED and m.level == "motion"]
    assert max(m.acceleration for m in exact_enough) < 1e-12


def points(found: Bench, curve: str) -> list[Measurement]:
    return [m for m in found.measurements if m.curve == curve]


@pytest.mark.parametrize(
    ("curve", "last"),
    [
        ("kernel, by tolerance", 1e-12),
        ("kernel, by Newton steps", 1e-14),
        ("fsolve", 1e-13),
        ("least_squares", 1e-13),
        ("Newton on its Jacobians", 1e-13),
        ("Runge-Kutta method", 1e-3),
        ("Euler's method", 1e-1),
    ],
)
def test_a_curve_is_a_trade_off(measured: Bench, curve: str, last: float) -> None:
    found = points(measured, curve)
    if not found and curve.endswith("Jacobians"):
        pytest.skip("Pinocchio is not installed")
    assert found[-1].position < last
    assert found[-1].position < 1e-2 * found[0].position or curve.endswith("method")
    assert found[-1].position < found[0].position


def test_differences_are_best_at_a_middle_step(measured: Bench) -> None:
    found = points(measured, "fsolve, differences")
    best = min(m.acceleration for m in found)
    assert found[0].acceleration > best < found[-1].acceleration
    assert found[1].velocity < 0.02 * found[0].velocity


def test_every_measurement_has_a_time_and_a_ratio(measured: Bench) -> None:
    for m in measured.measurements:
        assert m.microseconds > 0.0, m
        assert 0.0 < m.least <= m.microseconds
        assert m.ratio > 0.0


def test_levels_find_what_they_say(measured: Bench) -> None:
    for m in (m for m in measured.measurements if m.family != "dense"):
        assert m.position is not None
        assert (m.acceleration is not None) == (m.level != "position")


@pytest.mark.parametrize("limit", [1e-2, 1e-6, 1e-14])
def test_errors_do_not_depend_on_the_lanes(rcsr: BenchScene, limit: float) -> None:
    from mechkin_cli.session.session import Packing

    tests = (limit, limit**0.5, limit)
    found = []
    for lanes in widths():
        options = {"tests": tests, "packing": Packing(lanes, 1)}
        found.append(rcsr.found("position", rcsr.kernel("position", rcsr.from_before, **options)()))
    true = true_values(rcsr)
    assert len({errors(rcsr, values, true)["position"] for values in found}) == 1


def test_a_library_that_is_missing_is_named(
    rcsr: BenchScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("scipy.optimize", "casadi", "pinocchio", "mujoco"):
        monkeypatch.setitem(sys.modules, name, None)
    for family, library in (
        ("scipy", "scipy"),
        ("CasADi", "casadi"),
        ("Pinocchio", "pinocchio"),
        ("MuJoCo", "mujoco"),
    ):
        found, why = methods_of(rcsr, FAMILIES[family])
        assert not found
        how = "'mechkin[bench]'" if family == "scipy" else "-r benchmarks/requirements.txt"
        assert f"{library} is not installed (pip install {how})" in why


def test_a_mechanism_that_a_method_cannot_take_is_named(platform: BenchScene) -> None:
    pytest.importorskip("mujoco")
    found, why = methods_of(platform, FAMILIES["MuJoCo"])
    assert not found
    assert "joints S in the tree" in why


@pytest.mark.parametrize("family", ["CasADi", "MuJoCo", "Pinocchio"])
def test_peers_that_are_here_are_sound(rcsr: BenchScene, family: str) -> None:
    found = bench(rcsr, ONCE, chosen(family))
    if found.skipped:
        pytest.skip(str(found.skipped))
    own = [m for m in found.measurements if m.family == family]
    assert min(m.position for m in own) < (0.05 if family == "MuJoCo" else 1e-13)
    moving = [m.acceleration for m in own if m.level == "motion"]
    assert all(error < 1e-12 for error in moving)


def test_a_file_that_cannot_be_measured_says_why() -> None:
    with pytest.raises(UsageError, match="has no sweep to measure"):
        BenchScene("response", mk.load(FILE_OF["rcsr_response"]))
    pendulum = (
        "format: 1\nname: crank\nlinks: {bar: {}}\njoints:\n"
        "  A: {type: R, links: [ground, bar], point: [0, 0, 0], axis: [0, 0, 1]}\n"
        "motion: {inputs: {A.theta: {from: 0, to: 90, step: 10}}}\n"
    )
    with pytest.raises(UsageError, match="nothing that is solved for"):
        BenchScene("crank", mk.loads(pendulum))


def test_the_record_has_its_schema(measured: Bench, tmp_path) -> None:
    paths = write(
        tmp_path, {"processor": "this"}, [measured], [bench_table(measured)], "mechkin bench"
    )
    assert [p.name for p in paths] == list(NAMES.values())
    written = json.loads(paths[0].read_text(encoding="utf-8"))
    jsonschema.validate(written, SCHEMA)
    assert written["mechanisms"][0]["name"] == "RCSR"
    page = paths[2].read_text(encoding="utf-8")
    assert "](bench.svg)" in page
    assert "| RCSR | motion |" in page
    assert record({}, [], [])["mechanisms"] == []


def test_csv_has_a_line_for_each_measurement(measured: Bench) -> None:
    lines = csv_text([measured]).splitlines()
    assert lines[0].startswith("scene,family,curve,setting,level,rows,microseconds")
    assert len(lines) == 1 + len(measured.measurements)


def measurement(curve: str, us: float, error: float | None) -> Measurement:
    level = "position"
    return Measurement("A", "f", curve, "1", level, 1, us, us, 0.0, 1.0, error, None, None, None)


def test_the_figure_shows_every_curve_and_its_points() -> None:
    given = [measurement(CURVES[0].name, 1.0, 1e-15), measurement(CURVES[0].name, 0.1, 1e-3)]
    given += [measurement(CURVES[5].name, 100.0, 1e-8), measurement("not in the figure", 1.0, 1e-4)]
    text = svg([("A & B", given)])
    root = ET.fromstring(text)
    space = "{http://www.w3.org/2000/svg}"
    said = [e.text for e in root.iter(f"{space}text")]
    assert "A & B" in said
    assert CURVES[0].words in said
    assert CURVES[5].words in said
    assert CURVES[1].words not in said
    dots = [e.get("class") for e in root.iter(f"{space}circle")]
    # two points and one, and a mark of each in the legend
    assert dots.count("p0") == 3
    assert dots.count("p5") == 2
    assert text == svg([("A & B", given)])


def test_the_figure_of_nothing_is_a_figure() -> None:
    ET.fromstring(svg([]))


def test_points_lie_as_their_numbers_do() -> None:
    text = svg(
        [
            (
                "A",
                [measurement(CURVES[0].name, 10.0, 1e-12), measurement(CURVES[0].name, 1.0, 1e-4)],
            )
        ]
    )
    dots = list(ET.fromstring(text).iter("{http://www.w3.org/2000/svg}circle"))[:2]
    (x0, y0), (x1, y1) = ((float(d.get("cx")), float(d.get("cy"))) for d in dots)
    assert x1 > x0  # larger error to the right
    assert y1 > y0  # less time further down


def test_the_best_of_the_others_is_as_exact(measured: Bench) -> None:
    rows = best_table([measured]).rows
    assert [row["level"] for row in rows] == ["position", "motion"]
    assert rows[0]["peer"] != "none"
    for row in rows:
        if row["peer"] != "none":
            assert row["peer_error"] <= 10.0 * row["own_error"]


def test_the_page_sums_up_what_its_table_says() -> None:
    rows = [{"kernel_ratio": 2.0, "sweep_ratio": 0.5}, {"kernel_ratio": 8.0}]
    said = summary(ReportTable("ahead", "", (), rows))
    assert "the kernel alone is 2.00 to 8.00 times" in said
    assert "0.500 to 0.500 times" in said
    assert "followed" not in said
    assert summary(ReportTable("ahead", "", (), [])) == "No other method was measured."


def test_tables_become_markdown() -> None:
    from mechkin_cli.bench.report import ReportColumn

    columns = (ReportColumn("a", "posi-\ntion"), ReportColumn("t", "+-\n%", "time"))
    text = markdown(ReportTable("t", "title", columns, [{"a": "x|y", "t": 1.5}], ("note",)))
    assert text == ("### title\n\n| position | +- % |\n| --- | ---: |\n| x\\|y | 1.50 |\n\nnote\n")


def test_the_pendulum_beside_which_responses_are_held_is_mechkins() -> None:
    from benchmarks.responses.pendulum import TEXT

    found = mk.loads(TEXT.format(tolerance="1e-12")).respond("run")
    for name, wanted in zip(("A.theta", "B.theta"), exact_motion(), strict=True):
        assert np.abs(found[name] - wanted).max() < 1e-9


def test_known_mechanisms_are_those_that_are_kept() -> None:
    """The package's copies differ from the kept files in their rows and tables alone."""
    for name, file in (("RSSR", "rssr"), ("RCSR-CSR", "rcsr_csr"), ("RCHCH", "rchch")):
        ours, kept = mk.loads(scenes.texts()[name]()), mk.load(FILE_OF[file])
        assert ours.problem.mechanism == kept.problem.mechanism, name


def test_families_are_there() -> None:
    assert next(iter(FAMILIES)) == "mechkin"
