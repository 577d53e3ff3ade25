"""What can move: the answers are whole numbers and words, so NumPy's linear algebra may serve."""

from mechkin_cli.analysis.mobility.idle import IdleFreedom
from mechkin_cli.analysis.mobility.mobility import Mobility, find_mobility
from mechkin_cli.analysis.mobility.redundancy import Redundancy

__all__ = ["IdleFreedom", "Mobility", "Redundancy", "find_mobility"]
