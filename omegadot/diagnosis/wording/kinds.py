"""Causes of one kind: the same sentence but for its numbers."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence

NUMBER = re.compile(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?")
# These state what is seen of one run, and no more; another run may show something else.
FACTS = (
    "not finite",
    "is sound until",
    "alone is wrong in the run",
    "does not belong to the run",
    "reported twice",
    "only the first steps are wrong",
    "the last of the run, are wrong",
    "of the last sample alone is wrong",
    "are wrong only where",
    "the run is the same for a while and another after",
    "samples came back",
    "every time",
    "times are",
    "time alone is off",
    "one time, that of",
    "the run is wrong once",
    "does not move in the run",
    "is stepped in full",
)
SEEN = ("none is known", "the error of one step goes as")
OF_ONE_RUN = (
    *("the last step is missing", "left over", "one before", "does not begin at", "its sign"),
    "the last one first",
    "the same at every sample of a run",
)
AT_STEPS = ", at steps of"
EITHER, OR = "either ", ", or "
# One number in every run, or it is another cause.
CONSTANTS = (
    *("low-pass", "it is filtered", "every time is too", "every time is scaled by"),
    *("the clock is rounded to", "the clock is cut off to"),
)
SAME = 0.01  # relative, of such a number; it has three digits
MOST_NAMED = 3  # between which nothing decides
SHARE = 0.5  # of the runs that were looked at, at least, a cause must explain


def kind_of(text: str) -> str:
    """A cause without its numbers, and without where it shows."""
    for end in (", but only where", ", not on", AT_STEPS, ", on "):
        text = text.partition(end)[0]
    if any(one in text for one in CONSTANTS):
        return text
    same = text.replace("too short", "too long").partition(": rounded to")[0]
    return NUMBER.sub("#", same)


def is_fact(text: str) -> bool:
    """Whether it states what is seen in a run, not what makes it."""
    return any(fact in text for fact in FACTS)


def is_named(text: str) -> bool:
    """Whether a cause is named, and not only what is seen."""
    return bool(text) and not is_fact(text) and not any(one in text for one in SEEN)


def is_general(text: str) -> bool:
    """Whether it says that something is left over, and not what."""
    before, _, after = text.rpartition("left over")
    return "something" in before and ": " not in after


def is_of_one_run(text: str) -> bool:
    """Whether it holds of a run that is another when it is requested again."""
    first = text.startswith("only the first steps are wrong")  # as where a run before left them
    return (is_fact(text) and not first) or any(one in text for one in OF_ONE_RUN)


def agreed(here: Sequence[str], over_cases: Mapping[str, tuple[Sequence[str], bool]]) -> list[str]:
    """Which of one scenario's causes explain the failed runs on the most scenarios, half at least.

    over_cases: by scenario the causes of which each alone explains its runs, none where it was
    looked at in vain, and whether its motion decides between causes. Where no motion does, none is
    named but a fact.
    """
    facts = [text for text in here if is_fact(text)]
    causes = [text for text in here if not is_fact(text)]
    every = [texts for texts, _ in over_cases.values()]
    same = [text for text in facts if _is_constant(text) and _is_of_all(text, every)]
    facts = same or [text for text in facts if not _is_constant(text)]
    return (_most_agreed(causes, over_cases) if causes else []) or facts


def _is_constant(text: str) -> bool:
    return any(one in text for one in CONSTANTS)


def _is_of_all(text: str, every: Sequence[Sequence[str]]) -> bool:
    """Whether a constant is the same on every scenario that fails: clocks are looked at first."""
    own = float(NUMBER.findall(text)[-1])
    start = text.partition(",")[0]
    others = [
        [float(NUMBER.findall(one)[-1]) for one in texts if one.startswith(start)]
        for texts in every
    ]
    return all(any(abs(n - own) <= SAME * abs(own) for n in numbers) for numbers in others)


def _most_agreed(
    here: Sequence[str], over_cases: Mapping[str, tuple[Sequence[str], bool]]
) -> list[str]:
    kinds, deciding, count = Counter[str](), set[str](), 0
    for texts, decisive in over_cases.values():
        known = {kind_of(text) for text in texts if not is_fact(text)}
        kinds.update(known)
        deciding |= known if decisive else set()
        count += bool(known) or not texts
    most = max((kinds[kind_of(text)] for text in here), default=0)
    if most < SHARE * count:
        return []
    best = [text for text in here if kinds[kind_of(text)] == most and kind_of(text) in deciding]
    # of several slips in one scheme the first states the least
    plain = list({text.partition(", but ")[0]: text for text in reversed(best)}.values())[::-1]
    return plain if len(plain) <= MOST_NAMED else []


def over_run(text: str, by_scenario: Mapping[str, Sequence[str]]) -> str:
    """A cause with the numbers of the first scenario that shows its kind, where they are others.

    One mistake has one sentence.
    """
    kind = kind_of(text)
    alike = {n: t for n, texts in by_scenario.items() for t in texts if kind_of(t) == kind}
    if len(set(alike.values())) < 2:
        return text
    plain = {one.partition(AT_STEPS)[0] for one in alike.values()}
    if len(plain) == 1:  # at some steps it is hidden on some scenarios
        return plain.pop()
    first, shown = next(iter(alike.items()))
    others = sum(one != shown for one in alike.values())
    return f"{shown} ({first}; other numbers on {others} more)"


def either(texts: Sequence[str]) -> list[str]:
    """One sentence of causes that explain the same; none without any."""
    known = [text for text in dict.fromkeys(texts) if text]
    return [EITHER + OR.join(known)] if len(known) > 1 else known
