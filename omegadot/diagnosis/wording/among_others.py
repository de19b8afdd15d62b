"""What is named on one scenario, beside what is named on the others that fail.

One mistake has one cause. Where the motion shows little, another cause may fit a scenario by
accident; it fits few of the others.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from omegadot.diagnosis.experiments.conditioned import UNKNOWN
from omegadot.diagnosis.wording.kinds import EITHER, OR, SHARE, is_general, is_named, kind_of

SCOPE = re.compile(
    r"^(?:in (?:the steps|the dynamics|inverse dynamics|the run)(?: and in inverse dynamics)?, "
    r"|a run begins at another attitude: )+"
)
ENDS = re.compile(
    r", but not always| \(\S+; other numbers on \d+ more\)|, in forward dynamics alone"
    r"|, and is sound from there|, as a state is set or read back"
)


def of_few(text: str, others: Sequence[str]) -> str:
    """A cause that less than half of the failing scenarios show: as what is seen there alone.

    others: the texts of the other scenarios that fail, in runs of the same integrator. That
    something is left over contradicts nothing that says what.
    """
    if is_general(text):
        return text
    own, others = _kinds(text), [one for one in others if not is_general(one)]
    count = 1 + sum(is_named(other) and not own.isdisjoint(_kinds(other)) for other in others)
    every = 1 + len(others)
    if not is_named(text) or count >= SHARE * every:
        return text
    seen = text.replace("; ", ", ")
    return f"{UNKNOWN}; on {count} of the {every} scenarios that fail it is as if {seen}"


def beside_others(text: str, others: Sequence[str]) -> str:
    """What is seen on a scenario on which no cause is named, after the cause of most others.

    others: the texts of the other scenarios that fail.
    """
    kinds = Counter(kind_of(other) for other in others if is_named(other))
    kind, count = kinds.most_common(1)[0] if kinds else ("", 0)
    if 2 * count <= len(others):
        return text
    shown = next(other for other in others if is_named(other) and kind_of(other) == kind)
    where = f"on {count} other scenario{'s' * (count > 1)}: {shown}"
    return f"{where}; here: {text}" if text else where


def _kinds(text: str) -> frozenset[str]:
    """The kinds of the causes between which a text does not decide, wherever they act."""
    texts = text.removeprefix(EITHER).split(OR) if text.startswith(EITHER) else [text]
    return frozenset(kind_of(ENDS.sub("", SCOPE.sub("", one))) for one in texts)
