"""The detection matrix: every fault over an engine, and whom sound engines make `check` accuse."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from omegadot.adapters.protocol import Adapter
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.faults.catalogue import ORDERED
from omegadot.commands.faults.detect import Nameless, chosen_integrators, judge
from omegadot.commands.faults.detection import Detection, detection, share_caught
from omegadot.commands.faults.prepared import Pool
from omegadot.commands.faults.published_checks import PUBLISHED

OF_ENGINE = frozenset({"order-4"})  # needs that are an engine's, not a scenario's
SOUND = 4  # times as many systems as for a fault: an accusation is the worse mistake


@dataclass(frozen=True)
class EngineMatrix:
    """One engine's. accused: random systems of `sound`, and built-in scenarios, on which it failed
    a gate without any fault; accused_nameless: the same without a declared scheme.

    skipped: faults that need an integrator that it does not have.  minutes: of processor time.
    """

    engine: str
    version: str
    integrators: tuple[str, ...]
    sound: int
    accused: tuple[str, ...]
    accused_nameless: tuple[str, ...]
    skipped: tuple[str, ...]
    published_accuse: tuple[str, ...]
    rows: tuple[Detection, ...]
    minutes: float

    @property
    def missed(self) -> list[str]:
        """The faults that are caught on no built-in scenario and on no random system."""
        return [row.fault.name for row in self.rows if not row.caught]


def engine_matrix(
    engine: str, pool: Pool, count: int, published: bool, advance: Callable[[], object]
) -> EngineMatrix:
    """Every fault over one built-in engine. Raises ImportError where it is not installed.

    count: random systems for each fault.  published: whether to try the published checks.
    """
    began = time.process_time()
    sound = build_adapter(BUILT_IN[engine])
    chosen = chosen_integrators(sound)
    has = OF_ENGINE if any(i.orders["attitude"] == 4 for i in chosen) else frozenset()
    suited = [one for one in ORDERED if one.needs & OF_ENGINE <= has]
    cases = [*pool.built_in(), *pool.first(SOUND * count)]
    accused = [[c for c in cases if judge(pool, c, engine, how).accused] for how in _ways(sound)]
    rows = []
    for one in suited:
        rows.append(detection(one, engine, pool, count, published))
        advance()
    checks = PUBLISHED if published else ()
    return EngineMatrix(
        engine=engine,
        version=sound.description.version,
        integrators=tuple(integrator.name for integrator in chosen),
        sound=len(cases),
        accused=tuple(one.case.name for one in accused[0]),
        accused_nameless=tuple(one.case.name for one in accused[1]),
        skipped=tuple(one.name for one in ORDERED if one not in suited),
        published_accuse=tuple(c.name for c in checks if share_caught(c, engine, None, pool.seed)),
        rows=tuple(rows),
        minutes=(time.process_time() - began) / 60.0,
    )


def _ways(sound: Adapter) -> tuple[Adapter, Adapter]:
    return sound, Nameless(sound)
