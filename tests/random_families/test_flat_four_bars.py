"""Four-bars drawn flat go on in a motion only where it is the one in which the crank moves."""

from __future__ import annotations

from random_families.flat_four_bars import KINDS, drawn, judge


def test_no_motion_is_chosen_of_two() -> None:
    cases = [drawn(number) for number in range(60)]
    words = [judge(case) for case in cases]
    assert [word for word in words if word.startswith("wrong")] == []
    # both ends are met: one motion is followed, two are told apart
    assert {case.kind for case in cases} == set(KINDS)
    followed = [
        word == "right" for case, word in zip(cases, words, strict=True) if case.leaving == 1
    ]
    assert all(followed)
    assert len(followed) > 5
