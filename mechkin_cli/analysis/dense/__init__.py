"""The dense system of all reactions at one row, as textbooks write it.

Every link's six equations of equilibrium and every pair's conditions, in the components of all
reactions and efforts. Assembled from the mechanism and the motion of its links alone; what
`mechkin analyze` prints comes from the transposed blocks of the closure (docs/numerics.md), so that
either checks the other.
"""
