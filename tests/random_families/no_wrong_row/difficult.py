"""Numbers of mechanisms that have been wrong, and those that are not right yet."""

DIFFICULT = (
    141, 5012, 5038, 5084, 5179, 5685, 10027, 10083, 10095, 10097, 10242, 10397, 10444, 10467,
    10770, 10943, 10960, 11184, 20036, 20218, 302124,
)  # fmt: skip
"""Rows on another branch, rows beyond a fold, rows given up, or turns miscounted, once."""

NOT_YET: frozenset[int] = frozenset({10027, 10095, 20218})
"""Each fails strictly: a number whose mechanism is right must leave the set."""

SECOND_DIFFICULT = (
    15,
    34,
    43,
    91,
    116,
    144,
    145,
    194,
    211,
    283,
    1047,
    1115,
    1142,
    1222,
    1371,
    1461,
    *(21, 48, 64, 121, 179, 209, 267, 1102, 1123, 1354, 1392, 1469, 200267, 300808),
)
"""The same of the second series."""

SECOND_NOT_YET: frozenset[int] = frozenset()
"""As above."""

THIRD_NOT_YET: frozenset[int] = frozenset({110, 143, 1626, 2339, 2349})
"""Of the third series: tied cranks that start more than half a turn off the drawing (110), rows
lost beside gaps (143), the last row of a whole turn (1626, 2339), and a nearest row beyond a fold
where others are within reach on the other side (2349)."""

WRITTEN_NOT_YET: frozenset[tuple[int, int]] = frozenset()
"""Series and numbers whose rows change when they are written otherwise."""

CIRCUITS_NOT_YET: frozenset[int] = frozenset({339, 431, 435, 836})
"""Loops whose ranges or circuits contradict their discriminants."""

CLOSED_NOT_YET: frozenset[int] = frozenset({11})
"""Numbers of the third series that are lost when they are closed at other joints."""
