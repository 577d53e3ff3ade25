"""What can move: the answers are whole numbers and words, so NumPy's linear algebra may serve."""

from mechkin_cli.analysis.mobility.mobility import Mobility, find_mobility
from mechkin_cli.analysis.mobility.redundancy import Redundancy
from mechkin_cli.freedoms.idle import IdleFreedom

__all__ = ["IdleFreedom", "Mobility", "Redundancy", "find_mobility"]
