"""Files that ask for more than a machine has end in a message, and soon."""

import tracemalloc

import pytest
from building.sound import SOUND
from references import FILE_OF
from work import calls

import mechkin_cli as mk
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.tolerances import MOST_EQUATIONS, MOST_NUMBERS

MOST_CALLS = 40_000_000
"""Of functions: above what each takes (10 million at most), far below what an exponential search or
a quadratic one would."""


def errors(text: str) -> tuple[Diagnostic, ...]:
    diagnostics: tuple[Diagnostic, ...] = ()

    def answer() -> None:
        nonlocal diagnostics
        with pytest.raises(mk.InvalidFile) as caught:
            mk.loads(text, "f.yaml")
        diagnostics = caught.value.diagnostics

    count = calls(answer)
    assert count < MOST_CALLS
    return diagnostics


def loops(count: int) -> str:
    """`count` four-bars that do not touch each other, one loop each."""
    links, joints, inputs = [], [], []
    for i in range(count):
        links += [f"{name}{i}: {{}}" for name in "abc"]
        joints += [
            f"  A{i}: {{type: R, links: [ground, a{i}], point: [0, 0, {i}], axis: [0, 0, 1]}}",
            f"  B{i}: {{type: S, links: [a{i}, b{i}], point: [0, 1, {i}]}}",
            f"  C{i}: {{type: U, links: [b{i}, c{i}], point: [3, 2, {i}], axis: [0, 0, 1], "
            "axis2: [0, 1, 0]}",
            f"  D{i}: {{type: R, links: [c{i}, ground], point: [3, 0, {i}], axis: [0, 0.1, 1]}}",
        ]
        inputs.append(f"A{i}.theta: {{at: 0}}")
    parts = [", ".join(links), "\n".join(joints), ", ".join(inputs)]
    return "format: 1\nlinks: {{{}}}\njoints:\n{}\nmotion: {{inputs: {{{}}}}}\n".format(*parts)


def test_the_number_of_loops_has_no_limit() -> None:
    graph = mk.loads(loops(60)).graph
    assert [len(block.unknowns) for block in graph.blocks] == [3] * 60


def test_every_link_joined_to_every_other() -> None:
    names = [f"a{i}" for i in range(40)]
    pairs = [(one, two) for i, one in enumerate(names) for two in names[:i]] + [("ground", "a0")]
    joints = "\n".join(
        f"  J{k}: {{type: R, links: [{one}, {two}], point: [{k}, 0, 0], axis: [0, 0, 1]}}"
        for k, (one, two) in enumerate(pairs)
    )
    links = ", ".join(f"{name}: {{}}" for name in names)
    motion = "motion: {inputs: {J780.theta: {at: 0}}}"
    (error,) = errors(f"format: 1\nlinks: {{{links}}}\njoints:\n{joints}\n{motion}\n")
    assert error.code == "block-too-large"
    assert str(error).startswith("f.yaml:4:3: error: ")
    assert "must be solved together: J" in error.message
    (number,) = error.numbers
    assert number.limit == MOST_EQUATIONS < number.value
    assert len(str(error)) < 500


# the sound file: a column, 6 of rows.csv and an input, R + S + R + C = 7 freedoms
PER_ROW = 1 + 6 + 1 + 7


def test_rows_times_columns_are_held_as_far_as_memory_goes() -> None:
    most = MOST_NUMBERS // PER_ROW
    model = mk.loads(SOUND.replace("step: 5}", f"count: {most + 1}}}"))
    with pytest.raises(mk.UsageError, match=rf"{most + 1} \(limit {most}\).*stream.*parquet"):
        model.analyze()


def peak_of(text: str) -> int:
    tracemalloc.start()
    try:
        mk.loads(text)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("count", ["3000000", "10000000", "1000000000"])
def test_rows_are_not_made_before_they_are_wanted(count: str) -> None:
    few = peak_of(SOUND)
    assert peak_of(SOUND.replace("step: 5}", f"count: {count}}}")) < few + 5e6


@pytest.mark.parametrize("spacing", ["count: " + "9" * 300, "count: 1000000000001", "step: 1e-12"])
def test_rows_of_which_no_one_sees_the_end_are_refused(spacing: str) -> None:
    (error,) = errors(SOUND.replace("step: 5}", f"{spacing}}}"))
    assert (error.code, error.limit) == ("too-many-rows", "1e+12 rows")


def test_columns_of_all_tables_count() -> None:
    columns = ", ".join(f"O.theta + {i} deg" for i in range(400))
    tables = "\n".join(f"  - {{name: t{i}, columns: [{columns}]}}" for i in range(10))
    text = SOUND.partition("tables:")[0] + f"tables:\n{tables}\n"
    model = mk.loads(text.replace("step: 5}", "count: 10000}"))
    with pytest.raises(mk.UsageError, match="too many rows to be held at once"):
        model.analyze()


