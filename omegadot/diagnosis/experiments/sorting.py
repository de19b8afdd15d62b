"""The condition that sorts all observations: the plainest, where exactly one does."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from omegadot.diagnosis.experiments.observed import Flags, Observations
from omegadot.diagnosis.experiments.traits import Traits
from omegadot.diagnosis.wording.digits import limits
from omegadot.diagnosis.wording.features import plainest, worded
from omegadot.diagnosis.wording.inertia_features import ABOUT
from omegadot.reference_impl.system import Array

NARROW = 0.3  # a limit that is known no better than by this part has not been looked for
LEAST = 2  # states on either side


@dataclass(frozen=True)
class Limit:
    """A size with a limit between two numbers: the fault shows above it, or below."""

    text: str
    unit: str
    above: bool
    low: float
    high: float

    @property
    def narrow(self) -> bool:
        """Whether the limit is known to some digits."""
        size = max(abs(self.low), abs(self.high))
        return self.high - self.low <= NARROW * size

    def __str__(self) -> str:
        """As a condition."""
        term = "above" if self.above else "below"
        return f"{self.text} is {term} a limit between {limits(self.low, self.high, self.unit)}"


def kind_that_sorts(seen: Observations) -> str:
    """The one sentence, or pair of plain ones, that holds where the fault shows and nowhere else.

    Each has to have made the fault appear or vanish when nothing else was changed. "" where none
    does, or several do that are not one condition.
    """
    wrong = seen.wrong
    if min(np.count_nonzero(wrong), np.count_nonzero(~wrong)) < LEAST:
        return ""
    for tier in ("plain", "particular"):
        found = [one for one in _columns(seen, tier) if _sorts(one[1], wrong)]
        if found:
            texts = [
                worded(text, bool(column[wrong & ~np.isnan(column)][0])) for text, column in found
            ]
            texts = plainest(_about_either(_signed(texts)))
            decided = [t for t, _ in found if seen.decided_by_one_change(_of(tier, t))]
            return texts[0] if len(texts) == 1 and decided else ""
    return ""


def pair_that_sorts(seen: Observations) -> str:
    """Two plain sentences that hold together where the fault shows, or of which one does."""
    wrong, columns = seen.wrong, [*_columns(seen, "plain")]
    signed = [
        (worded(t, h), t, (c == 1.0) == h, ~np.isnan(c)) for t, c in columns for h in (True, False)
    ]
    found = dict[str, tuple[str, str]]()
    for joint, sides in ((" and ", wrong), (" or ", ~wrong)):
        # each of the two holds wherever both do, and of either kind fails where neither does
        kept = [
            one for one in signed if np.all(one[2][sides] == (joint == " and ")) and np.all(one[3])
        ]
        for a, b in combinations(kept, 2):
            both = a[2] & b[2] if joint == " and " else a[2] | b[2]
            if a[1] != b[1] and np.array_equal(both, wrong):
                found[f"{a[0]}{joint}{b[0]}"] = (a[1], b[1])
    if len(found) != 1:
        return ""
    ((text, two),) = found.items()
    decided = all(seen.decided_by_one_change(_of("plain", one)) for one in two)
    return text if decided else ""


def limits_that_sort(seen: Observations) -> list[Limit]:
    """Sizes with a limit between the states that show the fault and the others."""
    wrong, found = seen.wrong, list[Limit]()
    if min(np.count_nonzero(wrong), np.count_nonzero(~wrong)) < LEAST:
        return found
    for text, (_, unit) in seen.trials[0].traits.sizes.items():
        values = seen.column(lambda one, text=text: one.sizes[text][0])  # type: ignore[misc]
        here, there = values[wrong], values[~wrong]
        here, there = here[~np.isnan(here)], there[~np.isnan(there)]
        if min(len(here), len(there)) < LEAST or not np.all(np.isfinite(values[~np.isnan(values)])):
            continue
        if np.max(there) < np.min(here):
            found.append(Limit(text, unit, True, float(np.max(there)), float(np.min(here))))
        elif np.max(here) < np.min(there):
            found.append(Limit(text, unit, False, float(np.max(here)), float(np.min(there))))
    return found


def contradicted(seen: Observations, text: str) -> bool:
    """Whether an observation is against one of the sentences known, as it is worded."""
    for tier in ("plain", "particular"):
        for own, column in _columns(seen, tier):
            for holds in (True, False):
                if worded(own, holds) == text:
                    said = ~np.isnan(column)
                    return not np.array_equal((column[said] == 1.0) == holds, seen.wrong[said])
    return False


def _of(tier: str, text: str) -> Callable[[Traits], Array]:
    return lambda traits: np.asarray(getattr(traits, tier)[text])


def _columns(seen: Observations, tier: str) -> Iterator[tuple[str, Array]]:
    for text in getattr(seen.trials[0].traits, tier) if seen.trials else ():
        yield text, seen.column(_of(tier, text))


def _sorts(column: Array, wrong: Flags) -> bool:
    """Whether it holds where the fault shows, and nowhere else; or the other way about."""
    said = ~np.isnan(column)
    here, there = column[said & wrong], column[said & ~wrong]
    sides = ((len(here), np.count_nonzero(wrong)), (len(there), np.count_nonzero(~wrong)))
    if any(own < LEAST or 2 * own < every for own, every in sides):
        return False
    return bool(np.all(here == here[0]) and np.all(there == 1.0 - here[0]))


def _signed(texts: list[str]) -> list[str]:
    """Where no component is zero, what is negative is not positive."""
    other = {"is not positive": "is negative", "is not negative": "is positive"}
    also = {t: t.replace(no, yes) for t in texts for no, yes in other.items() if no in t}
    return [t for t in texts if also.get(t) not in texts]


def _about_either(texts: list[str]) -> list[str]:
    """What holds about either point is said of none."""
    about, centre = ABOUT
    both = {t for t in texts if about in t and t.replace(about, centre) in texts}
    drop = {t.replace(about, centre) for t in both}
    return [t.replace(about, "") if t in both else t for t in texts if t not in drop]
