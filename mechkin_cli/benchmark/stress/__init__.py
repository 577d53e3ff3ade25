"""Hard mechanisms by the thousand, every row decided by closed forms in double-double arithmetic.

No code of the solver is used to decide: the numbers are NumPy's IEEE + - * / sqrt alone, so that
counts and errors do not depend on the machine.
"""
