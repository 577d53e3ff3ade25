"""How much one page holds; where a run has more, a note says what was left out."""

MOST_POSES = 2000
"""Poses of a branch: at 60 pictures a second half a minute of motion without a pose shown twice,
and 56 kB for each link."""

MOST_ROWS = 20_000
"""Rows of a branch that curves and tables show: more than any screen has points."""

MOST_CELLS = 400_000
"""Cells of the tables of a branch that are shown, and of those of all other modes together: 12 MB
as texts and numbers."""

LEAST_ROWS = 200
"""Rows of a branch that are shown however many columns and modes there are."""

MOST_MODES = 16
"""Assembly modes that are shown beside the file's own: more can hardly be told apart by eye."""

MOST_MODE_ROWS = 100_000
"""Rows of all other assembly modes together: half a second of work for most mechanisms."""

MOST_MODE_POSES = 8000
"""Poses of all other assembly modes together, as many as of four runs."""

POINTS_APART = 0.001
"""Points of a link nearer to each other than this part of the mechanism's size are one."""

FLATNESS = 0.01
"""Points of a link lie in a line, or in a plane, where they are off by at most this part of their
extent: less than the thickness of what is drawn."""
