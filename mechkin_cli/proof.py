"""What is proven of one row of a table: a fixed enumeration whose members carry what the user
reads."""

from __future__ import annotations

from enum import IntEnum


class Proof(IntEnum):
    """What `--certify` found of one row; the integer value is the code that the arrays hold."""

    not_proven = 0
    proven_to_closure = 1
    proven = 2

    @property
    def label(self) -> str:
        """The name that files and messages print, such as `proven to closure`."""
        return self.name.replace("_", " ")

    @property
    def sentence(self) -> str:
        """One sentence for the reader of the row."""
        return _SENTENCES[self]


_SENTENCES = {
    Proof.not_proven: "nothing is proven of this row.",
    Proof.proven_to_closure: (
        "as many closing equations as there are unknowns have exactly one solution in a small box "
        "about the position, and the others are below a tiny bound there; the position continues "
        "that of the rows before."
    ),
    Proof.proven: (
        "there is exactly one position in a small box about the one given, and it continues that "
        "of the rows before."
    ),
}
