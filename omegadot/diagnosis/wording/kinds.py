"""Causes of one kind: the same sentence but for its numbers."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping

NUMBER = re.compile(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?")
# These state what is seen of one run, and no more; another run may show something else.
FACTS = (
    "not finite",
    "is sound until",
    "alone is wrong in the run",
    "does not belong to the run",
    "reported twice",
    "only the first steps are wrong",
    "are wrong only where",
    "the steps depend on how many went before",
    "samples came back",
    "time",
)
SHARE = 0.5  # of the runs that were looked at, at least, a cause must explain


def kind_of(text: str) -> str:
    """A cause without its numbers, and without where it shows."""
    for end in (", but only where", ", at steps of", ", on "):
        text = text.partition(end)[0]
    return NUMBER.sub("#", text)


def is_fact(text: str) -> bool:
    """Whether it states what is seen in a run, not what makes it."""
    return any(fact in text for fact in FACTS)


def is_of_one_run(text: str) -> bool:
    """Whether it holds of a run that is another when it is requested again."""
    kept = ("the last step is missing", "left over", "one before", "does not begin at")
    return is_fact(text) or any(one in text for one in kept)


def agreed(text: str, over_cases: Mapping[str, str]) -> bool:
    """Whether a cause explains the failed runs of an integrator on most of the scenarios.

    over_cases: by scenario what was found there; "" where the run was looked at in vain.
    """
    if is_fact(text) or len(over_cases) < 2:
        return True
    kinds = Counter(kind_of(one) for one in over_cases.values() if not is_fact(one))
    return kinds[kind_of(text)] >= SHARE * sum(kinds.values())
