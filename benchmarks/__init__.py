"""What the project measures of mechkin, and nobody who uses it has to: other libraries, responses,
variants, hard mechanisms by the thousand, and the pages that say what was found.

`python -m benchmarks` in the repository's root; see `README.md`.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

# Python run in the root puts that first: the installed mechkin has a built kernel, its source none
if not sys.flags.safe_path and Path(sys.path[0]).resolve() == ROOT:
    sys.path[:] = [*sys.path[1:], str(ROOT)]
