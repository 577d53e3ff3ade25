"""Responses on the bench: cases with an exact motion of their own, time against error beside
others. `tree` has the dense equations of motion, `extrapolation` the exact motion."""
