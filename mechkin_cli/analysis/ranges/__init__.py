"""From where to where an input can go in each assembly mode."""

from mechkin_cli.analysis.ranges.ranges import Extreme, Limit, Range, Ranges, find_ranges

__all__ = ["Extreme", "Limit", "Range", "Ranges", "find_ranges"]
