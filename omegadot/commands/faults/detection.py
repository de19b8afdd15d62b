"""One fault over an engine: on which systems `check` would catch it, at which gate, and by name."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np

from omegadot.adapters.protocol import Adapter
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.faults.detect import (
    GATES,
    Judgement,
    Nameless,
    first_failure,
    judge,
    start_of,
)
from omegadot.commands.faults.fault import Fault
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.commands.faults.published import Published
from omegadot.commands.faults.published_checks import PUBLISHED
from omegadot.commands.faults.restepped import Restepped
from omegadot.diagnosis.diagnose import diagnose

DEFAULT = 24  # random systems of a plain check
NAMED_ON = 1  # systems on which a cause is sought: those with the fewest steps that show it
NAMELESS_ON = 8  # systems that show a fault in runs on which it is tried without a scheme
POSES = 5  # from which a published check starts


@dataclass(frozen=True)
class Detection:
    """One fault over one engine.

    built_in: the first built-in scenario on which it is caught, "" where it is on none.
    judged: random systems that the engine answered for.  broken: those that it refused, or failed
    to answer for, which is no detection.
    gates: by gate, the share of the systems on which it is the first to fail, alone or with others.
    any, no_scheme: the share on which any gate fails, and where the integrators declare their
    orders and no scheme.  named: of the systems diagnosed, the share on which the cause was named;
    None without any.
    published: by check, None where its scenarios or its integrator lack what the fault needs.
    """

    fault: Fault
    built_in: str
    judged: int
    broken: int
    gates: dict[str, float]
    any: float
    no_scheme: float
    named: float | None
    published: dict[str, float | None]

    @property
    def at_default(self) -> float:
        """The probability that one of 24 random systems shows it: ``1 - (1 - p)^24``."""
        return of_several(self.any)

    @property
    def caught(self) -> bool:
        """Whether it is caught on a built-in scenario or on one of the random systems."""
        return bool(self.built_in) or self.any > 0.0

    @property
    def caught_without_scheme(self) -> bool:
        """Whether a random system catches it where no scheme is declared."""
        return self.no_scheme > 0.0


def of_several(share: float) -> float:
    """The probability that at least one of 24 systems shows what this share of systems shows."""
    return float(1.0 - (1.0 - share) ** DEFAULT)


def detection(
    fault: Fault, engine: str, pool: Pool, count: int, published: bool = True
) -> Detection:
    """One fault over one engine: on the built-in scenarios, and on the first random systems."""
    systems = pool.first(count)
    found = _caught_on(systems, fault, engine, pool)
    answered = [one for one in found if not one.broken]
    caught = [s for s, one in zip(systems, found, strict=True) if one.failed]
    caught.sort(key=lambda one: one.case.sweeps[-1].steps)
    checks = PUBLISHED if published else ()
    return Detection(
        fault=fault,
        built_in=_built_in(fault, "reference" if _is_restepped(fault) else engine, pool),
        judged=len(answered),
        broken=len(found) - len(answered),
        gates={gate: _share(gate in one.failed for one in answered) for gate in GATES},
        any=_share(bool(one.failed) for one in answered),
        no_scheme=_without_scheme(systems, found, fault, engine, pool),
        named=_named(caught[:NAMED_ON], fault, engine, pool),
        published={check.name: share_caught(check, engine, fault, pool.seed) for check in checks},
    )


def _faulty(fault: Fault, engine: str, pool: Pool, nameless: bool = False) -> Adapter:
    """A faulty engine that has been loaded with another system, as in any run of several."""
    adapter: Adapter = fault.wrap(build_adapter(BUILT_IN[engine]))
    adapter = Nameless(adapter) if nameless else adapter
    adapter.load(pool.another().system)
    return adapter


def _caught_on(systems: list[Prepared], fault: Fault, engine: str, pool: Pool) -> list[Judgement]:
    """What a fault shows on each system, as far as its first failure.

    What is stepped by the reference's schemes is tried over other engines where it shows over the
    reference. Elsewhere the stage of the equations stands for all.
    """
    adapter, shows = _faulty(fault, engine, pool), [True] * len(systems)
    if _is_restepped(fault) and engine != "reference":
        known = pool.over_reference.get(fault.name)
        if known is None or len(known) != len(systems):
            known = [bool(one.failed) for one in _caught_on(systems, fault, "reference", pool)]
        shows = known
    found = [
        first_failure(pool, one, engine, adapter) if show else start_of(pool, one, engine, adapter)
        for one, show in zip(systems, shows, strict=True)
    ]
    if engine == "reference":
        pool.over_reference[fault.name] = [bool(one.failed) for one in found]
    return found


def _without_scheme(
    systems: list[Prepared], found: list[Judgement], fault: Fault, engine: str, pool: Pool
) -> float:
    """The share of systems on which the engine fails without a declared scheme, an estimate.

    The model and the equations know of no scheme. Of the systems that show the fault in runs a few
    are tried without one, and where none shows it with a scheme, all.
    """
    answered = [(s, one) for s, one in zip(systems, found, strict=True) if not one.broken]
    at_once = sum(bool(one.failed) and not one.runs for _, one in answered)
    in_runs = [s for s, one in answered if one.failed and one.runs]
    tried = in_runs[:NAMELESS_ON] if at_once or in_runs else [s for s, _ in answered]
    adapter = _faulty(fault, engine, pool, nameless=True)
    caught = _share(bool(first_failure(pool, s, engine, adapter).failed) for s in tried)
    return (at_once + caught * len(in_runs or tried)) / max(1, len(answered))


def _is_restepped(fault: Fault) -> bool:
    """Whether it is stepped by the reference's schemes, whatever the engine.

    It is then judged on the built-in scenarios over the reference alone, whose dynamics are those
    of every sound engine to rounding.
    """
    return isinstance(fault.wrap, type) and issubclass(fault.wrap, Restepped)


def _built_in(fault: Fault, engine: str, pool: Pool) -> str:
    """The first built-in scenario on which a fault is caught; the equations of all come first."""
    known = pool.caught_on_built_in.get((fault.name, engine))
    if known is not None:
        return known
    cases, found = pool.built_in(), ""
    adapter = _faulty(fault, engine, pool)
    for one in cases:
        if start_of(pool, one, engine, adapter).failed:
            found = one.case.name
            break
    if not found:
        adapter = _faulty(fault, engine, pool)
        shown = (c for c in cases if first_failure(pool, c, engine, adapter).failed)
        found = next((one.case.name for one in shown), "")
    pool.caught_on_built_in[fault.name, engine] = found
    return found


def _share(caught: Iterable[bool]) -> float:
    every = list(caught)
    return sum(every) / max(1, len(every))


def _named(systems: list[Prepared], fault: Fault, engine: str, pool: Pool) -> float | None:
    """The share of these systems on which the diagnosis names the cause."""
    adapter, named = _faulty(fault, engine, pool), []
    for one in systems:
        judged = judge(pool, one, engine, adapter)
        known = (one.case, one.truth, one.evaluation_states)
        with np.errstate(all="ignore"):
            named.append(fault.is_named(diagnose(*known, judged.result, judged.runs)))
    return _share(named) if named else None


@cache
def share_caught(check: Published, engine: str, fault: Fault | None, seed: int) -> float | None:
    """The share of attitudes from which a check's bounds are broken, by a fault or without one.

    None where the check does not apply, or where the sound engine breaks its bounds already: the
    check then detects no fault in it.
    """
    sound = build_adapter(BUILT_IN[engine])
    integrator = check.integrator_of(sound)
    if integrator is None or (fault and not fault.needs <= check.has):
        return None
    if fault and share_caught(check, engine, None, seed):
        return None
    adapter = fault.wrap(sound) if fault else sound
    draws = (np.random.default_rng([seed, pose]) for pose in range(POSES))
    with np.errstate(all="ignore"):
        return _share(check.caught(adapter, integrator, random) for random in draws)
