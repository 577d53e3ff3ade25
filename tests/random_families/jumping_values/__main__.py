"""Random jumps and kinks within each other as stops and loads, against closed motions, tiny steps.

`python -P tests/random_families/jumping_values --seeds 0:4000`: exit code 1 where one is wrong.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.jumping_values.case import run_one
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    sys.exit(judge_seeds("jumping_values", __doc__, run_one, "0:4000"))
