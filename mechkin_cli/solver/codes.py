"""The kernel's enumerations; they are bound from its sources and said only there."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import (
        ContactCode as ContactCode,
    )
    from mechkin_cli.kernel._kernel import (
        Demand as Demand,
    )
    from mechkin_cli.kernel._kernel import (
        FreeCode as FreeCode,
    )
    from mechkin_cli.kernel._kernel import (
        FrictionState as FrictionState,
    )
    from mechkin_cli.kernel._kernel import (
        LoadCode as LoadCode,
    )
    from mechkin_cli.kernel._kernel import (
        OutputCode as OutputCode,
    )
    from mechkin_cli.kernel._kernel import (
        PassageEnd as PassageEnd,
    )
    from mechkin_cli.kernel._kernel import (
        ReadCode as ReadCode,
    )
    from mechkin_cli.kernel._kernel import (
        RowFlag as RowFlag,
    )
    from mechkin_cli.kernel._kernel import (
        TrackEnd as TrackEnd,
    )
    from mechkin_cli.kernel._kernel import (
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
