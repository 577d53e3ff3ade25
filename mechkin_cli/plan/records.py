"""The records of a kernel plan as plain data, the kernel's enumerations in them, and the one place
that hands them over.

A record is a call of the kernel's `PlanBuilder` with its arguments in their order (`_kernel.pyi`).
Its *constants* are the numbers that parameters may vary; the others (codes, indices, signs) are
structure. The kernel numbers constants in the order of the records and, within a record, of its
arguments, and `flatten` gives them in that order, whatever kind of number they are: floats for a
plan, or the results of other arithmetic that is recorded or repeated elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import (
        ContactCode as ContactCode,
        Demand as Demand,
        FreeCode as FreeCode,
        FrictionState as FrictionState,
        FrictionTold as FrictionTold,
        LoadCode as LoadCode,
        OutputCode as OutputCode,
        Outputs,
        PassageEnd as PassageEnd,
        Plan,
        ReadCode as ReadCode,
        RowFlag as RowFlag,
        TrackEnd as TrackEnd,
        TreeCode as TreeCode,
    )
else:
    # the kernel's enumerations, defined only in its sources
    ContactCode = _kernel.ContactCode
    Demand = _kernel.Demand
    FreeCode = _kernel.FreeCode
    FrictionState = _kernel.FrictionState
    FrictionTold = _kernel.FrictionTold
    LoadCode = _kernel.LoadCode
    OutputCode = _kernel.OutputCode
    PassageEnd = _kernel.PassageEnd
    ReadCode = _kernel.ReadCode
    RowFlag = _kernel.RowFlag
    TrackEnd = _kernel.TrackEnd
    TreeCode = _kernel.TreeCode


Number = Any
"""A float, or a number of another arithmetic."""

_CONSTANTS = {
    "units": (0, 1, 2),
    "add_tree_joint": (2, 3),
    "add_closing_joint": (3, 4, 5),
    "add_hung_links": (4, 5, 6, 7),
    "add_function": (2, 3),
    "add_relation": (2, 3, 4),
    "add_mesh": (1, 2, 3),
    "add_force": (0, 1, 2),
    "add_place": (4,),
    "add_axis": (3, 5),
    "add_free_motion": (4,),
    "add_input": (2,),
    "set_inertia": (1, 2, 3),
    "set_gravity": (0,),
    "add_load": (4, 5, 6),
    "add_bushing": (3, 4, 5, 6),
    "set_load_program": (1, 3, 4),
    "add_friction": (5, 6, 7, 8, 9, 10),
    "add_contact": (1, 2, 3, 4, 5),
    "add_size_point": (1,),
}
"""The arguments of each call that are constants; the others are structure."""


PlanRecord = tuple[str, tuple[Any, ...]]
"""A call of the kernel's `PlanBuilder` and its arguments; `units` is its constructor, with length
unit, origin and size of the mechanism in m."""


def record(call: str, *arguments: Any) -> PlanRecord:
    """The record of a call."""
    return call, arguments


class Program(NamedTuple):
    """Arithmetic over quantities, see the kernel's `ProgramOf`: the values of loads that vary.

    `reads` are kind, then type, number, freedom and order of an `Output`; `numbers` data and factor
    of each. A curve is (over, low, high, count): over a register, nan outside [low, high], of so
    many of the `knots`, each x and y, b, c, d of its piece. `outputs` are registers, `kinks`
    numbers of operations.
    """

    reads: Sequence[tuple[int, int, int, int, int]]
    numbers: Sequence[Number]
    curves: Sequence[tuple[int, float, float, int]]
    knots: Sequence[Number]
    constants: Sequence[Number]
    operations: Sequence[int]
    operands: Sequence[tuple[int, int, int]]
    outputs: Sequence[int]
    kinks: Sequence[int]


class Output(NamedTuple):
    """A quantity that a run writes, see the kernel's `OutputCode`; `factor` carries it to SI. Its
    constants are `data` and `factor`."""

    type: int
    number: int
    freedom: int
    order: int
    data: Sequence[Number]
    factor: Number


def flatten(records: Iterable[PlanRecord | Output]) -> list[Number]:
    """The constants of some records in the order in which the kernel numbers them."""
    constants: list[Number] = []
    for record in records:
        if isinstance(record, Output):
            constants += [*record.data, record.factor]
            continue
        call, arguments = record
        for place in _CONSTANTS.get(call, ()):
            value = arguments[place]
            constants += value if isinstance(value, tuple | list) else [value]
    return constants


def hand_over(records: Sequence[PlanRecord]) -> Plan:
    """The kernel's plan of some records, `units` first.

    Raises:
        ValueError: records that do not fit together; numbers that are not finite.
    """
    (_, units), *others = records
    builder = _kernel.PlanBuilder(*units)
    for call, arguments in others:
        getattr(builder, call)(*arguments)
    return builder.finish()


def hand_over_outputs(plan: Plan, records: Sequence[Output]) -> Outputs:
    """The kernel's outputs of some records, for plans of one structure.

    Raises:
        ValueError: a record that the plan cannot serve.
    """
    return _kernel.Outputs(plan, list(records))
