"""Random mechanisms that move by themselves, against an independent integration.

`python -P tests/random_families/response --seeds 0:100`: exit code 1 where a row is wrong or lost.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.response.case import run_one
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    sys.exit(judge_seeds("response", __doc__, run_one, "0:100"))
