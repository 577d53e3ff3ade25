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
    from mechkin_cli.tape.double_double import (
        DoubleDoubles as DoubleDoubles,
        bounded as bounded,
        difference as difference,
        eliminate as eliminate,
        exactly as exactly,
        joined as joined,
        stacked as stacked,
    )
    from mechkin_cli.tape.exact import (
        ExactRecorder as ExactRecorder,
        ExactRows as ExactRows,
        ShiftingRecorder as ShiftingRecorder,
    )
    from mechkin_cli.tape.identities import Identities as Identities
    from mechkin_cli.tape.recorder import (
        Filling as Filling,
        Instruction as Instruction,
        Recorder as Recorder,
        Traced as Traced,
        TraceLost as TraceLost,
        differ as differ,
        is_traced as is_traced,
        of_numbers as of_numbers,
        register as register,
        with_rates as with_rates,
        within as within,
    )
    from mechkin_cli.tape.row_programs import (
        SLOPES as SLOPES,
        JetNumber as JetNumber,
        RowRecorder as RowRecorder,
        orders_of as orders_of,
    )
    from mechkin_cli.tape.scalars import (
        Recorded as Recorded,
        Undecided as Undecided,
        advice as advice,
        as_recorded as as_recorded,
        by_rounding as by_rounding,
        cos as cos,
        either as either,
        is_finite as is_finite,
        is_number as is_number,
        is_settled as is_settled,
        largest as largest,
        next_power_of_two as next_power_of_two,
        nonzero as nonzero,
        of_one as of_one,
        of_two as of_two,
        plain as plain,
        sin as sin,
        smallest as smallest,
        square_root as square_root,
    )
    from mechkin_cli.tape.tape import (
        CONDITIONS as CONDITIONS,
        ExactTape as ExactTape,
        Operation as Operation,
        Tape as Tape,
        Verdict as Verdict,
        compiled as compiled,
        replay as replay,
        replay_precise as replay_precise,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "decimals": "NotEnclosed double_doubles enclosures",
        "double_double": "DoubleDoubles bounded difference eliminate exactly joined stacked",
        "exact": "ExactRecorder ExactRows ShiftingRecorder",
        "identities": "Identities",
        "recorder": "Filling Instruction Recorder TraceLost Traced differ is_traced of_numbers "
        "register with_rates within",
        "row_programs": "JetNumber RowRecorder SLOPES orders_of",
        "scalars": "Recorded Undecided advice as_recorded by_rounding cos either is_finite "
        "is_number is_settled largest next_power_of_two nonzero of_one of_two plain sin smallest "
        "square_root",
        "tape": "CONDITIONS ExactTape Operation Tape Verdict compiled replay replay_precise",
    },
)
