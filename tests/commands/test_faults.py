"""Every fault is caught on every body that has what it needs, and sound engines are never accused.

What these tests catch: a gate that lost its bound, its channel or its sample; a fault that is no
longer one; a diagnosis that guesses.
"""

from __future__ import annotations

import numpy as np
import pytest

from omegadot.adapters.protocol import Adapter
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.faults.catalogue import (
    FAULTS,
    ORDERED,
)
from omegadot.commands.faults.detect import Judgement, first_failure, judge
from omegadot.commands.faults.fault import Fault
from omegadot.commands.faults.features import features_of
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.diagnosis.diagnose import diagnose
from omegadot.harness.random_cases import random_case
from omegadot.scenarios.random_traits import BLOCK

SEED = 20
# One of each kind, and of each way in which a fault is put into an engine.
EVERYWHERE = (
    *("InertiaDiagonal", "InertiaAboutOrigin", "OmegaInWorldThroughout", "QuaternionScalarLast"),
    *("GravityReversed", "TorqueInWrongFrame", "PivotAtOrigin", "GyroscopicDropped"),
    *("GyroscopicSlightlyOff", "OmegaDotInWorld", "SecretDamping", "AttitudeLeftMultiplied"),
    *("SinglePrecision", "FallsAsleep", "StepSlightlyLong", "AttitudeOfOrderTwo"),
    *("LogsOneStepLate", "NotFiniteAfterAWhile", "StaleState", "LeaksBetweenScenarios"),
)
ENGINES = ("mujoco", "pinocchio", "dart")


@pytest.fixture(scope="module")
def pool() -> Pool:
    return Pool(SEED)


def systems_for(pool: Pool, fault: Fault, count: int) -> list[Prepared]:
    """Systems that have what the fault needs, those with few steps first."""
    numbers = pool.having(fault.needs - {"order-4"}, 2 * count)
    assert numbers, fault.needs
    numbers.sort(key=lambda number: pool.drawn(number).sweeps[-1].steps)
    return [pool.prepare(number) for number in numbers[:count]]


def faulty(pool: Pool, fault: Fault, engine: str) -> Adapter:
    """The fault over an engine that has seen another system before."""
    adapter: Adapter = fault.wrap(build_adapter(BUILT_IN[engine]))
    adapter.load(pool.another().system)
    return adapter


def sentences(prepared: Prepared, judged: Judgement) -> list[str]:
    with np.errstate(all="ignore"):
        how = (prepared.case, prepared.truth, prepared.evaluation_states)
        return diagnose(*how, judged.result, judged.runs)


@pytest.mark.parametrize("fault", ORDERED, ids=lambda fault: fault.name)
def test_the_cause_of_a_fault_is_named(pool: Pool, fault: Fault) -> None:
    """Caught by every gate that is meant for it, and named, on one of its systems at least.

    On another it may be the same as another fault.
    """
    (first,) = systems_for(pool, fault, 1)
    if not named_on(pool, first, fault, "reference"):
        others = (one for one in systems_for(pool, fault, 4) if one is not first)
        assert any(named_on(pool, one, fault, "reference") for one in others)


def named_on(pool: Pool, prepared: Prepared, fault: Fault, engine: str) -> bool:
    """Whether all its gates catch a fault, and one cause is named, which is its own."""
    judged = judge(pool, prepared, engine, faulty(pool, fault, engine))
    assert judged.broken == ""
    text = sentences(prepared, judged)
    return set(fault.gates) <= judged.failed and len(text) == 1 and fault.is_named(text)


@pytest.mark.no_cover  # what it runs is covered by the causes' test
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", EVERYWHERE)
def test_faults_are_caught_and_named_over_engines(pool: Pool, engine: str, name: str) -> None:
    fault = next(one for one in ORDERED if one.name == name)
    if engine == "dart" and "order-4" in fault.needs:
        integrators = build_adapter(BUILT_IN[engine]).description.integrators
        assert all(i.orders["attitude"] == 1 for i in integrators)
        return  # there is nothing of order 4 in it to be wrong
    assert any(named_on(pool, one, fault, engine) for one in systems_for(pool, fault, 3))


@pytest.mark.parametrize("engine", ["reference", *ENGINES])
def test_sound_engines_are_not_accused(pool: Pool, engine: str) -> None:
    adapter = build_adapter(BUILT_IN[engine])
    for number in range(BLOCK):
        prepared = pool.prepare(number)
        judged = judge(pool, prepared, engine, adapter)
        failed = [row for row in judged.rows if row.verdict == "fail"]
        assert (failed, judged.broken) == ([], ""), prepared.case.name
        found = sentences(prepared, judged)
    assert all(sentence.startswith("none is known") for sentence in found)


def test_there_are_enough_faults_and_each_has_its_phrases() -> None:
    assert len(ORDERED) >= 170
    assert {fault.kind for fault in ORDERED} == {
        *("model", "convention", "equation", "stepping", "logging", "state")
    }
    assert all(fault.named and all(fault.named) for fault in ORDERED)
    assert len({fault.sentence for fault in ORDERED}) == len(ORDERED)


def test_two_faults_at_once_are_no_listed_cause(pool: Pool) -> None:
    """Omega-dot in world axes and 1 % more: a formula states both, and no single cause does."""
    wrong = next(one for one in ORDERED if one.name == "OmegaDotInWorld")
    twice = next(one for one in ORDERED if one.name == "GyroscopicOnePercentOff")
    prepared = pool.prepare(pool.having({"asymmetric", "torque-free"}, 1)[0])
    adapter = wrong.wrap(twice.wrap(build_adapter(BUILT_IN["reference"])))
    judged = judge(pool, prepared, "reference", adapter)
    assert "equation" in judged.failed
    found = sentences(prepared, judged)
    assert found == [
        "omega-dot has 1.01 R omega-dot in place of I^-1 times the gyroscopic term "
        "-omega x I omega, with R the turn from body to world axes"
    ]


def test_random_cases_are_those_of_their_seed() -> None:
    first, again, other = random_case(1, 2), random_case(1, 2), random_case(2, 2)
    assert first.scenario == again.scenario
    assert first.scenario != other.scenario


def test_random_cases_have_every_feature_that_a_fault_needs() -> None:
    seen = [features_of(random_case(SEED, index)) for index in range(2 * BLOCK)]
    for fault in ORDERED:
        assert any(fault.needs - {"order-4"} <= features for features in seen), fault.name


def test_a_fault_that_changes_no_answer_is_not_stepped(pool: Pool) -> None:
    adapter = faulty(pool, FAULTS["DampingOfTranslation"], "reference")
    undamped = pool.prepare(
        next(n for n in range(BLOCK) if "damping" not in features_of(random_case(SEED, n)))
    )
    assert first_failure(pool, undamped, "reference", adapter).runs == ()
    sound = first_failure(pool, undamped, "reference", build_adapter(BUILT_IN["reference"]))
    assert sound.runs != ()
