"""A plan with its inputs: close a position, follow a path, run rows, in doubles or double-double.

A session is a value; another packing, size or first assembly is another session. Everything that is
computed about positions and rows goes through here into the kernel.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.session.assembled_places import (
        Coordinate as Coordinate,
        Structure as Structure,
        left_free as left_free,
        solver_graph as solver_graph,
    )
    from mechkin_cli.session.cells import Formula as Formula, cells_of as cells_of
    from mechkin_cli.session.double_double import (
        Precise as Precise,
        PreciseInputs as PreciseInputs,
        ShiftingPrecise as ShiftingPrecise,
        precise_inputs as precise_inputs,
    )
    from mechkin_cli.session.followers import (
        InputPath as InputPath,
        angle_slots as angle_slots,
        followers_of as followers_of,
        input_path as input_path,
        input_rest as input_rest,
    )
    from mechkin_cli.session.following import (
        Ending as Ending,
        Followed as Followed,
        Runaway as Runaway,
        follow as follow,
        step_limits as step_limits,
    )
    from mechkin_cli.session.inputs import (
        ORIENTATION as ORIENTATION,
        KernelInputs as KernelInputs,
        continuous_angle as continuous_angle,
        continuous_signs as continuous_signs,
        drawn_quaternion as drawn_quaternion,
        held_values as held_values,
        input_number as input_number,
        input_numbers as input_numbers,
        input_text as input_text,
        input_unit as input_unit,
        kernel_inputs as kernel_inputs,
        quaternion_product as quaternion_product,
        reduce_angle as reduce_angle,
        turn_count as turn_count,
        turn_of as turn_of,
        turned_quaternion as turned_quaternion,
    )
    from mechkin_cli.session.kernel_run import (
        POSITIONS as POSITIONS,
        RESIDUAL_TESTS as RESIDUAL_TESTS,
        Ask as Ask,
        Batch as Batch,
        Chart as Chart,
        PreciseConstants as PreciseConstants,
        RowInputs as RowInputs,
        assembly_size as assembly_size,
        run as run,
    )
    from mechkin_cli.session.path import places_at as places_at, places_of as places_of
    from mechkin_cli.session.redundancy import equations_that_follow as equations_that_follow
    from mechkin_cli.session.session import (
        Between as Between,
        Continued as Continued,
        Exchanged as Exchanged,
        Packing as Packing,
        Session as Session,
        exchange as exchange,
        find_limit as find_limit,
        moves_freely as moves_freely,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "assembled_places": "Coordinate Structure left_free solver_graph",
        "cells": "Formula cells_of",
        "double_double": "Precise PreciseInputs ShiftingPrecise precise_inputs",
        "followers": "InputPath angle_slots followers_of input_path input_rest",
        "following": "Ending Followed Runaway follow step_limits",
        "inputs": "KernelInputs ORIENTATION continuous_angle continuous_signs drawn_quaternion "
        "held_values input_number input_numbers input_text input_unit kernel_inputs "
        "quaternion_product reduce_angle turn_count turn_of turned_quaternion",
        "kernel_run": "Ask Batch Chart POSITIONS PreciseConstants RESIDUAL_TESTS RowInputs "
        "assembly_size run",
        "path": "places_at places_of",
        "redundancy": "equations_that_follow",
        "session": "Between Continued Exchanged Packing Session exchange find_limit moves_freely",
    },
)
