"""Steps that an engine takes as several of its declared scheme, each of a part of the length."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.explicit_schemes import scheme_named
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.schemes import Motion, Scheme
from omegadot.reference_impl.system import Array

COUNTS = {2: "two", 3: "three", 4: "four", 5: "five", 8: "eight", 10: "ten"}
NAMED = re.compile(r"each step is taken in (\w+) equal substeps of (\S+)")
MOST_STEPS = 5000  # of a run, with its substeps


def substepped(scheme: Scheme, count: int) -> Scheme:
    """Its step of h as `count` of ``h / count``."""

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        for _ in range(count):
            q, v = scheme.step(motion, q, v, h / count)
        return q, v

    return replace(scheme, step=step)


def scheme_of_substeps(text: str) -> tuple[Scheme, Scheme] | None:
    """That of the steps that a text of this file names, and of each substep; None of another."""
    found = NAMED.fullmatch(text)
    counts = [n for n, word in COUNTS.items() if found is not None and word == found[1]]
    if found is None or not counts:
        return None
    scheme = scheme_named(found[2])
    return substepped(scheme, counts[0]), scheme


def _named(scheme: Scheme, counts: Sequence[int]) -> list[str]:
    """None where several numbers of substeps make the same: a motion may have too little in it."""
    if len(counts) != 1:
        return []
    return [f"each step is taken in {COUNTS[counts[0]]} equal substeps of {scheme.name}"]


def substeps_of_run(reported: ReportedRun) -> list[str]:
    """Of a run whose scheme is declared; none of a run that the scheme makes in whole steps."""
    if not reported.is_declared or reported.is_own:
        return []
    scheme, steps = reported.declared, reported.sweep.steps
    first = reported.until(2)  # the first interval rules out most of them
    made = [
        count
        for count in COUNTS
        if count * steps <= MOST_STEPS
        and first.agrees(first.state, first.stepped(one := substepped(scheme, count)))
        and reported.is_made(partial(ReportedRun.stepped, scheme=one))
    ]
    return _named(scheme, made)


def substeps_of_runs(integrator: Integrator, by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """Of runs of a declared scheme, every interval of which is led on so, sound ones as well."""
    if integrator.scheme is None or all(_leads(by.scheme, by, run) for run in runs):
        return []
    failing = sorted(runs, key=lambda run: not run.fails)
    made = [n for n in COUNTS if all(_leads(substepped(by.scheme, n), by, run) for run in failing)]
    return _named(by.scheme, made)


def _leads(scheme: Scheme, by: SchemeOf, run: KeptRun) -> bool:
    own = SchemeOf(scheme, canonical(run.system, by.coordinates))
    return bool(np.all(run.sound(own)))
