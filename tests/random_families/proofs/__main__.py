"""Proofs of random linkages against closed forms at 40 digits.

`python -P tests/random_families/proofs --seeds 0:1000`: exit code 1 where something is proven that
is not so: a row, the way to it, its rates, a mode, or a jump made on purpose.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.proofs.judge import run_one
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    sys.exit(judge_seeds("proofs", __doc__, run_one, "0:200"))
