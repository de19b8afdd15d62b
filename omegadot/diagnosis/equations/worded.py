"""Causes as text: those that hold everywhere, and those that hold on the scenarios of one kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.equation_form import same_form
from omegadot.diagnosis.equations.held import Held, Scenes
from omegadot.diagnosis.equations.same_cause import same_cause
from omegadot.diagnosis.wording.implied import only_where
from omegadot.diagnosis.wording.no_lever import no_lever

MOST_NAMED = 3  # causes between which a scenario does not decide


@dataclass(frozen=True)
class Named:
    """The cause on one scenario as text; "" where there is none.

    candidate: the first of those that it names.  names: the scenarios that this explains.
    """

    text: str = ""
    candidate: Candidate | None = None
    names: frozenset[str] = frozenset()


def named(whole: Sequence[Held], source: str, scenes: Scenes) -> Named:
    """Causes that hold everywhere, with the first of them."""
    text = worded(whole, source, scenes)
    return Named(text, whole[0].candidate, frozenset(whole[0].names)) if text else Named()


def worded(whole: Sequence[Held], source: str, scenes: Scenes) -> str:
    """Causes that hold everywhere; several where no scenario decides between them.

    scenes: those of the run, or some of them.
    """
    kept, held = list[Held](), (scenes.pivoted, _only_omega_dot(whole, source))
    for one in whole:
        if not any(same_cause(one.candidate, other.candidate, *held) for other in kept):
            kept.append(one)
    if len(kept) > MOST_NAMED:  # the plainest of those that are one equation in this run
        kept = [one for k, one in enumerate(kept) if not _like_any(one, kept[:k])]
    texts = list(dict.fromkeys(one.law or _text_of(one, source) for one in kept))
    if not texts or len(texts) > MOST_NAMED:
        return ""
    return texts[0] if len(texts) == 1 else "either " + ", or ".join(texts)


def _only_omega_dot(whole: Sequence[Held], source: str) -> bool:
    """Whether of all pivoted bodies omega-dot alone is wrong: what moves them decides nothing."""
    shown = {scene.name: scene.evidence[source] for one in whole for scene in one.shown}
    held = [e for e in shown.values() if e.system.load.pivot is not None]
    return bool(held) and all(e.linear_is_apart for e in held)


def _text_of(held: Held, source: str) -> str:
    """One cause; where its numbers are others on each scenario, those of the first."""
    one = held.candidate
    text = one.text(held.shown[0].evidence[source].system, alone=len(held.shown) == 1)
    if one.family is not None and one.numbers is not None and not one.fixed:
        pairs = [(held.shown[0].system, one.numbers), *((s.system, p) for s, p in held.numbers)]
        alike = one.family.alike(pairs)
        text += f"; {alike}" * bool(alike)
    text += held.where(text)
    if not held.numbers or one.numbers is None:
        return text
    return f"{text} ({held.shown[0].name}; other numbers on {len(held.numbers)} more)"


def _like_any(one: Held, others: Sequence[Held]) -> bool:
    """Whether it is the same equation as another on every scenario that shows it."""
    plain = one.candidate.reading is None and one.candidate.terms is None

    def like(other: Held) -> bool:
        if not plain or other.candidate.reading or other.candidate.terms:
            return False
        pairs = [[x.candidate.form(s.system) for x in (one, other)] for s in one.shown]
        return all(a is not None and b is not None and same_form(a, b) for a, b in pairs)

    return any(map(like, others))


def conditional(held: Sequence[Held], own: bool = False) -> str:
    """The first cause that holds on the scenarios of one kind alone; see `on_some`."""
    return on_some(held, own).text


def on_some(held: Sequence[Held], own: bool = False) -> Named:
    """The first cause that holds on the scenarios of one kind alone.

    own: also one that does so by other numbers on each.
    """
    for one in held:
        if one.numbers and not one.law and not own:
            continue
        numbers = one.candidate.numbers
        if numbers is not None and len(numbers) > 1 and len(one.shown) < 2:
            continue  # many numbers fit one scenario
        condition = one.condition()
        if condition:
            evidence = next(iter(one.shown[0].evidence.values()))
            text = one.law or one.candidate.text(evidence.system, alone=len(one.shown) == 1)
            text = no_lever(text, condition)
            text += only_where(text, condition)
            if one.numbers and not one.law:
                text = f"{text} ({one.shown[0].name}; other numbers on {len(one.numbers)} more)"
            return Named(text, one.candidate, frozenset(one.names))
    return Named()


def on_these_alone(held: Sequence[Held], wrong: set[str]) -> Named:
    """What explains all that is wrong, where it would show elsewhere as well, and does not.

    It is said on how many scenarios; several where no scenario decides between them.
    """
    known = [one for one in held if one.against and not one.numbers and wrong <= one.names]
    # many numbers fit one scenario
    known = [one for one in known if _count(one) < 2 or len(one.shown) > 1]
    best = [one for one in known if _count(one) == min(map(_count, known))]
    texts = dict.fromkeys(_on_these(one) for one in best)
    if not 1 <= len(texts) <= MOST_NAMED:
        return Named()
    text = next(iter(texts)) if len(texts) == 1 else "either " + ", or ".join(texts)
    return Named(text, best[0].candidate, frozenset(best[0].names))


def _count(one: Held) -> int:
    return 0 if one.candidate.numbers is None else len(one.candidate.numbers)


def _on_these(one: Held) -> str:
    shown, against = len(one.shown), len(one.against)
    text = one.candidate.text(one.shown[0].evidence[one.source].system, alone=shown == 1)
    here = f", on {shown} scenario{'s' * (shown > 1)}"
    return f"{text}{here}, not on {against} other{'s' * (against > 1)} that would show it"
