"""A run is one thing: what it found is kept, reading more of it follows and searches nothing."""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.runs import LECTURES, NAMES
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.search import search
from mechkin_cli.session.session import Session


def fresh(stem: str) -> mk.Model:
    return mk.load(FILE_OF[stem])


class Calls:
    """Counts the verbs of all sessions."""

    def __init__(self) -> None:
        self.count = dict.fromkeys(("follow", "search", "run"), 0)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Calls:
    found = Calls()
    homes = {"follow": Session, "run": Session, "search": search}
    for verb, home in homes.items():
        name = "assemblies" if verb == "search" else verb
        own = getattr(home, name)

        def counted(*args, _own=own, _verb=verb, **more):
            found.count[_verb] += 1
            return _own(*args, **more)

        monkeypatch.setattr(home, name, counted)
    return found


COLUMNS = (
    *("O2.theta", "O2.s", "O4.theta", "O2.theta_dot", "O2.s_dot", "O4.theta_dot"),
    *("O2.theta_ddot", "O2.s_ddot", "O4.theta_ddot", "O1.effort", "O1.force", "O2.force"),
    *("O3.force", "O4.moment", "coupler.omega", "coupler.alpha", "O4.theta_dddot"),
    "coupler.finite_angle",
)


def test_reading_more_of_a_run_neither_searches_nor_follows(calls: Calls) -> None:
    result = fresh("rcsr").analyze([], tables=[])
    before = dict(calls.count)
    for name in COLUMNS:
        assert np.isfinite(result[name]).all()
    assert calls.count["follow"] == before["follow"]
    assert calls.count["search"] == before["search"]
    runs = calls.count["run"] - before["run"]
    for name in COLUMNS:
        result[name]
    assert calls.count["run"] - before["run"] == runs <= len(COLUMNS) + 1


def test_a_question_asked_twice_does_its_work_once(calls: Calls) -> None:
    rcsr = fresh("rcsr")
    first = rcsr.modes()
    once = dict(calls.count)
    assert [mode.name for mode in rcsr.modes().modes] == [mode.name for mode in first.modes]
    rcsr.ranges()
    assert calls.count["search"] - once["search"] <= 2  # answered from what is kept
    assert rcsr.session is rcsr.session
    assert rcsr.session.plan is rcsr.session.plan


@pytest.mark.parametrize("stem", [*NAMES, *LECTURES[:4]])
def test_bytes_do_not_depend_on_when_a_quantity_is_read(stem: str) -> None:
    """All coordinates, rates and efforts at once, and one after the other of a run without them."""
    mechanism = fresh(stem)
    names = [*mechanism.problem.mechanism.coordinates]
    names += [f"{name}_dot" for name in names] + [f"{name}_ddot" for name in names]
    names += [name for name in sorted(mechanism.quantities) if name.endswith(".effort")]
    try:
        at_once = mechanism.analyze(names, tables=[])
    except Exception:  # forces refused where a leg's spin is loaded: read the motion alone
        names = [name for name in names if not name.endswith(".effort")]
        at_once = mechanism.analyze(names, tables=[])
    later = mechanism.analyze([], tables=[])
    for name in reversed(names):
        assert later[name].tobytes() == at_once[name].tobytes(), name


def test_verdicts_can_be_read_afterwards() -> None:
    result = fresh("rcsr").analyze([], tables=[])
    together = fresh("rcsr").analyze(["O1.effort"], tables=[])
    power = result["row.power_error"]
    assert np.isfinite(power).all()
    assert power.tobytes() == together["row.power_error"].tobytes()
    # the condition comes from factors that are there, and is good to 1 %
    assert result["row.condition"] == pytest.approx(together["row.condition"], rel=0.01)
