"""Hard mechanisms by the thousand, every row decided in double-double arithmetic: by closed forms,
and where there are none by closing equations that are followed from the drawing.

No code of the solver is used to decide: the numbers are NumPy's IEEE + - * / sqrt alone, so that
counts and errors do not depend on the machine; roots, sines and inverses in doubles are no more
than what is refined.
"""
