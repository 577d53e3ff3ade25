"""All assembly modes of a mechanism."""

from mechkin_cli.analysis.modes.modes import UNNAMED, Mode, Modes, find_modes

__all__ = ["UNNAMED", "Mode", "Modes", "find_modes"]
