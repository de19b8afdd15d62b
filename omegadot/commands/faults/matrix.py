"""The detection matrix: every fault over an engine, by gate and by published check."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np

from omegadot.adapters.protocol import Adapter
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.faults.catalogue import ORDERED
from omegadot.commands.faults.detect import GATES, Judgement, Nameless, chosen_integrators, judge
from omegadot.commands.faults.fault import Fault
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.commands.faults.published import Published
from omegadot.commands.faults.published_checks import PUBLISHED
from omegadot.diagnosis.diagnose import diagnose

OF_ENGINE = frozenset({"order-4"})  # needs that are an engine's, not a scenario's
SOUND = 2  # times as many bodies as for a fault: an accusation is the worse mistake


@dataclass(frozen=True)
class Detection:
    """One fault over one engine. All but `judged` and `broken` are shares of the bodies judged.

    judged: bodies that have what the fault needs.  broken: those that the engine refused, or
    failed to answer for, which is no detection.  gates: failed.  any: at least one of them failed.
    named: the diagnosis named the cause.  no_scheme: failed where the integrators declare their
    orders and no scheme.  published: by check, None where its scenarios or its
    integrator do not have what the fault needs.
    """

    fault: Fault
    judged: int
    broken: int
    gates: dict[str, float]
    any: float
    named: float
    no_scheme: float
    published: dict[str, float | None]


@dataclass(frozen=True)
class EngineMatrix:
    """One engine's. accused: bodies of `sound` on which it failed a gate without any fault;
    accused_nameless: the same without a declared scheme.

    skipped: faults that need an integrator that it does not have.
    """

    engine: str
    version: str
    integrators: tuple[str, ...]
    sound: int
    accused: int
    accused_nameless: int
    skipped: tuple[str, ...]
    published_accuse: tuple[str, ...]
    rows: tuple[Detection, ...]

    @property
    def missed(self) -> list[str]:
        """The faults that no gate catches on some body."""
        return [row.fault.name for row in self.rows if row.judged and row.any < 1.0]


def engine_matrix(engine: str, pool: Pool, bodies: int) -> EngineMatrix:
    """Every fault over one built-in engine. Raises ImportError where it is not installed."""
    sound = build_adapter(BUILT_IN[engine])
    chosen = chosen_integrators(sound)
    has = OF_ENGINE if any(i.orders["attitude"] == 4 for i in chosen) else frozenset()
    cases = [pool.prepare(number) for number in range(SOUND * bodies)]
    nameless = Nameless(sound)
    suited = [one for one in ORDERED if one.needs & OF_ENGINE <= has]
    return EngineMatrix(
        engine=engine,
        version=sound.description.version,
        integrators=tuple(integrator.name for integrator in chosen),
        sound=len(cases),
        accused=sum(judge(pool, case, engine, sound).accused for case in cases),
        accused_nameless=sum(judge(pool, case, engine, nameless).accused for case in cases),
        skipped=tuple(one.name for one in ORDERED if one not in suited),
        published_accuse=tuple(
            check.name for check in PUBLISHED if _published(check, engine, None, pool.seed, bodies)
        ),
        rows=tuple(detection(one, engine, pool, bodies) for one in suited),
    )


def detection(fault: Fault, engine: str, pool: Pool, bodies: int) -> Detection:
    """One fault over one engine, on the first bodies that have what it needs."""
    adapter, bare = (fault.wrap(build_adapter(BUILT_IN[engine])) for _ in range(2))
    numbers = pool.having(fault.needs - OF_ENGINE, bodies)
    judged = _judged(pool, numbers, engine, adapter)
    nameless = _judged(pool, numbers, engine, Nameless(bare))
    return Detection(
        fault=fault,
        judged=len(judged),
        broken=len(numbers) - len(judged),
        gates={gate: _share(gate in one.failed for one in judged.values()) for gate in GATES},
        any=_share(bool(one.failed) for one in judged.values()),
        named=_share(_named(fault, pool.prepare(n), one) for n, one in judged.items()),
        no_scheme=_share(bool(one.failed) for one in nameless.values()),
        published={
            check.name: _published(check, engine, fault, pool.seed, bodies) for check in PUBLISHED
        },
    )


def _judged(pool: Pool, numbers: list[int], engine: str, adapter: Adapter) -> dict[int, Judgement]:
    """By the number of a case, those that the engine answers for.

    The engine has been loaded with another body before, as in any run of several scenarios.
    """
    adapter.load(pool.prepare(numbers[-1] + 1).case.system)
    found = {n: judge(pool, pool.prepare(n), engine, adapter) for n in numbers}
    return {n: one for n, one in found.items() if not one.broken}


def _share(caught: Iterable[bool]) -> float:
    every = list(caught)
    return sum(every) / max(1, len(every))


def _named(fault: Fault, prepared: Prepared, judgement: Judgement) -> bool:
    known = (prepared.case, prepared.truth, prepared.evaluation_states)
    with np.errstate(all="ignore"):
        return fault.is_named(diagnose(*known, judgement.result, judgement.runs))


@cache
def _published(
    check: Published, engine: str, fault: Fault | None, seed: int, poses: int
) -> float | None:
    """The share of attitudes from which a check's bounds are broken, by a fault or without one.

    None where the check does not apply, or where the sound engine breaks its bounds already: the
    check then detects no fault in it.
    """
    sound = build_adapter(BUILT_IN[engine])
    integrator = check.integrator_of(sound)
    if integrator is None or (fault and not fault.needs <= check.has):
        return None
    if fault and _published(check, engine, None, seed, poses):
        return None
    adapter = fault.wrap(sound) if fault else sound
    draws = (np.random.default_rng([seed, pose]) for pose in range(poses))
    with np.errstate(all="ignore"):
        return _share(check.caught(adapter, integrator, random) for random in draws)
