"""Machines with couplings, laws, limits, cables and curves against references of their own.

`python -P tests/random_families/driven_machines FAMILY --seeds 0:1000`; exit code 1 where something
is at fault. The families stand in `families.py`.
"""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.driven_machines.families import FAMILIES, judge
from random_families.seeds import judge_seeds

if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in FAMILIES:
        sys.exit(f"name one of the families first: {', '.join(FAMILIES)}")
    family = sys.argv.pop(1)
    sys.exit(judge_seeds(family, __doc__, partial(judge, family), "0:200"))
