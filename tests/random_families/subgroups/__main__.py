"""Proofs of random plane, spherical and sliding loops whose text alone tells that they are such.

`python -P tests/random_families/subgroups --seeds 0:500`: exit code 1 where one is not proven, does
not hold its position at 40 digits, or is proven with a number off.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.seeds import judge_seeds
from random_families.subgroups.judge import run_one

if __name__ == "__main__":
    sys.exit(judge_seeds("subgroups", __doc__, run_one, "0:100"))
