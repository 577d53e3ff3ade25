"""The built mechanism in SI units: links, joints, frames, inertias, loads, and its graph.

Plain immutable data in the home drawing's ground axes; no joint is a parent or a child here.
"""
