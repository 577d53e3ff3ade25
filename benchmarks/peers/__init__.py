"""Other libraries by the methods of `mechkin_cli.bench`, one file for each."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from benchmarks.peers import with_casadi, with_mujoco, with_pinocchio
from mechkin_cli.bench import runs
from mechkin_cli.bench.measurement import Method, Unable
from mechkin_cli.bench.runs import Family
from mechkin_cli.bench.scene import BenchScene

INSTALL = "pip install -r benchmarks/requirements.txt"


def _here(make: Family, scene: BenchScene) -> Iterator[Method]:
    """
    Raises:
        Unable: the library is not installed.
    """
    try:
        yield from make(scene)
    except ImportError as error:
        name = str(error.name or "").partition(".")[0]
        raise Unable(f"{name} is not installed ({INSTALL})") from None


PEERS: dict[str, Family] = {
    name: partial(_here, make)
    for name, make in {
        "Pinocchio": with_pinocchio.methods,
        "CasADi": with_casadi.methods,
        "MuJoCo": with_mujoco.methods,
    }.items()
}
FAMILIES: dict[str, Family] = runs.FAMILIES | PEERS
"""All families of methods; the first is ours."""
