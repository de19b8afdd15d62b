"""The detection matrix: every fault over an engine, by gate and by published check."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache

import numpy as np

from omegadot.adapters.protocol import Adapter, Integrator
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.faults.catalogue.every import ORDERED
from omegadot.commands.faults.detect import GATES, Judgement, chosen_integrators, judge
from omegadot.commands.faults.fault import Fault
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.commands.faults.published import Published
from omegadot.commands.faults.published_checks import PUBLISHED
from omegadot.commands.faults.undeclared import Nameless, nameless_integrators
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


@contextmanager
def quiet_engines() -> Iterator[None]:
    """What engines print from native code would stand among the results: it is dropped."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def engine_matrix(engine: str, pool: Pool, bodies: int) -> EngineMatrix:
    """Every fault over one built-in engine. Raises ImportError where it is not installed."""
    sound = build_adapter(BUILT_IN[engine])
    chosen = chosen_integrators(sound.description.integrators)
    has = OF_ENGINE if any(i.orders["attitude"] == 4 for i in chosen) else frozenset()
    count = SOUND * bodies
    accused = sum(_fails(pool, pool.prepare(n), engine, sound) for n in range(count))
    bare, without = Nameless(sound), nameless_integrators(sound)
    accused_bare = sum(_fails(pool, pool.prepare(n), engine, bare, without) for n in range(count))
    usable = [check for check in PUBLISHED if check.integrator_of(sound)]
    accusing = tuple(c.name for c in usable if _score(c, sound, sound, pool.seed, bodies) > 0.0)
    missing = [one.name for one in ORDERED if not one.needs & OF_ENGINE <= has]
    rows = [detection(one, engine, pool, bodies) for one in ORDERED if one.needs & OF_ENGINE <= has]
    names = tuple(integrator.name for integrator in chosen)
    version = sound.description.version
    return EngineMatrix(
        engine, version, names, count, accused, accused_bare, tuple(missing), accusing, tuple(rows)
    )


def _fails(
    pool: Pool,
    prepared: Prepared,
    engine: str,
    adapter: Adapter,
    integrators: tuple[Integrator, ...] = (),
) -> bool:
    found = judge(pool, prepared, engine, adapter, integrators)
    return bool(found.failed) or bool(found.broken)


def detection(fault: Fault, engine: str, pool: Pool, bodies: int) -> Detection:
    """One fault over one engine, on the first bodies that have what it needs.

    The engine has been loaded with another body before, as in any run of several scenarios.
    """
    adapter = fault.wrap(build_adapter(BUILT_IN[engine]))
    numbers = pool.having(fault.needs - OF_ENGINE, bodies)
    adapter.load(pool.prepare(numbers[-1] + 1).case.system)
    found = [(n, judge(pool, pool.prepare(n), engine, adapter)) for n in numbers]
    judged = [(n, one) for n, one in found if not one.broken]
    count = max(1, len(judged))
    return Detection(
        fault=fault,
        judged=len(judged),
        broken=len(found) - len(judged),
        gates={gate: sum(gate in one.failed for _, one in judged) / count for gate in GATES},
        any=sum(bool(one.failed) for _, one in judged) / count,
        named=sum(_named(fault, pool.prepare(n), one) for n, one in judged) / count,
        no_scheme=_caught_nameless(fault, engine, pool, numbers),
        published={
            check.name: _published(check, fault, engine, pool, bodies) for check in PUBLISHED
        },
    )


def _caught_nameless(fault: Fault, engine: str, pool: Pool, numbers: list[int]) -> float:
    """The share of bodies on which the fault is caught without a declared scheme."""
    sound = build_adapter(BUILT_IN[engine])
    adapter, integrators = Nameless(fault.wrap(sound)), nameless_integrators(sound)
    adapter.load(pool.prepare(numbers[-1] + 1).case.system)
    found = [judge(pool, pool.prepare(n), engine, adapter, integrators) for n in numbers]
    judged = [one for one in found if not one.broken]
    return sum(bool(one.failed) for one in judged) / max(1, len(judged))


def _named(fault: Fault, prepared: Prepared, judgement: Judgement) -> bool:
    case, truth, evaluation_states = prepared.case, prepared.truth, prepared.evaluation_states
    with np.errstate(all="ignore"):
        causes = diagnose(case, truth, evaluation_states, judgement.result, judgement.runs)
    return fault.is_named(causes)


def _published(check: Published, fault: Fault, engine: str, pool: Pool, poses: int) -> float | None:
    adapter = fault.wrap(build_adapter(BUILT_IN[engine]))
    if not fault.needs <= check.has or check.integrator_of(adapter.inner) is None:
        return None
    if _fails_sound(check, engine, pool.seed, poses):
        return None
    return _score(check, adapter, adapter.inner, pool.seed, poses)


@cache
def _fails_sound(check: Published, engine: str, seed: int, poses: int) -> bool:
    """Whether the sound engine breaks a check's bounds: the check then detects no fault in it."""
    sound = build_adapter(BUILT_IN[engine])
    return _score(check, sound, sound, seed, poses) > 0.0


def _score(check: Published, adapter: Adapter, sound: Adapter, seed: int, poses: int) -> float:
    """The share of attitudes from which a check's bounds are broken."""
    integrator = check.integrator_of(sound)
    assert integrator is not None
    caught = 0
    with np.errstate(all="ignore"):
        for pose in range(poses):
            caught += check.caught(adapter, integrator, np.random.default_rng([seed, pose]))
    return caught / poses
