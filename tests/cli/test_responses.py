"""Responses on the command line: which run, which files, what is said."""

import pytest

PENDULUM = """\
format: 1
name: pendulum
links:
  bob: {mass: 2, center_of_mass: [0, -0.25, 0], inertia: {zz: 0.01, xx: 0.01}}
joints:
  A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}
loads: [{type: gravity, g: [0, -9.81, 0]}]
responses:
  fall:
    start: {A.theta: 80}
    time: {from: 0, to: 3, step: 0.25}
    stop: [{dead_centre: A.theta, count: 2}]
  push:
    start: {A.theta: 0}
    efforts: {A.theta: 3}
    time: {from: 0, to: 1, step: 0.5}
tables:
  - {name: angles, run: fall, columns: [time, A.theta, row.event]}
"""
SWEPT = PENDULUM.replace("loads:", "motion: {inputs: {A.theta: {values: [0, 10]}}}\nloads:")


def test_every_run_has_its_files(mechkin, write, folder) -> None:
    run = mechkin("analyze", write("pendulum.yaml", SWEPT))
    assert run.code == 0
    assert sorted(path.name for path in (folder / "out" / "pendulum").glob("[!.]*")) == [
        *("angles.csv", "angles.md", "fall.rows.csv", "push.csv", "push.md", "push.rows.csv"),
        *("rows.csv", "sweep.csv", "sweep.md"),
    ]
    header, *rows = (folder / "out/pendulum/fall.rows.csv").read_text().splitlines()
    assert header == "row,time,mode,status,event,residual,condition,power_error,energy_error"
    assert rows[0].startswith("1,0,A,ok,,")
    assert rows[-1].split(",")[4] == "dead centre 2 of A.theta"


def test_impacts_have_a_file(mechkin, write, folder) -> None:
    limits = "limits: {A.theta: {min: 0, restitution: 0.5}}\nresponses:"
    text = PENDULUM.replace("responses:", limits).replace(", count: 2", "")
    assert mechkin("analyze", write("pendulum.yaml", text)).code == 0
    header, first, *_ = (folder / "out/pendulum/fall.impacts.csv").read_text().splitlines()
    names = header.split(",")
    assert names[:3] == ["time", "event", "A.theta.impulse"]
    assert {"A.impulse.x", "A.angular_impulse.y"} < set(names)
    assert first.split(",")[1] == "A.theta at its limit 0 deg"


def test_what_is_said_of_a_response(mechkin, write) -> None:
    run = mechkin("analyze", write("pendulum.yaml", PENDULUM))
    lines = run.err.splitlines()
    assert lines[0] == "pendulum, response fall (pendulum.yaml)"
    assert "  free     1 freedom from A.theta" in lines
    assert "  free     1 freedom from A.theta; efforts on A.theta" in lines
    assert "  ended    at 1 s, the last moment" in lines
    (ended,) = [line for line in lines if "dead centre" in line]
    assert ended.startswith(("  ended    at 1.", "  ended    at 2."))
    assert ended.endswith(" s: dead centre 2 of A.theta")
    assert sum(line.startswith("  files") for line in lines) == 1


@pytest.mark.parametrize("columns", [80, 200])
def test_tables_fit_the_width(mechkin, write, monkeypatch, columns) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    lines = mechkin("analyze", write("pendulum.yaml", PENDULUM)).out.splitlines()
    assert max(map(len, lines)) <= columns
    assert any(line.split() == ["time", "A.theta", "row.event"] for line in lines)


def test_one_object_holds_all_runs(mechkin, write) -> None:
    found = mechkin("analyze", write("pendulum.yaml", SWEPT), "--json").json
    assert (found["name"], found["row_count"]) == ("pendulum", 2)
    assert [one["name"] for one in found["responses"]] == ["fall", "push"]
    fall, push = found["responses"]
    assert [column["label"] for column in fall["tables"][0]["columns"]][-1] == "row.event"
    assert push["row_count"] == 3
    alone = mechkin("analyze", write("pendulum.yaml", PENDULUM), "--json").json
    assert alone.keys() == {"mechkin", "format", "file", "name", "responses"}
    assert alone["responses"] == found["responses"]


def test_only_the_runs_of_the_tables_wanted(mechkin, write, folder) -> None:
    file = write("pendulum.yaml", SWEPT)
    run = mechkin("analyze", file, "--table", "angles", "--out", "one")
    assert run.code == 0
    assert sorted(path.name for path in (folder / "one").glob("[!.]*")) == [
        *("angles.csv", "angles.md", "fall.rows.csv"),
    ]
    run = mechkin("analyze", file, "--table", "angels")
    assert run.code == 2
    assert "there is no table angels; tables are angles, sweep, push" in run.err


def test_explain_tells_how_it_was_integrated(mechkin, write) -> None:
    run = mechkin("analyze", write("pendulum.yaml", PENDULUM), "--explain", "--table", "angles")
    assert "solver graph of the start of fall" in run.out
    assert "steps with a tolerance of 1e-10" in run.out


def test_check_counts_responses_and_their_rows(mechkin, write) -> None:
    run = mechkin("check", write("pendulum.yaml", SWEPT))
    assert run.out == "pendulum.yaml: ok (0 loops, 18 rows, 2 responses, 3 tables)\n"


@pytest.mark.parametrize("command", ["check", "analyze"])
def test_a_start_of_too_few_coordinates_is_refused_with_its_place(mechkin, write, command) -> None:
    run = mechkin(command, write("pendulum.yaml", PENDULUM.replace("{A.theta: 80}", "{}")))
    assert run.code == 3
    assert "pendulum.yaml:10:12: error: the start of fall names no coordinate, but 1 is" in run.err


def test_modes_at_the_start(mechkin, write) -> None:
    file = write("pendulum.yaml", PENDULUM)
    found = mechkin("modes", file, "--run", "fall", "--json").json
    assert found["inputs"] == {"A.theta": pytest.approx(80.0)}
    assert mechkin("modes", file, "--run", "sweep").code == 2


def test_tables_are_kept_and_compared(mechkin, write, folder) -> None:
    file = write("pendulum.yaml", PENDULUM)
    assert mechkin("tables", file).code == 0
    assert sorted(path.name for path in (folder / "pendulum").iterdir()) == [
        *("angles.csv", "angles.md", "picture.svg", "push.csv", "push.md"),
    ]
    assert mechkin("tables", file, "--check").code == 0
    write("pendulum.yaml", PENDULUM.replace("A.theta: 80", "A.theta: 81"))
    run = mechkin("tables", file, "--check")
    assert run.code == 1
    assert "angles" in run.out
