"""Random kinks within kinks in the loads of two sliders, against tiny steps and other rows.

`python -P tests/random_families/nested_kinks --seeds 0:1000`: exit code 1 where a row is wrong.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.nested_kinks.case import run_one
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    sys.exit(judge_seeds("nested_kinks", __doc__, run_one, "0:1000"))
