"""What proofs cost, and how many tubes they take:

    python -P tests/proofs/cost.py

CPU time on one thread, the least of thirty, with the numbers of the text enclosed before. `all` is
one figure: boxes of all rows, tubes from end to end, and velocities and accelerations of all
coordinates enclosed.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))

import mechkin_cli as mk
from benchmarks import sevenr, train
from mechkin_cli.proofs.boxes import Enclosed, Nodes, prove_boxes
from mechkin_cli.proofs.enclose import EnclosedInputs, Positions, enclose
from mechkin_cli.proofs.rows import certify

REPETITIONS = 30
RCSR = Path(__file__).parents[2] / "mechanisms" / "dissertation" / "rcsr.yaml"
SWEEP = "from: 150, to: 202, step: 2"


def least_time(work: Callable[[], object]) -> float:
    times = []
    for _ in range(REPETITIONS):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return 1e3 * min(times)


def tell(name: str, model: mk.Model) -> None:
    result = model.analyze(tables=[]).result
    session, states = result.session, result.row_states.states
    first = time.process_time()
    found = certify(session, states, result.solved)
    first = 1e3 * (time.process_time() - first)
    nodes = Nodes.of(session, session.inputs.values, session.inputs.reduced, states)
    enclosed = session.once("enclosed", lambda: Enclosed.of(session))
    rows = least_time(lambda: prove_boxes(enclosed, nodes))
    given, whole = EnclosedInputs.of(session), result.row_states.turns
    quantities = model.problem.quantities().values()
    wanted = [q for q in quantities if q.kind == "coordinate" and q.order in (1, 2)]

    def prove_all() -> None:
        proofs = certify(session, states, result.solved)
        positions = Positions(enclosed.plan, enclosed.constants, states, proofs.boxes.radius)
        known = enclose(session, positions, given, wanted, turned=whole)
        assert all(np.isfinite(one.radius).all() for one in known.values())

    both = least_time(lambda: certify(session, states, result.solved))
    print(
        f"{name}: {result.rows} rows, {'one branch' if found.is_complete else found.gaps}, "
        f"{found.tubes} tubes; boxes {rows:.2f} ms, with tubes {both:.2f} ms, "
        f"all {least_time(prove_all):.2f} ms; first {first:.0f} ms",
        flush=True,
    )


def main() -> None:
    text = RCSR.read_text(encoding="utf-8")
    tell("RCSR", mk.loads(text.replace(SWEEP, "from: 150, to: 205, count: 361")))
    tell("7R full turn", mk.loads(sevenr.text()))
    tell("ten loops", mk.loads(train.text()))
    model = mk.loads(text.replace(SWEEP, "from: 150, to: 210, step: 2"))
    notes = [d for d in model.analyze(tables=[]).diagnostics if d.code == "dead-centre"]
    end = next(number.value for number in notes[0].numbers if number.name == "O1.theta")
    for decade in range(1, 10):
        rows = f"values: [200, {end - 10.0**-decade!r}]"
        proofs = mk.loads(text.replace(SWEEP, rows)).certify()
        print(f"to 1e-{decade} deg before the dead centre: {proofs.words}")


if __name__ == "__main__":
    main()
