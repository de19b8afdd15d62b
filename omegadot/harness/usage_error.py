"""What is raised for wrong words on the command line."""

from __future__ import annotations


class UsageError(ValueError):
    """The command line asks for what cannot be; the message is one sentence."""
