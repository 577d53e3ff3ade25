"""Limits on expressions: far above what a drawing needs, far below what could stall a reader."""

MAX_TEXT_LENGTH = 4000
"""Characters; the longest columns of published tables have about a hundred."""

MAX_NODES = 1000
"""Numbers, names and operations of one expression."""

MAX_EXPANDED = 20000
"""The same with quantities and derivatives in the places of their names: some 1e-4 s a row of
each."""

MAX_DEPTH = 50
"""Nested parentheses, calls, signs and powers; bounds the recursion of the parser."""

MAX_EXPONENT = 16
"""Size of a base dimension's exponent, and of a whole power of a value with a dimension."""

MAX_ERRORS = 50
"""Errors of a file's parameters; with more, the rest of them is not evaluated."""

MAX_CHAIN = 8
"""Names of a circle of parameters that a message shows."""

MAX_QUOTED = 40
"""Characters of the user's text repeated in a message."""
