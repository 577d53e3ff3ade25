"""Computations recorded once and replayed in other numbers.

A tape is recorded by running ordinary code on traced scalars. Replayed in floats, exact sums,
double-doubles, decimals or intervals, it gives what the code would give there; where the code
branched on a value the tape holds a guard, and a replay that fails a guard says so.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.tape.decimals import (
        NotEnclosed as NotEnclosed,
        double_doubles as double_doubles,
        enclosures as enclosures,
    )
    from mechkin_cli.tape.double_double import *
    from mechkin_cli.tape.exact import *
    from mechkin_cli.tape.identities import *
    from mechkin_cli.tape.recorder import *
    from mechkin_cli.tape.row_programs import *
    from mechkin_cli.tape.scalars import *
    from mechkin_cli.tape.tape import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "decimals": "NotEnclosed double_doubles enclosures",
        "double_double": "DoubleDoubles bounded difference eliminate exactly joined stacked",
        "exact": "ExactRecorder ExactRows ShiftingRecorder",
        "identities": "Identities",
        "recorder": "Filling GivenRows Instruction Recorder TraceLost Traced differ is_traced "
        "of_numbers register with_rates within",
        "row_programs": "JetNumber RowRecorder SLOPES orders_of",
        "scalars": "Recorded Undecided advice as_recorded by_rounding cos either is_finite "
        "is_number is_settled largest next_power_of_two nonzero of_one of_two plain sin smallest "
        "square_root",
        "tape": "CONDITIONS ExactTape Operation Tape Verdict compiled replay replay_precise "
        "tape_values",
    },
)
