"""What fits single scenarios, level by level, each candidate held against all others of the run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.held import Held, Scene, Scenes
from omegadot.diagnosis.equations.search import levels
from omegadot.diagnosis.equations.worded import conditional

PLAIN = 2  # levels of one scenario without limits: they fit all states, or those that are wrong
QUICK = 5  # levels that are quick, and more basic than what another scenario has shown
MOST_DEEP = 5  # scenarios that are searched to the end; the rest have what these have


@dataclass(frozen=True)
class Level:
    """What holds on every scenario; what does by other numbers on each; what holds on some."""

    strong: Sequence[Held] = ()
    weak: Sequence[Held] = ()
    partial: Sequence[Held] = ()


NONE = Level()


class _Levels:
    """Levels that are worked out when they are first needed, and kept."""

    def __init__(self, source: Iterator[list[Candidate]]) -> None:
        self._source, self._known = source, list[list[Candidate]]()

    def __iter__(self) -> Iterator[list[Candidate]]:
        """All of them, from the first."""
        yield from self._known
        for level in self._source:
            self._known.append(level)
            yield level


class Searched:
    """What has been searched of the scenarios of one engine so far."""

    def __init__(self, scenes: Scenes) -> None:
        self._scenes = scenes
        self._levels: dict[tuple[str, str], _Levels] = {}
        self._quick: dict[tuple[str, str, int], Level] = {}

    def add(self, scene: Scene) -> None:
        """One more scenario: what fits the others still does, and may not hold any more."""
        self._scenes.by_name[scene.name] = scene
        self._quick = {}

    @property
    def to_the_end(self) -> list[tuple[str, str]]:
        """The scenarios that are searched to the end, each with a source of evidence."""
        return list(self._levels)[:MOST_DEEP]

    def quick(self, scene: Scene, source: str, depth: int) -> Level:
        """The first of the quick levels of a scenario on which something holds everywhere."""
        key = (scene.name, source, depth)
        if key not in self._quick:
            before = self.quick(scene, source, PLAIN) if depth > PLAIN else NONE
            weak, partial, strong = before.weak, [*before.partial], before.strong
            for level in islice(self._of(scene, source), PLAIN * (depth > PLAIN), depth):
                if strong or conditional(partial):
                    break
                found = self.held_of(level, scene, source)
                weak, partial, strong = weak or found.weak, [*partial, *found.partial], found.strong
            self._quick[key] = Level(strong, weak, partial)
        return self._quick[key]

    def best(self, scene: Scene, source: str, depth: int) -> list[Held]:
        """Of what holds everywhere and explains this scenario, what explains the most."""
        wrong = [s for s in self._scenes.by_name.values() if source in s.evidence]
        wrong = [s for s in wrong if s.evidence[source].clear]
        found = [one for s in wrong for one in self.quick(s, source, depth).strong]
        here = [one for one in found if scene.name in one.names]
        most = max((len(one.shown) for one in here), default=0)
        return list({o.candidate.key: o for o in here[::-1] if len(o.shown) == most}.values())[::-1]

    def deep(self, scene: Scene, source: str) -> Iterator[Level]:
        """The levels after the quick ones."""
        for level in islice(self._of(scene, source), QUICK, None):
            yield self.held_of(level, scene, source)

    def _of(self, scene: Scene, source: str) -> Iterator[list[Candidate]]:
        """The levels of one scenario, each worked out once; the deep ones of a few alone."""
        key = (scene.name, source)
        if key not in self._levels:
            deep = len(self._levels) < MOST_DEEP
            found = levels(scene.evidence[source], deep, self._scenes.tried(scene, source))
            self._levels[key] = _Levels(found)
        return iter(self._levels[key])

    def held_of(self, level: Sequence[Candidate], scene: Scene, source: str) -> Level:
        """What fits one scenario, held against all others."""
        distinct = {one.key: one for one in level}.values()
        held = [self._scenes.held(one, scene, source) for one in distinct]
        whole = [one for one in held if one.holds]
        strong = [one for one in whole if one.strong]
        least = min((len(one.against) for one in strong), default=0)
        if not least or any(len(one.shown) > 1 for one in strong):
            # of one scenario, numbers that act there alone are none likelier than others
            strong = [one for one in strong if len(one.against) == least]
        partial = [one for one in held if not one.contradicted]
        return Level(strong, [] if strong else whole, partial)
