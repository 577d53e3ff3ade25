"""The page of right digits is that of the tables kept here."""

from __future__ import annotations

from mechanisms.right_digits.page import PAGE, page


def test_the_page_is_up_to_date():
    assert PAGE.read_text(encoding="utf-8") == page()
