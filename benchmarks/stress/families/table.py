"""All families, in the order in which they are shown."""

from __future__ import annotations

from benchmarks.stress.families import (
    change_points,
    coincident_points,
    dead_centres,
    double_modes,
    forces,
    leads,
    link_ratios,
    long_sweeps,
    many_loops,
    many_turns,
    parallel_axes,
    sizes,
    spatial_loops,
    stiff_responses,
)

FAMILIES = {
    item.FAMILY.name: item.FAMILY
    for item in (
        sizes,
        link_ratios,
        parallel_axes,
        coincident_points,
        dead_centres,
        double_modes,
        change_points,
        leads,
        many_turns,
        many_loops,
        long_sweeps,
        forces,
        spatial_loops,
        stiff_responses,
    )
}
