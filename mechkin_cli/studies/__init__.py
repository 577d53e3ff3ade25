"""Many variants of anything, on disk: which there are, in which pieces they are computed and by
whom, and how what is kept of them is written. Nothing here knows a mechanism.
"""
