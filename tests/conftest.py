"""Tests import `benchmarks` from the repository's root, and mechkin from where it is installed."""

import sys
from pathlib import Path

# behind everything else: the source folder of the package lies in the root, too
sys.path.append(str(Path(__file__).resolve().parents[1]))
