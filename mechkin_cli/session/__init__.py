"""A plan with its inputs: close a position, follow a path, run rows, in doubles or double-double.

A session is a value; another packing, size or first assembly is another session. Everything that is
computed about positions and rows goes through here into the kernel.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.session.cells import Formula as Formula, cells_of as cells_of
    from mechkin_cli.session.double_double import (
        Precise as Precise,
        PreciseInputs as PreciseInputs,
        precise_inputs as precise_inputs,
    )
    from mechkin_cli.session.exchanged import (
        Exchanged as Exchanged,
        assembled_places as assembled_places,
        closed_places as closed_places,
        exchange as exchange,
    )
    from mechkin_cli.session.following import (
        BranchFold as BranchFold,
        BranchPoint as BranchPoint,
        Ending as Ending,
        EndOfRows as EndOfRows,
        Followed as Followed,
        Runaway as Runaway,
        find_limit as find_limit,
        follow as follow,
        moves_freely as moves_freely,
        step_limits as step_limits,
    )
    from mechkin_cli.session.inputs import (
        ORIENTATION as ORIENTATION,
        KernelInputs as KernelInputs,
        angle_slots as angle_slots,
        continuous_angle as continuous_angle,
        continuous_signs as continuous_signs,
        drawn_quaternion as drawn_quaternion,
        held_values as held_values,
        input_number as input_number,
        input_numbers as input_numbers,
        input_rest as input_rest,
        input_text as input_text,
        input_unit as input_unit,
        kernel_inputs as kernel_inputs,
        reduce_angle as reduce_angle,
        turn_count as turn_count,
        turn_of as turn_of,
    )
    from mechkin_cli.session.kernel_run import (
        RESIDUAL_TESTS as RESIDUAL_TESTS,
        Batch as Batch,
        Chart as Chart,
        RowPlaces as RowPlaces,
        assembly_size as assembly_size,
        run as run,
    )
    from mechkin_cli.session.path import (
        InputTie as InputTie,
        followers_of as followers_of,
        places_at as places_at,
        places_of as places_of,
    )
    from mechkin_cli.session.session import (
        Continued as Continued,
        ContinuedFrom as ContinuedFrom,
        Coordinate as Coordinate,
        Packing as Packing,
        Session as Session,
        Structure as Structure,
    )
    from mechkin_cli.session.shifted import ShiftingPrecise as ShiftingPrecise

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "cells": ["Formula", "cells_of"],
        "double_double": ["Precise", "PreciseInputs", "precise_inputs"],
        "exchanged": ["Exchanged", "assembled_places", "closed_places", "exchange"],
        "following": [
            "BranchFold",
            "BranchPoint",
            "EndOfRows",
            "Ending",
            "Followed",
            "Runaway",
            "find_limit",
            "follow",
            "moves_freely",
            "step_limits",
        ],
        "inputs": [
            "KernelInputs",
            "ORIENTATION",
            "angle_slots",
            "continuous_angle",
            "continuous_signs",
            "drawn_quaternion",
            "held_values",
            "input_number",
            "input_numbers",
            "input_rest",
            "input_text",
            "input_unit",
            "kernel_inputs",
            "reduce_angle",
            "turn_count",
            "turn_of",
        ],
        "kernel_run": ["Batch", "Chart", "RESIDUAL_TESTS", "RowPlaces", "assembly_size", "run"],
        "path": ["InputTie", "followers_of", "places_at", "places_of"],
        "session": ["Continued", "ContinuedFrom", "Structure", "Coordinate", "Packing", "Session"],
        "shifted": ["ShiftingPrecise"],
    },
)
