"""Random linkages with `plane: xy` against the same in space and against dense equations.

`python -P tests/random_families/planar --seeds 0:2000`: exit code 1 where a position, rate,
acceleration, in-plane reaction or effort differs from that of the file in space, or of every tenth
linkage from three Newton-Euler equations a body at 50 digits.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.planar.judge import run_one
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    sys.exit(judge_seeds("planar", __doc__, run_one, "0:500"))
