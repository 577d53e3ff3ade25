"""What the benchmark ran on."""

from __future__ import annotations

import platform
from pathlib import Path

import numpy as np

from mechkin_cli.kernel.functions import widths


def machine() -> dict[str, str]:
    """Processor, lane widths, and the versions that matter, by name."""
    return {
        "processor": _processor(),
        "lanes": "/".join(map(str, widths())),
        "Python": platform.python_version(),
        "numpy": np.__version__,
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
