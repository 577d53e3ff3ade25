"""`--explain`: the solver graph, what is computed, what is skipped and why."""

import re

import pytest
from cli import files
from references import RCSR

LOADS = re.compile(r"^loads:.*(\n  .*)*", re.MULTILINE)


def lines(mechkin, *arguments: object) -> list[str]:
    out = mechkin("analyze", *arguments, "--explain", "--quiet").out
    return [line.strip() for line in out.splitlines()]


def test_solver_graph_of_the_rcsr_mechanism(mechkin) -> None:
    found = lines(mechkin, RCSR)
    assert found[0] == "solver graph of RCSR"
    assert "O3 (S, 3 equations) with O4, O1, O2" in found
    assert any(line.startswith("1: 3 unknowns ") for line in found)
    (unknowns,) = [line for line in found if line.startswith("1: 3 unknowns ")]
    names = unknowns.removeprefix("1: 3 unknowns ").split(", ")
    assert sorted(names) == ["O2.s", "O2.theta", "O4.theta"]


@pytest.mark.parametrize(
    ("table", "computed"),
    [
        ("table_04", set()),
        ("table_06", {"velocities"}),
        ("table_08", {"velocities", "accelerations"}),
        (
            "table_16",
            {
                "velocities",
                "accelerations",
                "input efforts and closing wrenches",
                "joint wrenches",
                "power balance of each row",
            },
        ),
    ],
)
def test_only_what_the_tables_need_is_computed(mechkin, table, computed) -> None:
    plan = lines(mechkin, RCSR, "--table", table)
    stages = {line.split(":")[0]: line for line in plan[plan.index("demand plan") + 1 :] if line}
    for stage in (
        "velocities",
        "accelerations",
        "input efforts and closing wrenches",
        "joint wrenches",
        "power balance of each row",
    ):
        wanted = "computed" if stage in computed else "skipped, no column reads"
        assert stages[stage].startswith(f"{stage}: {wanted}"), stages[stage]


def test_an_open_chain_has_no_loops(mechkin, write) -> None:
    found = lines(mechkin, write("crank.yaml", files.CRANK))
    assert "ground -> arm by O (R)" in found
    assert "no loops" in found


def test_a_link_without_mass_needs_no_accelerations(mechkin, write) -> None:
    massless = files.CRANK.replace("{mass: 1, center_of_mass: [r, 0, 0]}", "{}")
    found = lines(mechkin, write("crank.yaml", massless))
    assert "accelerations: skipped, no link has mass and no column reads an acceleration" in found
    assert "inertia: skipped, no link has mass" in found


def test_the_explanation_comes_before_the_tables(mechkin, write) -> None:
    out = mechkin("analyze", write("crank.yaml", files.CRANK), "--explain").out
    assert out.startswith("solver graph of crank\n")
    assert out.index("demand plan") < out.index("sweep: ")


def test_json_holds_the_explanation(mechkin, write) -> None:
    run = mechkin("analyze", write("crank.yaml", files.CRANK), "--explain", "--json")
    assert run.json["explanation"][0] == "solver graph of crank"


def test_loads_that_vary_are_evaluated_first(mechkin, tmp_path) -> None:
    text = RCSR.read_text(encoding="utf-8")
    law = '{type: torque, joint: O4, value: "-2 lbm*in^2/s*O4.theta_dot*sin(O4.theta)"}'
    place = tmp_path / "rcsr.yaml"
    place.write_text(LOADS.sub(f"loads: [{law}]", text), encoding="utf-8")
    read = "loads that vary: evaluated with the forces, from O4.theta, O4.theta_dot"
    assert read in lines(mechkin, place, "--table", "table_16")
    assert read not in lines(mechkin, place, "--table", "table_04")


def test_derived_quantities_say_what_they_take(mechkin, write) -> None:
    text = RCSR.read_text(encoding="utf-8")
    columns = ", ".join(
        f"{{label: c{k}, value: {value}}}"
        for k, value in enumerate(
            ("O3.q0", "O4.theta.mechanical_advantage", "O4.theta.transmission_angle")
        )
    )
    text = text[: text.index("\ntables:")] + f"\ntables: [{{name: t, columns: [{columns}]}}]\n"
    found = lines(mechkin, write("derived.yaml", text))
    assert "derived from positions and rates: O3.q0" in found
    assert "mechanical advantages: one more run, with unit rate of one input" in found
    assert "transmission angles: static runs with a unit load, 1 in all" in found
    assert any(line.startswith("input efforts and closing wrenches: skipped") for line in found)


def test_a_cable_is_named_by_its_ends(mechkin, write) -> None:
    """What its stretches are made of, which the file does not have, is not told."""
    for text in CABLES:
        out = mechkin("analyze", write("cable.yaml", text), "--explain").out
        graph = out.partition("demand plan")[0]
        assert not re.search(r"K\.\d| (near|far|hub|slide|end|back)\b", graph), graph
        assert len(re.findall(r"cable K between \w+ and \w+ \(\d equation", graph)) >= 2, graph
    found = lines(mechkin, write("tackle.yaml", CABLES[0]))
    assert found[1:4] == ["tree", "ground -> block by G (P)", "ground -> cart by C (P)"]
    assert "cable K between d and c (2 equations) with C" in found
    assert "1: 2 unknowns turn and length of cable K between d and c" in found


def test_loops_of_cables_are_no_loops_of_the_mechanism(mechkin, write) -> None:
    run = mechkin("mobility", write("tackle.yaml", CABLES[0]), "--json")
    assert (run.json["loops"], run.json["mobility"]) == (0, 1)


HOIST = """
format: 1
plane: xy
units: {length: mm, angle: deg}
links: {block: {}, cart: {}}
joints:
  G: {type: P, links: [ground, block], point: [20, -90], axis: [0, 1]}
  C: {type: P, links: [ground, cart], point: [110, -60], axis: [0, -1]}
points:
  a: {link: ground, at: [0, 0]}
  b: {link: block, at: [20, -90]}
  d: {link: ground, at: [70, 0]}
  c: {link: cart, at: [110, -60]}
couplings: {K: {type: cable, path: PATH}}
motion: {inputs: {C.s: {from: 0, to: 4, step: 2}}}
"""
SPACE = """
format: 1
units: {length: m, angle: deg}
links: {arm: {}, block: {}}
joints:
  A: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 1, 2]}
  S: {type: P, links: [ground, block], point: [3, 1, 0], axis: [0, 0, 1]}
points:
  p: {link: arm, at: [1, 0, 0.5]}
  e: {link: ground, at: [2, 0, 2]}
  q: {link: block, at: [3, 1, 0]}
couplings: {K: {type: cable, path: [p, e, q, e]}}
motion: {inputs: {A.theta: {from: 0, to: 4, count: 2}}}
"""
OVER = "[a, {pulley: b, radius: 20, side: right}, {pulley: d, radius: 30, side: left}, c]"
CABLES = [
    HOIST.replace("PATH", "[a, b, a, b, d, c]"),
    HOIST.replace("PATH", OVER),
    SPACE,
]


def test_check_counts_loops_of_the_file_alone(mechkin, write) -> None:
    """Neither couplings nor what a cable is made of."""
    assert "(0 loops, " in mechkin("check", write("tackle.yaml", CABLES[0])).out
