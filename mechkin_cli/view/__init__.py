"""What `mechkin view` shows: a mechanism as drawn, its poses along its runs, curves, tables and
notes, as the data of one page.

Lengths, angles and all else are in the file's units. A link's pose is its displacement from the
home drawing: x = R(q) x0 + t.
"""
