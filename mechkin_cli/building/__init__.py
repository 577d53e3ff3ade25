"""The validated model builder: from a checked mechanism file to the mechanism and its problem, in
SI.

Everything that needs names, dimensions or geometry is checked here; errors point at the line.
"""
