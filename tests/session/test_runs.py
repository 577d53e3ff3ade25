"""Runs in double-double: legs, springs, dampers and a redundant loop against the oracle and closed
forms; the same bits however rows are packed and split."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from friction.slider_crank import TEXT as FRICTION
from mechanisms.runs import model, run
from oracle import assemble, condition_of, document, mp, newton_euler, read, to_text
from oracle_checks.legs import rssr, stewart, suspension
from properties.answers import kind
from properties.expected import expected

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.kernel.functions import widths
from mechkin_cli.mechanism.derived import DERIVED_KINDS
from mechkin_cli.plan.outputs import demand_of
from mechkin_cli.plan.records import Demand, RowFlag
from mechkin_cli.session.kernel_run import (
    Ask,
    Batch,
    PreciseConstants,
    RowInputs,
    run as run_kernel,
)
from mechkin_cli.sweep.result import Result
from mechkin_cli.units.dimension import ANGLE

CLOSE = 1e-28
MOTION = Demand.VELOCITY | Demand.ACCELERATION


def repeated(
    result: Result, names: list[str], *, written: bool = True, **given: Any
) -> tuple[Batch, dict[str, slice]]:
    """Quantities at the rows of a run in double-double, by their places among the outputs; with the
    constants as `written`, or as doubles."""
    session, known = result.session, result.problem.quantities()
    wanted = [known[name] for name in names]
    readout, demand = session.readout(wanted), demand_of(result.problem.mechanism, wanted)
    rows, precise = result.row_states, session.precise
    inputs = precise.inputs(session)
    constants = PreciseConstants()
    if written:
        own = precise.constants(session)
        constants = PreciseConstants(own, precise.outputs(session, wanted))
    batch = session.run(
        RowInputs(
            inputs.reduced,
            rows.states,
            inputs.rates,
            inputs.accelerations,
            inputs.jerks,
            turned=rows.turns,
            whole=inputs.whole,
            full=inputs.values,
        ),
        Ask(demand | MOTION, readout, **given),
        constants,
    )
    slots = readout.slots.items()
    return batch, dict(slots)


def numbers(batch: Batch, place: slice, row: int = 0) -> list[Any]:
    assert batch.outputs is not None
    parts = batch.outputs[place, :, row]
    return [mp.mpf(float(high)) + mp.mpf(float(low)) for high, low in parts]


def worst(result: Result, wanted: dict[str, Any], **given: Any) -> float:
    """The largest error in parts of the largest number of its family."""
    known = result.problem.quantities()
    names = [n for n in wanted if n in known and known[n].kind not in DERIVED_KINDS]
    batch, places = repeated(result, names, **given)
    assert batch.good.all()
    errors: dict[str, Any] = {}
    sizes: dict[str, Any] = {}
    for name in names:
        family = kind(name).family
        for x, y in zip(numbers(batch, places[name]), wanted[name], strict=True):
            off = x - y
            if known[name].dimension == ANGLE:
                off -= 2 * mp.pi * mp.nint(off / (2 * mp.pi))
            errors[family] = max(errors.get(family, 0), abs(off))
            sizes[family] = max(sizes.get(family, mp.mpf("1e-3")), abs(y))
    assert len(sizes) > 2
    return float(max(errors[family] / sizes[family] for family in errors))


LEGS = {"RSSR": rssr, "suspension": suspension, "Stewart platform": stewart}


@cache
def analyzed(text: str) -> Result:
    return mk.loads(text).analyze(tables=[]).result


@cache
def truth(text: str) -> dict[str, Any]:
    mechanism = read(text)
    solution = assemble(mechanism, mechanism.row(0))
    assert condition_of(mechanism, solution) < 1e3
    return expected(mechanism, solution, newton_euler(mechanism, solution))


@pytest.mark.parametrize("name", LEGS)
def test_legs_are_those_of_the_oracle(name: str) -> None:
    text = LEGS[name]()
    assert worst(analyzed(text), truth(text)) < CLOSE


def test_constants_as_doubles_are_seen() -> None:
    text = suspension()
    assert worst(analyzed(text), truth(text), written=False) > 1e-18


def with_loads(text: str, loads: list[dict[str, Any]]) -> str:
    data = document(text)
    data["loads"] = [*data["loads"], *loads]
    return to_text(data)


def without_sums(wanted: dict[str, Any]) -> dict[str, Any]:
    """A spring has an energy of its own, and is no force from outside."""
    sums = ("row.potential_energy", "ground.shaking_force", "ground.shaking_moment")
    return {name: value for name, value in wanted.items() if name not in sums}


def digits(value: Any) -> str:
    return str(mp.nstr(value, 55))


def test_springs_and_dampers_on_an_angle_are_the_torque_that_they_exert() -> None:
    text = rssr()
    motion = truth(text)
    at = {"joint": "D", "coordinate": "theta"}
    spring = {"type": "spring", "stiffness": "7.3", "free": "0.4 rad", "preload": "0.9"}
    drawn = with_loads(text, [spring | at, {"type": "damper", "damping": "1.7"} | at])
    angle, rate = motion["D.theta"][0], motion["D.theta_dot"][0]
    value = -(mp.mpf("7.3") * (angle - mp.mpf("0.4")) + mp.mpf("0.9")) - mp.mpf("1.7") * rate
    torque = {"type": "torque", "joint": "D", "value": digits(value)}
    wanted = without_sums(truth(with_loads(text, [torque])))
    assert worst(analyzed(drawn), wanted) < CLOSE


def test_springs_and_dampers_between_points_are_the_force_that_they_exert() -> None:
    text, link, place = suspension(), "carrier", [mp.mpf(5), mp.mpf(1), mp.mpf(3)]
    mechanism = read(text)
    solution = assemble(mechanism, mechanism.row(0))
    here, velocity = solution.motion(link, place)[:2]
    away = [x - y for x, y in zip(here, (2, 4, 1), strict=True)]
    length = mp.sqrt(sum(x * x for x in away))
    along = [x / length for x in away]
    pull = mp.mpf("7.3") * (length - mp.mpf("1.9")) + mp.mpf("0.9")
    pull += mp.mpf("1.7") * sum(x * v for x, v in zip(along, velocity, strict=True))
    force = {
        "type": "force",
        "link": link,
        "point": [digits(x) for x in place],
        "force": [digits(-pull * x) for x in along],
    }
    ends = {"between": ["p", "q"]}
    spring = {"type": "spring", "stiffness": "7.3", "free": "1.9", "preload": "0.9"}
    data = document(with_loads(text, [spring | ends, {"type": "damper", "damping": "1.7"} | ends]))
    data["points"] = {
        "p": {"link": "ground", "at": ["2", "4", "1"]},
        "q": {"link": link, "at": ["5", "1", "3"]},
    }
    wanted = without_sums(truth(with_loads(text, [force])))
    assert worst(analyzed(to_text(data)), wanted) < CLOSE


def test_a_redundant_loop_is_that_of_its_closed_form() -> None:
    result = run("sarrus").result
    batch, places = repeated(result, ["top.position", "A.theta"])
    assert batch.good.all()
    assert np.max(batch.residual[0]) < tolerances.PRECISE_RESIDUAL_ACCEPT
    for row in range(result.rows):
        fold = mp.pi / 4 - mp.mpf(5 * row - 30) * mp.pi / 180
        out, knee = mp.mpf("0.08") * mp.sin(fold), mp.mpf("0.08") * mp.cos(fold)
        height = knee + mp.sqrt(mp.mpf("0.01") - out**2)
        other = mp.pi / 4 + mp.mpf(5 * row - 30) * mp.pi / 180
        out, knee = mp.mpf("0.08") * mp.sin(other), mp.mpf("0.08") * mp.cos(other)
        height_other = knee + mp.sqrt(mp.mpf("0.01") - out**2)
        found = numbers(batch, places["top.position"], row)[2]
        assert min(abs(found - height), abs(found - height_other)) < 1e-29


@pytest.mark.parametrize(
    "text", [FRICTION, suspension(), stewart()], ids=["friction", "suspension", "platform"]
)
def test_powers_balance_to_the_last_digits(text: str) -> None:
    """The balance of powers shares no sum with the balance of forces; with friction at all joints,
    whose forces follow from the reactions."""
    result = analyzed(text)
    session, rows = result.session, result.row_states
    inputs = session.precise.inputs(session)
    batch = session.run(
        RowInputs(
            inputs.reduced,
            rows.states,
            inputs.rates,
            inputs.accelerations,
            turned=rows.turns,
            whole=inputs.whole,
        ),
        Ask(MOTION | Demand.FORCES | Demand.POWER),
        # in doubles a leg's line has no length of one
        PreciseConstants(session.precise.constants(session)),
    )
    assert batch.good.all()
    assert batch.power_error is not None
    assert np.max(np.abs(batch.power_error[0])) < CLOSE


def test_a_row_that_does_not_close_says_so() -> None:
    """A four-bar whose crank is turned where the others do not reach."""
    result = run("rssr").result
    session, rows = result.session, result.row_states
    inputs = session.precise.inputs(session)
    off = rows.states.copy() + 1e3
    doubles = PreciseConstants()
    batch = session.run(RowInputs(inputs.reduced, off), Ask(iterations=1), doubles)
    assert np.all(batch.flags & RowFlag.NOT_CONVERGED)
    assert session.run(RowInputs(inputs.reduced, rows.states), Ask(), doubles).good.all()


@pytest.mark.parametrize("name", ["rcsr", "sevenr", "stewart", "double_hooke"])
def test_bits_do_not_depend_on_packing_or_splitting(name: str) -> None:
    """Units with and without a fused multiply-add, one row and many, one thread and three."""
    session, rows = run(name).result.session, run(name).result.row_states
    inputs, states = session.inputs, rows.states[:, :37]
    names = [n for n, q in model(name).problem.quantities().items() if q.kind == "force"]
    known = model(name).problem.quantities()
    readout = session.readout([known[n] for n in names])

    def bits(part: slice, **packing: int) -> bytes:
        given = (inputs.reduced, states, inputs.rates, inputs.accelerations)
        batch = run_kernel(
            session.plan,
            RowInputs(*(array[:, :37][:, part] for array in given)),
            Ask(MOTION | Demand.FORCES, readout, derivatives=True),
            PreciseConstants(),
            **packing,
        )
        assert batch.outputs is not None
        assert batch.first is not None
        parts = (batch.states, batch.outputs, batch.first, batch.residual)
        return np.concatenate([np.atleast_3d(p.T).reshape(p.shape[-1], -1) for p in parts], 1)

    whole = bits(slice(None))
    for lanes in widths():
        assert bits(slice(None), lanes=lanes).tobytes() == whole.tobytes()
    assert bits(slice(None), threads=3).tobytes() == whole.tobytes()
    cut = np.concatenate([bits(slice(0, 1)), bits(slice(1, 12)), bits(slice(12, None))])
    assert cut.tobytes() == whole.tobytes()


def test_the_condition_is_not_told() -> None:
    session, rows = run("rssr").result.session, run("rssr").result.row_states
    with pytest.raises(ValueError, match="told by a run in doubles"):
        session.run(
            RowInputs(session.inputs.reduced, rows.states),
            Ask(Demand.CONDITION),
            PreciseConstants(),
        )


def test_numbers_that_do_not_fit_are_refused() -> None:
    session, rows = run("rssr").result.session, run("rssr").result.row_states
    inputs, constants = session.inputs.reduced, session.precise.constants(session)
    given = RowInputs(inputs, rows.states)
    with pytest.raises(ValueError, match="parts of a number"):
        session.run(
            given._replace(inputs=np.zeros((1, 3, inputs.shape[1]))), Ask(), PreciseConstants()
        )
    with pytest.raises(ValueError, match="instead of"):
        session.run(given, Ask(), PreciseConstants(constants[:-1]))
    with pytest.raises(ValueError, match="low: not finite"):
        session.run(given, Ask(), PreciseConstants(constants * np.array([1.0, np.nan])))
