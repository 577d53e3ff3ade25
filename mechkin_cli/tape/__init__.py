"""Tapes: the arithmetic between some numbers given and the numbers computed from them, as data.

A tape is recorded once by running ordinary code on `Traced` scalars and then replayed for other
numbers. Its operations are abstract: an evaluator gives them their meaning in floats, lanes of
floats, or any other arithmetic. Every decision that the code took on a value stands on the tape as
a guard: where a guard fails, the code would have gone another way and the replay says nothing.
"""
