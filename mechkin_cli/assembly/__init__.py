"""Which assembly the first row has: as drawn, near what the file names, by mode, across a fold."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
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
        AssemblyStart as AssemblyStart,
        distances_of as distances_of,
        is_unclear as is_unclear,
        nothing_found as nothing_found,
    )
    from mechkin_cli.assembly.start import (
        HOME as HOME,
        MAY_BE_RIGID as MAY_BE_RIGID,
        NEAR as NEAR,
        PlacesBefore as PlacesBefore,
        at_unit_rate as at_unit_rate,
        choose_start as choose_start,
        condition_at as condition_at,
        continued_start as continued_start,
        left_for as left_for,
        mode_letter as mode_letter,
        state_at_first_row as state_at_first_row,
        unit_rates as unit_rates,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "home": "NamedModes is_cyclic is_home_assembled name_modes nearest_to_home probe_of "
        "wrapped",
        "near": "AssemblyStart distances_of is_unclear nothing_found",
        "start": "HOME MAY_BE_RIGID NEAR PlacesBefore at_unit_rate choose_start condition_at "
        "continued_start left_for mode_letter state_at_first_row unit_rates",
    },
)
