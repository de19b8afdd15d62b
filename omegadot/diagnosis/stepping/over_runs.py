"""What all runs of an integrator show together: which term acts otherwise, and how it goes on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.defect import first_found
from omegadot.diagnosis.stepping.ends.skipped_steps import skipped_steps
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, scheme_of
from omegadot.diagnosis.stepping.lengths import length_causes
from omegadot.diagnosis.stepping.limits_over_runs import limit_causes
from omegadot.diagnosis.stepping.loads.acting import KNOWN, TERMS, Shares, shares_of
from omegadot.diagnosis.stepping.loads.fixed_substeps import fixed_substeps
from omegadot.diagnosis.stepping.loads.kept_torques import kept_torque_causes
from omegadot.diagnosis.stepping.loads.load_impulses import impulse_causes
from omegadot.diagnosis.stepping.loads.load_spell_laws import spell_causes
from omegadot.diagnosis.stepping.loads.load_times import load_time_causes
from omegadot.diagnosis.stepping.loads.share_laws import laws_of
from omegadot.diagnosis.stepping.loads.share_points import points_of
from omegadot.diagnosis.stepping.loads.whole_substeps import substeps_of_runs
from omegadot.diagnosis.stepping.places import place_causes
from omegadot.diagnosis.stepping.slips.commutator_slips import commutator_slips
from omegadot.diagnosis.stepping.slips.first_step import first_step_causes
from omegadot.diagnosis.stepping.slips.implicit_gyroscopic import implicit_gyroscopic
from omegadot.diagnosis.stepping.slips.jacobian_slips import jacobian_slips
from omegadot.diagnosis.stepping.slips.multistep_slips import multistep_slips
from omegadot.diagnosis.stepping.slips.old_operands import SOLVED, old_operands
from omegadot.diagnosis.stepping.slips.old_where import old_operands_where
from omegadot.diagnosis.stepping.slips.scheme_by_length import scheme_by_length
from omegadot.diagnosis.stepping.slips.scheme_by_state import scheme_by_state
from omegadot.diagnosis.stepping.slips.stage_slips import slips_in_stages, stage_slips
from omegadot.diagnosis.stepping.slips.switched import switched
from omegadot.diagnosis.stepping.turns.between_steps import between_steps
from omegadot.diagnosis.stepping.turns.exponentials import exponential_causes
from omegadot.diagnosis.stepping.turns.mixed_turns import mixed_turns
from omegadot.diagnosis.stepping.turns.short_turns import short_turns
from omegadot.diagnosis.stepping.turns.solved import solved_causes
from omegadot.diagnosis.stepping.turns.tolerances import tolerance_causes
from omegadot.diagnosis.wording.kinds import either
from omegadot.reference_impl.system import Array

MISSED = 0.2  # of the failing runs, that may be beyond what one share in an interval shows
MOST_FAILING, MOST_SOUND = 16, 6  # runs that are looked at
MOST_OTHERS = 8  # of which a law has to be as well
FEW_STEPS, ENOUGH = 8, 4  # between samples, and scenarios with no more of them
SCENARIOS = 2  # at least, that fail: of one motion much else may be the cause


def law_causes(
    by: SchemeOf, chosen: Sequence[KeptRun], others: Sequence[KeptRun] = ()
) -> list[str]:
    """A term that acts otherwise in the steps, by one law in every run; none where none does.

    others: runs of which the law of those that are chosen has to be as well.
    """
    every: dict[str, list[Shares]] = {name: [] for name in TERMS}
    left = dict.fromkeys(TERMS, int(MISSED * sum(run.fails for run in chosen)))
    for run in chosen:
        found = shares_of(run, by)
        for name in list(every):
            if name in found:
                every[name].append(found[name])
            elif run.fails and left[name] > 0:
                left[name] -= 1
            else:
                del every[name]
        if not every:
            return []
    for name, shares in every.items():  # what states less comes first
        points = points_of(shares)
        texts = laws_of(points) if points is not None else []
        if texts:
            more = [found[name] for run in others if name in (found := shares_of(run, by))]
            points = points_of([*shares, *more])
            texts = laws_of(points) if points is not None else []
        if texts:
            return either([f"in the steps, {text.format(name)}" for text in texts])
    return []


def causes_over_runs(integrator: Integrator, runs: Sequence[KeptRun]) -> list[str]:
    """What makes all runs of an integrator together; none where none does."""
    failing = {run.name for run in runs if run.fails}
    with np.errstate(all="ignore"):
        # of these every interval of every run must be made, which one motion may decide
        found = first_found(
            (
                lambda: multistep_slips(integrator, runs),
                lambda: commutator_slips(integrator, runs),
                lambda: jacobian_slips(integrator, runs),
                lambda: implicit_gyroscopic(integrator, runs),
                lambda: short_turns(runs),
            )
        )
        if found or len(failing) < SCENARIOS:
            return found
        by, chosen = scheme_of(integrator, runs), [run.short for run in _chosen(runs)]
        return first_found(_searches(integrator, by, runs, chosen))


def _searches(
    integrator: Integrator, by: SchemeOf | None, runs: Sequence[KeptRun], chosen: Sequence[KeptRun]
) -> Iterator[Callable[[], list[str]]]:
    """Each of what is sought over all runs, what is the plainest first."""
    declared = integrator.scheme is not None
    if by is None:
        yield lambda: stage_slips(integrator, by, chosen)
        yield lambda: solved_causes(by, runs, declared)
        return
    yield lambda: scheme_by_length(by, runs)
    yield lambda: switched(by, runs)
    yield lambda: scheme_by_state(integrator, by, runs)
    yield lambda: between_steps(by, runs)
    yield lambda: first_step_causes(by, runs)
    yield lambda: substeps_of_runs(integrator, by, chosen)
    yield lambda: fixed_substeps(by, runs)
    yield lambda: either(limit_causes(by, runs))
    yield lambda: skipped_steps(by, runs)
    yield lambda: length_causes(by, runs)
    yield lambda: load_time_causes(by, runs)
    yield lambda: spell_causes(by, runs)
    yield lambda: impulse_causes(by, runs)
    yield lambda: law_causes(by, chosen, _others(runs, chosen))
    solves = by.scheme.name in SOLVED  # of an equation one iteration has old operands as well
    if not solves:
        yield lambda: either(old_operands(by, chosen))
    yield lambda: kept_torque_causes(by, chosen)
    yield lambda: stage_slips(integrator, by, chosen)
    yield lambda: exponential_causes(by, runs)
    yield lambda: mixed_turns(by, runs, declared)
    yield lambda: solved_causes(by, runs, declared)
    yield lambda: tolerance_causes(by, runs)
    if solves:
        yield lambda: either(old_operands(by, chosen))
    yield lambda: old_operands_where(by, chosen, runs)
    yield lambda: place_causes(by, runs)


def causes_of_one_run(by: SchemeOf, run: KeptRun) -> list[str]:
    """What makes one run that stands alone; none where more than one cause does."""
    run = run.short
    terms: list[tuple[str, Array]] = []
    texts = list[str]()
    for name, one in shares_of(run, by).items():
        points = points_of([one], scenarios=1)
        known = [np.allclose(one.share, share, atol=KNOWN, equal_nan=True) for _, share in terms]
        if points is None or any(known):
            continue
        terms.append((name, one.share))
        texts += either([f"in the steps, {text.format(name)}" for text in laws_of(points)])
    solves = by.scheme.name in SOLVED
    texts = texts or ([] if solves else old_operands(by, [run], least=1))
    texts = texts or slips_in_stages(by.scheme.name, [run], least=1)
    if len(texts) > 1:
        return []
    texts = texts or solved_causes(by, [run], declared=True)
    texts = texts or (old_operands(by, [run], least=1) if solves else [])
    return (texts or place_causes(by, [run])) if len(texts) < 2 else []


def _chosen(runs: Sequence[KeptRun]) -> list[KeptRun]:
    """Of the failing ones those of few steps a sample, two a scenario, and some sound ones.

    Within many steps a share changes too much for one number, where enough others are there.
    """
    failing, sound = (_two_each([r for r in runs if r.fails is fails]) for fails in (True, False))
    few = [run for run in failing if run.sweep.every <= FEW_STEPS]
    if len({run.name for run in few}) >= ENOUGH:
        failing = few
    return [*_evenly(failing, MOST_FAILING), *_evenly(sound, MOST_SOUND)]


def _others(runs: Sequence[KeptRun], chosen: Sequence[KeptRun]) -> list[KeptRun]:
    """Some that fail besides those that are chosen."""
    known = {(run.name, run.timestep) for run in chosen}
    left = [run for run in runs if run.fails and (run.name, run.timestep) not in known]
    return [run.short for run in _evenly(left, MOST_OTHERS)]


def _two_each(runs: Sequence[KeptRun]) -> list[KeptRun]:
    kept: dict[str, list[KeptRun]] = {}
    for run in sorted(runs, key=lambda run: run.sweep.every):
        kept.setdefault(run.name, []).append(run)
    return sorted((r for one in kept.values() for r in one[:2]), key=lambda r: r.sweep.every)


def _evenly(runs: Sequence[KeptRun], most: int) -> list[KeptRun]:
    if len(runs) <= most:
        return list(runs)
    return [runs[k] for k in np.linspace(0, len(runs) - 1, most).astype(int)]
