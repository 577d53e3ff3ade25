"""The kernel's enumerations, bound from its sources and defined only there."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import (
        ContactCode as ContactCode,
        Demand as Demand,
        FreeCode as FreeCode,
        FrictionState as FrictionState,
        LoadCode as LoadCode,
        OutputCode as OutputCode,
        PassageEnd as PassageEnd,
        ReadCode as ReadCode,
        RowFlag as RowFlag,
        TrackEnd as TrackEnd,
        TreeCode as TreeCode,
    )
else:
    from mechkin_cli.kernel import _kernel

    ContactCode = _kernel.ContactCode
    Demand = _kernel.Demand
    FreeCode = _kernel.FreeCode
    FrictionState = _kernel.FrictionState
    LoadCode = _kernel.LoadCode
    OutputCode = _kernel.OutputCode
    PassageEnd = _kernel.PassageEnd
    ReadCode = _kernel.ReadCode
    RowFlag = _kernel.RowFlag
    TrackEnd = _kernel.TrackEnd
    TreeCode = _kernel.TreeCode
