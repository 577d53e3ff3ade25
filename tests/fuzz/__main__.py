"""Coverage-guided fuzzing of reading, schema and building: `python tests/fuzz 10` (minutes).

Needs Atheris (`pip install '.[fuzz]'`, Linux): libFuzzer keeps whatever reaches new branches of the
package. Every second mutation is one of words and lines, the others are libFuzzer's own. It ends
with exit code 0 after the time, or at the first defect with its input in `crash-*`.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

PACKAGES = [
    f"mechkin_cli.{room}"
    for room in ("reading", "schema", "building", "expressions", "units", "mechanism", "solver")
]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("minutes", type=float, nargs="?", default=10.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--corpus", type=Path, help="folder that keeps what was found")
    parser.add_argument("--only", nargs="*", type=Path, help="run these inputs and stop")
    options = parser.parse_args()
    try:
        import atheris
    except ImportError:
        sys.exit("this needs Atheris: pip install '.[fuzz]' (Linux)")
    with atheris.instrument_imports(include=PACKAGES):
        from fuzz.mutation import mutated
        from fuzz.seeds import LONGEST, seeds, words
        from fuzz.verdict import verdict

        import mechkin_cli.model.model  # noqa: F401 - otherwise loaded later, without counters
    if options.only:
        for path in options.only:
            print(f"{path}: {verdict(path.read_bytes())}")
        return
    first, vocabulary = seeds(), words()

    def mutate(content: bytes, most: int, seed: int) -> bytes:
        dice = random.Random(seed)
        if dice.random() < 0.5:
            return bytes(atheris.Mutate(content, most))
        return mutated(bytes(content), first, vocabulary, dice)[:most]

    with tempfile.TemporaryDirectory() as scratch:
        kept = options.corpus or Path(scratch) / "kept"
        kept.mkdir(parents=True, exist_ok=True)
        start = Path(scratch) / "seeds"
        start.mkdir()
        for number, content in enumerate(first):
            (start / f"{number:04}").write_bytes(content)
        flags = [
            f"-max_total_time={int(options.minutes * 60)}",
            f"-seed={options.seed}",
            f"-max_len={LONGEST}",
            "-timeout=30",
            "-rss_limit_mb=4096",
        ]
        atheris.Setup([sys.argv[0], *flags, str(kept), str(start)], verdict, custom_mutator=mutate)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