def parameters(lines: list[str]) -> str:
    return SOUND.replace(
        "parameters: {r: 40 mm, k: 2}", "parameters:\n  r: 40 mm\n  k: 2\n  " + "\n  ".join(lines)
    )


def test_a_long_chain_of_parameters_is_evaluated() -> None:
    chain = [f"p{i}: p{i + 1} + 1" for i in range(10_000)]
    model = mk.loads(parameters([*chain, "p10000: 1"]))
    assert model.problem.parameters["p0"].value == 10_001.0


def test_a_long_circle_of_parameters_is_one_short_message() -> None:
    (error,) = errors(parameters([f"p{i}: p{(i + 1) % 10_000}" for i in range(10_000)]))
    assert "p0 -> p1 -> p2 -> p3 -> p4 -> p5 -> p6 -> ... (10000 names) -> p0" in error.message


FLOODS = {
    "unknown names": parameters([f"p{i}: q{i}" for i in range(10_000)]),
    "unknown names in folded texts": parameters(
        [f'p{i}: "1 \\\n     + q{i}"' for i in range(8000)]
    ),
    "unknown links": SOUND.replace(
        "  rod: {}\n",
        "  rod: {}\n" + "".join(f"  L{i}: {{}}\n" for i in range(3000)),
    ).replace(
        "points:",
        "".join(f"  J{i}: {{type: W, links: [rod, M{i}]}}\n" for i in range(3000)) + "points:",
    ),
    "links apart": SOUND.replace(
        "  rod: {}\n", "  rod: {}\n" + "".join(f"  L{i}: {{}}\n" for i in range(10_000))
    ),
    "values cut at commas": SOUND + f"follow: [{', '.join(['max(1'] * 10_000)}]\n",
    "a long line of cut values": SOUND + "follow: [" + 'max(1, "(", 2), ' * 10_000 + "O]\n",
}


@pytest.mark.parametrize("text", FLOODS.values(), ids=FLOODS)
def test_a_flood_of_mistakes_is_cut_off_soon(text: str) -> None:
    *found, last = errors(text)
    assert len(found) == 50
    assert (last.code, last.severity, last.hint) == ("more", "note", "correct these first")
    places = [error.place[1:] for error in found if error.place]
    assert places == sorted(places)


def test_a_flood_of_warnings_is_cut_off_too() -> None:
    odd = "".join(
        f"  L{i}: {{mass: 1, center_of_mass: [0, 0, 0], inertia: {{xx: 1}}}}\n" for i in range(60)
    )
    welds = "".join(f"  J{i}: {{type: W, links: [rod, L{i}]}}\n" for i in range(60))
    text = SOUND.replace("  rod: {}\n", f"  rod: {{}}\n{odd}").replace("points:", welds + "points:")
    *found, last = mk.loads(text).diagnostics
    assert {warning.code for warning in found} == {"unphysical-inertia"}
    assert (len(found), last.message) == (50, "10 more problems are not shown")


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("(" * 500_000 + "1" + ")" * 500_000, "1000001 characters (limit 4000)"),
        ("(" * 60 + "1" + ")" * 60, "nested more than 50 deep"),
        ("2" + "**2" * 900, "nested more than 50 deep"),
        ("+".join(["1"] * 1500), "more than 1000 numbers, names and operations"),
        ("9**9**9**9", "no finite value"),
        ("1e999999999", "too large"),
        ("9" * 3000, "too large"),
        ("1 m^" + "9" * 100, "limit 24"),
        ("1 m" + "*m" * 100, "limit 24"),
        ("-" * 3000 + "1", "nested more than 50 deep"),
    ],
    ids=lambda text: text[:12],
)
def test_expression_bombs(value: str, words: str) -> None:
    (error,) = errors(parameters([f'bomb: "{value}"']))
    assert words in str(error)
    assert len(str(error)) < 300


def test_long_names_are_compared_in_their_beginning_only() -> None:
    name = "a" * 250_000
    text = SOUND.replace("[ground, crank]", f"[ground, {name}b]", 1)
    text = text.replace("  rod: {}\n", f"  rod: {{}}\n  ? {name}\n  : {{}}\n")
    assert errors(text)[0].code == "unknown-link"


@pytest.mark.parametrize("size", ["1e-101", "1e-160", "1e-300", "1e-320", "-1e-200"])
def test_a_mechanism_too_small_to_compute_with_is_refused(size: str) -> None:
    parameters = ["P1", "P2", "P3", "P4", "s1", "s4"]
    path = FILE_OF["rcsr"]
    with pytest.raises(mk.InvalidFile, match=r"too small to compute with.*limit 1e-100 m"):
        mk.load(path, dict.fromkeys(parameters, f"{size} m")).analyze()
    with pytest.raises(mk.UsageError, match="is a length below 1e-100 m; write another value"):
        mk.load(path).vary({name: [0.5, float(size)] for name in parameters}, ["O4.theta"])
