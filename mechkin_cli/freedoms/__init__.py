"""What a mechanism can do with its inputs free: its configurations, the dimension of its motions,
and its idle freedoms with what holds them.

NumPy's linear algebra may serve: the answers are whole numbers, words, and directions that are
rounded before a plan sees them.
"""
