"""Quantities that are computed from others after a run: orientations, screws, mechanical advantage,
transmission angle. The room is imported only where one is asked for."""

from mechkin_cli.analysis.derived.basis import Reading, basis_of
from mechkin_cli.analysis.derived.columns import derived_columns

__all__ = ["Reading", "basis_of", "derived_columns"]
