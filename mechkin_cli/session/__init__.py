"""A plan with its inputs: close a position, follow a path, run rows, in doubles or double-double.

A session is a value; another packing, size or first assembly is another session. Everything that is
computed about positions and rows goes through here into the kernel.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.session.assembled_places import *
    from mechkin_cli.session.cells import *
    from mechkin_cli.session.double_double import *
    from mechkin_cli.session.followers import *
    from mechkin_cli.session.following import *
    from mechkin_cli.session.inputs import *
    from mechkin_cli.session.kernel_run import *
    from mechkin_cli.session.path import *
    from mechkin_cli.session.redundancy import *
    from mechkin_cli.session.session import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "assembled_places": "Coordinate Structure left_free solver_graph",
        "cells": "Formula cells_of jumps_of",
        "double_double": "Precise PreciseInputs ShiftingPrecise precise_inputs",
        "followers": "InputPath angle_slots followers_of input_path input_rest",
        "following": "Ending Followed Runaway follow step_limits step_numbers",
        "inputs": "KernelInputs ORIENTATION continuous_angle continuous_signs drawn_quaternion "
        "held_values input_number input_numbers input_text input_unit kernel_inputs "
        "quaternion_product reduce_angle round_of turn_of turned_quaternion",
        "kernel_run": "Ask Batch Chart POSITIONS PreciseConstants RESIDUAL_TESTS RowInputs "
        "assembly_size balance run turn_count",
        "path": "Route places_at places_of",
        "redundancy": "equations_that_follow",
        "session": "Between Continued Exchanged Packing Session exchange find_limit lies_in_family "
        "moves_freely",
    },
)
