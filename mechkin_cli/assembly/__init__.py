"""Which assembly the first row has: as drawn, near what the file names, by mode, across a fold."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.assembly.fold import (
        PlacesBefore as PlacesBefore,
        at_unit_rate as at_unit_rate,
        condition_at as condition_at,
        left_for as left_for,
        meant_branch as meant_branch,
        unit_rates as unit_rates,
    )
    from mechkin_cli.assembly.home import (
        NamedModes as NamedModes,
        is_cyclic as is_cyclic,
        is_home_assembled as is_home_assembled,
        name_modes as name_modes,
        nearest_to_home as nearest_to_home,
        probe_of as probe_of,
        wrapped as wrapped,
    )
    from mechkin_cli.assembly.near import (
        NEAR as NEAR,
        AssemblyStart as AssemblyStart,
        nothing_found as nothing_found,
    )
    from mechkin_cli.assembly.start import (
        HOME as HOME,
        MAY_BE_RIGID as MAY_BE_RIGID,
        choose_start as choose_start,
        continued_start as continued_start,
        mode_letter as mode_letter,
        state_at_first_row as state_at_first_row,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "fold": "PlacesBefore at_unit_rate condition_at left_for meant_branch unit_rates",
        "home": "NamedModes is_cyclic is_home_assembled name_modes nearest_to_home probe_of "
        "wrapped",
        "near": "AssemblyStart NEAR nothing_found",
        "start": "HOME MAY_BE_RIGID choose_start continued_start mode_letter state_at_first_row",
    },
)
