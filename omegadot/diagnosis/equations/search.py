"""Which wrong equations are an engine's on one scenario, those with the fewest numbers first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families import (
    EXTRA,
    LEAST,
    ONE_NUMBER,
    SIX_NUMBERS,
    THREE_NUMBERS,
    Family,
    fit,
)
from omegadot.diagnosis.equations.operators import changed_vectors, solved_apart
from omegadot.diagnosis.equations.other_attitudes import in_loads
from omegadot.diagnosis.equations.readings import READINGS
from omegadot.diagnosis.equations.terms import FEW, MORE, MOST, Terms
from omegadot.diagnosis.equations.tried import Tried, differs

STEPS = "steps"  # evidence of what moves a body, of which nothing is reported by itself


def levels(
    evidence: Evidence, deep: bool = True, tried: Tried | None = None
) -> Iterator[list[Candidate]]:
    """What fits at every state: without numbers, with one, two at once, with three, with six.

    A level is worked out when it is needed. deep: also those that take long.  tried: the hypotheses
    on this evidence, where they are worked out already.
    """
    tried = tried or Tried(evidence)
    single = tried.fitting()
    likely = [one for one in single if not one.fixed[0].unlikely]
    yield likely + _readings(evidence) + _apart(evidence, together=True)
    yield _fitted(evidence, ONE_NUMBER) + _with_terms(evidence, FEW)
    yield _fitted(evidence, LEAST) + _changed(evidence)
    yield _with_terms(evidence, MORE)
    yield _with_terms(evidence, MOST)
    unlikely = [one for one in single if one.fixed[0].unlikely]
    if deep:
        yield unlikely + tried.pairs()
        yield _fitted(evidence, THREE_NUMBERS) if evidence.far else []
        yield _fitted(evidence, EXTRA)
        yield tried.mixed()
        yield _fitted(evidence, SIX_NUMBERS) if evidence.far else []
    else:
        yield unlikely


def _with_terms(evidence: Evidence, kinds: Sequence[Terms]) -> list[Candidate]:
    steps = evidence.source == STEPS
    usable = [one for one in kinds if not (one.reported if steps else one.stepped)]
    found = [(terms, terms.fit(evidence)) for terms in usable]
    return [Candidate(terms=terms, numbers=p) for terms, p in found if p is not None]


def _readings(evidence: Evidence) -> list[Candidate]:
    """Those that fit, and of several that make no difference here the plainest.

    In which loads an attitude is another is decided by scenarios with others of them.
    """
    fits = [one for one in READINGS if evidence.fits(one.accelerations(evidence))]
    change = in_loads(fits[0].text) if fits else ""
    alike = [one for one in fits[1:] if change and in_loads(one.text) == change]
    return [Candidate(reading=one) for one in (*fits[:1], *alike)]


def _fitted(evidence: Evidence, families: Sequence[Family]) -> list[Candidate]:
    found = [(family, fit(evidence, family)) for family in families]
    return [
        Candidate((), family, numbers)
        for family, numbers in found
        if numbers is not None and differs(numbers, family.right(evidence.system))
    ]


def _changed(evidence: Evidence) -> list[Candidate]:
    found = changed_vectors(evidence, steps=evidence.source == STEPS)
    return _apart(evidence) + [Candidate(terms=one, numbers=p) for one, p in found]


def _apart(evidence: Evidence, together: bool = False) -> list[Candidate]:
    """One torque that is solved for by itself; together: all loads, of which one alone is less."""
    return [Candidate(terms=one, numbers=p) for one, p in solved_apart(evidence, together)]
