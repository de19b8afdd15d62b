"""Conditions that a cause states by itself: they are not repeated after it."""

from __future__ import annotations

import re

DAMPED = "the body is damped"
# What becomes of a damping that was requested. What an engine has of its own acts without one.
OF_DAMPING = re.compile(
    r"(?:in the steps, )?the damping (?:torque )?"
    r"(?:that acts (?:in the steps )?is .* was requested|is missing|is limited to|is scaled by"
    r"|is divided by|is multiplied by|has the wrong sign|counts twice|acts as a rate|goes with"
    r"|(?:acts )?about [xyz] )"
)
NUMBER = r"[-+.\de]+"
LIMITED = re.compile(
    r"(?:in the steps, )?(?P<what>.+?) is (?P<way>limited to|held above) "
    rf"(?P<limit>{NUMBER}) (?P<unit>.+)"
)
ABOVE = re.compile(
    rf"(?P<what>.+?) is (?P<way>above|below) a limit between (?P<low>{NUMBER}) and "
    rf"(?P<high>{NUMBER}) (?P<unit>.+)"
)
SIDE = {"limited to": "above", "held above": "below"}


def only_where(text: str, condition: str) -> str:
    """``, but only where the body is pivoted``; "" where the cause implies this condition."""
    return "" if is_implied(text, condition) else f", but only where {condition}"


def is_implied(text: str, condition: str) -> bool:
    """Whether a cause can act on this condition alone by what it is.

    A wrong share of the damping acts on a damped body; a limit acts on what is beyond it.
    """
    if condition == DAMPED and OF_DAMPING.match(text):
        return True
    cause, beyond = LIMITED.fullmatch(text), ABOVE.fullmatch(condition)
    return (
        cause is not None
        and beyond is not None
        and (beyond["what"], beyond["unit"]) == (cause["what"], cause["unit"])
        and beyond["way"] == SIDE[cause["way"]]
        and float(beyond["low"]) <= float(cause["limit"]) <= float(beyond["high"])
    )
