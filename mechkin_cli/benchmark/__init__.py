"""`mechkin bench`: run time against error for RCSR and a general 7R, and a family of extreme cases.

Everything is measured in one run on one thread; errors are against a solution in extended precision
that is computed in the same run from 4x4 matrices and shares no formula with the package.
"""
