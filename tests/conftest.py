"""Tests import `benchmarks` from the repository's root, and mechkin from where it is installed."""

import signal
import sys
from pathlib import Path

# tests that are started in the background ignore interrupts, and so would the commands they run
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# behind everything else: the source folder of the package lies in the root, too
sys.path.append(str(Path(__file__).resolve().parents[1]))
