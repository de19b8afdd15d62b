"""What a reader is to know of a run, and the command that goes further: for page and terminal."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Advice:
    """text: whole sentences.  command: to type.  purpose: what that does, as the rest of a sentence
    that begins with it.
    """

    text: str
    command: str
    purpose: str

    @property
    def sentence(self) -> str:
        """All of it in a row."""
        return f"{self.text} {self.command} {self.purpose}."
