"""The stream of random starts against the published words of SplitMix64 and its own statistics."""

from __future__ import annotations

import numpy as np

from mechkin_cli.kernel import functions
from mechkin_cli.kernel.functions import RandomStarts


def split_mix(seed, count):
    """Steele, Lea, Flood 2014, in whole numbers."""
    mask, state, words = 2**64 - 1, seed, []
    for _ in range(count):
        state = (state + 0x9E3779B97F4A7C15) & mask
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        words.append(z ^ (z >> 31))
    return words


def test_words_of_a_published_seed(monkeypatch):
    monkeypatch.setattr(functions, "SEED", 1234567)
    assert RandomStarts().words(3).tolist() == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
    ]


def test_pieces_make_the_same_stream():
    whole, pieces = RandomStarts(), RandomStarts()
    parts = [pieces.words(n) for n in (1, 5, 94)]
    assert whole.words(100).tolist() == np.concatenate(parts).tolist()
    assert whole.words(3).tolist() == split_mix(functions.SEED, 103)[100:]


def test_quaternions_have_no_preferred_direction():
    q = RandomStarts().quaternions(20000)
    assert np.abs((q * q).sum(axis=0) - 1.0).max() < 1e-14
    moments = q @ q.T / q.shape[1]
    assert np.abs(moments - np.eye(4) / 4).max() < 0.01


def test_words_that_are_skipped_are_those_of_the_same_stream():
    whole, skipping = RandomStarts(), RandomStarts()
    skipping.skip(37)
    assert skipping.words(5).tolist() == whole.words(42)[37:].tolist()
