"""Does an answer depend on what was asked before?

    python -P tests/random_families/same_answers COUNT SEED [spoil]

draws COUNT mechanisms (plane and space, loops 0 to 3, legs, idle freedoms, ties, laws of time,
loads that vary, friction, responses, parameters; some of them with faults), asks one model of each
many questions in random order - also through pickles, copies, models with other parameters, and
from threads - and each question of a model that was loaded for it alone. Every answer has to be
the same to the bit, whatever lanes and threads. With `spoil` the free memory is filled with nan
and the like before the one, and with zeros before the other, so that what is read before it is
written shows. The mechanisms are written from docs/format.md alone; only the installed package is
needed.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.same_answers.orders import differences, shortest


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    faults = questions = 0
    for i in range(seed, seed + count):
        found, asked, _ = differences(i, spoil="spoil" in sys.argv)
        questions += asked
        if (i - seed) % 5 == 4:
            print(f"{i - seed + 1} mechanisms, {questions} questions", file=sys.stderr, flush=True)
        for q, history, shared, fresh in found:
            faults += 1
            print(f"seed {i}: {json.dumps(q)}\n   {shortest(shared, fresh)}", flush=True)
    print(
        f"{count} mechanisms, {questions} questions, {faults} answers that depend on what was asked before"
    )
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
