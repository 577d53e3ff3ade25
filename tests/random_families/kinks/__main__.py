"""Random mechanisms under loads with kinks, against an independent integration.

`python -P tests/random_families/kinks --seeds 0:200`: exit code 1 where a row is wrong or lost.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.kinks.case import run_one
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    sys.exit(judge_seeds("kinks", __doc__, run_one, "0:200"))
