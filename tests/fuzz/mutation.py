"""Small damage to the bytes of a file, in the pieces that a person writes: words, lines, marks."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence

_PIECE = re.compile(rb"[A-Za-z_.][A-Za-z0-9_.]*|[0-9][0-9.e]*|\n *|[^A-Za-z0-9_]")


def mutated(
    content: bytes, others: Sequence[bytes], words: Sequence[bytes], dice: random.Random
) -> bytes:
    """The content with one to four pieces removed, doubled, swapped, replaced or taken over."""
    pieces = _PIECE.findall(content) or [b""]
    for _ in range(dice.randint(1, 4)):
        at = dice.randrange(len(pieces) or 1)
        span = dice.choice((1, 1, 1, 2, 5, 20))
        match dice.randrange(6):
            case 0:
                del pieces[at : at + span]
            case 1:
                pieces[at:at] = pieces[at : at + span] * dice.choice((1, 1, 3, 40))
            case 2:
                pieces[at : at + 1] = [dice.choice(words)]
            case 3:
                pieces[at:at] = [dice.choice(words)]
            case 4:
                other = _PIECE.findall(dice.choice(others)) or [b""]
                start = dice.randrange(len(other))
                pieces[at : at + span] = other[start : start + span]
            case _:
                other_at = dice.randrange(len(pieces) or 1)
                if pieces:
                    pieces[at], pieces[other_at] = pieces[other_at], pieces[at]
    return b"".join(pieces)
