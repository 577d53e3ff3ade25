"""Random blocks that rest and slip under loads over time, against scipy.

`python -P tests/random_families/resting_blocks --seeds 0:60`: exit code 1 where a row is wrong or
lost.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.resting_blocks.case import run_one
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    sys.exit(judge_seeds("resting_blocks", __doc__, run_one, "0:60"))
