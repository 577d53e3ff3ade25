"""The families of driven machines by their names."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from random_families.driven_machines import (
    cables,
    cam_profiles,
    each_way,
    misread,
    on_carriers,
    rebounds,
    rises,
    said_otherwise,
    tracks,
    wheels_in_space,
)
from random_families.driven_machines.judged import Judged

FAMILIES: dict[str, Callable[[np.random.Generator, Judged], None]] = {
    "wheels_in_space": wheels_in_space.judge,
    "each_way": each_way.judge,
    "rises": rises.judge,
    "rebounds": rebounds.judge,
    "tracks": tracks.judge,
    "cables": cables.judge,
    "cam_profiles": cam_profiles.judge,
    "on_carriers": on_carriers.judge,
    "said_otherwise": said_otherwise.judge,
    "misread": misread.judge,
}


def judge(name: str, seed: int) -> Judged:
    """A seed of a family; what it raises is a fault."""
    judged = Judged()
    try:
        FAMILIES[name](np.random.default_rng(seed), judged)
    except Exception as error:  # to be told beside the others
        judged.faults.append(f"{type(error).__name__}: {error}"[:300])
    return judged
