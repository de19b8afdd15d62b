"""Where no cause fits: what is known of the difference, in one sentence over all that show it."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np

from omegadot.diagnosis.equations.dependence import (
    changes_with_attitude,
    dependence_text,
    powers_of,
    powers_over,
)
from omegadot.diagnosis.equations.describe import Off, off_of, off_over, off_text
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.wording.features import Features, in_common, ways_of
from omegadot.gates.bounds.scales import norm
from omegadot.harness.requests.scaled import ATTITUDE

ANGULAR, LINEAR = KINDS = ("omega-dot", "the linear acceleration")
ATTRIBUTES = {ANGULAR: "angular", LINEAR: "linear"}
OF_THE_STATE = ("|omega|", "the linear velocity", "the position")


def known_over(
    scenes: Sequence[Scene],
    passing: Sequence[Features],
    source: str,
    along: str,
    kinds: Sequence[str] = KINDS,
) -> str:
    """Of the scenarios on which nothing fits; a fact that one of them contradicts is left out.

    passing: of the scenarios that are right.  along: a vector that all of it is along; "" if none.
    kinds: of what is off, those to be stated.
    """
    seen = {kind: _seen(scenes, source, kind) for kind in kinds}
    seen = {kind: parts for kind, parts in seen.items() if parts}
    texts = list[str]()
    for kind, parts in seen.items():
        off = off_over([one for _, _, one in parts])
        assert off is not None
        texts.append(off_text(kind, off, along if kind == ANGULAR else ""))
    for kind, parts in seen.items() if source == "forward" else ():
        off = off_over([one for _, _, one in parts])
        it = "it" if len(seen) == 1 else f"what {kind} is off by"
        texts.append(_goes([(s, e) for s, e, _ in parts], off, ATTRIBUTES[kind], it))
    if texts:  # else something else fails
        features = [s.features for s in scenes]
        texts.append(scenarios_in_common(features, passing, "it is so", _opposites(scenes, source)))
    return "; ".join(text for text in texts if text)


def kinds_off(scene: Scene, source: str) -> tuple[str, ...]:
    """What is off on one scenario; of a pivoted body the linear acceleration follows omega-dot."""
    found = scene.evidence[source]
    shares = {
        ANGULAR: (norm(found.found.angular - found.true.angular), found.angular_bound),
        LINEAR: (norm(found.found.linear - found.true.linear), found.linear_bound),
    }
    off = tuple(kind for kind, (apart, bound) in shares.items() if not np.all(apart <= bound))
    return off[:1] if scene.system.load.pivot is not None else off


def _seen(scenes: Sequence[Scene], source: str, kind: str) -> list[tuple[Scene, Evidence, Off]]:
    """The scenarios on which enough is seen of a kind."""
    parts = [(s, s.evidence[source]) for s in scenes if kind in kinds_off(s, source)]
    return [(s, e, off) for s, e in parts if (off := off_of(e, ATTRIBUTES[kind])) is not None]


def _goes(parts: Sequence[tuple[Scene, Evidence]], off: Off | None, kind: str, it: str) -> str:
    """On what it depends. What changes with the state may still change with the attitude alone."""
    powers = powers_over([powers_of(e, s.scaled, kind) for s, e in parts if s.scaled])
    free = any(e.system.load.pivot is None for _, e in parts)
    moves = OF_THE_STATE if free else OF_THE_STATE[:1]  # a pivoted body's place is its attitude's
    still = all(powers.get(what, (1.0, 0))[0] == 0.0 for what in moves)
    turned = [changes_with_attitude(e, s.scaled, kind) for s, e in parts]
    alone = off is not None and off.turns and still and ATTITUDE not in powers
    rest = {k: v for k, v in powers.items() if not (alone and k in OF_THE_STATE)}
    texts = [f"nothing else of the state than the attitude is seen to change {it}"] * alone
    some = "" if all(turned) else f" on {sum(turned)} of the {len(turned)} scenarios that show it"
    texts += [f"{it} changes with the attitude{some}"] * (any(turned) and not alone)
    return "; ".join(text for text in (*texts, dependence_text(rest, it)) if text)


def scenarios_in_common(
    failing: Sequence[Features],
    passing: Sequence[Features],
    it: str = "it fails",
    tried: Sequence[tuple[Features, bool]] = (),
) -> str:
    """What the scenarios that fail have in common and the others lack.

    tried: further systems, each with whether it fails.
    """
    if comb(len(failing) + len(passing), len(failing)) < ways_of(failing):
        return ""  # so few are sorted by chance
    common = in_common(failing, passing, tried)
    if not common or len(common) > 2:
        return ""
    return f"{it} in scenarios alone where {' or where '.join(common)}"


def _opposites(scenes: Sequence[Scene], source: str) -> list[tuple[Features, bool]]:
    """Systems in which one thing is the other way than in those that fail, and whether they do."""
    every = [
        (features, one) for scene in scenes for features, one in scene.opposites.get(source, ())
    ]
    every = [(f, one) for f, one in every if one.finite]
    return [(f, one.clear) for f, one in every if one.clear or np.all(one.sound)]
