"""Engines in single precision: sound ones pass all gates, and a fault far above rounding does not.

What these tests catch: bounds of double on singles; bounds so wide that a thousandth goes through;
a sound engine accused because its start, step, clock or body is rounded; a declared scheme, stepped
in double for comparison, that singles cannot follow.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from in_process import truth_of
from single_engines import (
    DeclaredEuler,
    Single,
    SingleEuler,
    SingleMomentum,
    SingleRodrigues,
    StoredSingle,
    declared_double,
    with_fault,
)

from omegadot.commands.faults.detect import Judgement, judge
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.states.equation import evaluation_states_of
from omegadot.harness.arguments import case_of
from omegadot.harness.collect import trajectories_of_run
from omegadot.harness.outcome import EngineCase, JudgedCase, Outcome
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.scenarios import scenario

pytestmark = pytest.mark.no_cover  # its lines are covered by others

SOUND = (Single, SingleEuler, DeclaredEuler, StoredSingle, SingleMomentum, SingleRodrigues)
EULER = (SingleEuler, DeclaredEuler, StoredSingle)
POOL = Pool(0)
AXES = rotation_matrix(np.array([0.5, 0.1, -0.7, 0.5]))
TENSOR = AXES @ np.diag([0.5, 1.1, 1.3]) @ AXES.T
BODY = {"mass": 1.7, "inertia": 0.5 * (TENSOR + TENSOR.T), "center_of_mass": [0.1, -0.2, 0.3]}
RUN = {"duration": 1.6, "timesteps": [0.04, 0.02, 0.01], "sample": 0.08}
TURN = {"orientation": [0.3, -0.5, 0.1, 0.8], "angular_velocity": [1.0, -2.0, 0.7]}
DOWN = [1.0, -2.0, -9.0]
CASES: dict[str, Any] = {
    "free": {"initial": TURN},
    "loaded": {
        "initial": TURN | {"position": [1.0, 0.3, -2.0], "linear_velocity": [0.1, 2.0, -0.3]},
        "load": {
            "gravity": DOWN,
            "damping": 0.3,
            "torque": {"frame": "world", "value": [0.3, 0.7, -0.2]},
        },
    },
    "pivoted": {"initial": TURN, "load": {"gravity": DOWN, "pivot": [-0.3, 0.2, 0.1]}},
    "slender": {
        "initial": TURN,
        "body": {"mass": 1.7, "inertia": [[1.0, 0.0, 0.0], [0.0, 0.5, 0.49], [0.0, 0.49, 0.5]]},
    },
    # steps of a third of a radian, next to which rounding is small
    "disc": {
        "initial": TURN,
        "body": {"mass": 1.7, "inertia": [1.0, 1.0, 2.0]},
        "run": {"duration": 3.2, "timesteps": [0.16, 0.08, 0.04], "sample": 0.16},
    },
    # 10 km away, where a millimetre is an ulp
    "far": {
        "initial": TURN | {"position": [1e4, -2e3, 5e3], "linear_velocity": [30.0, 1.0, -4.0]},
        "load": {"gravity": DOWN},
    },
}


@cache
def prepared(name: str) -> Prepared:
    case = case_of(scenario({"name": name, "body": BODY, "run": RUN, **CASES[name]}), [])
    truth = truth_of(case, ())
    return Prepared(case, truth, evaluation_states_of(case, truth, 0))


def judged(name: str, engine: Single) -> Judgement:
    return judge(POOL, prepared(name), "single", engine, engine.description.integrators)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("engine", SOUND)
def test_a_sound_engine_passes(engine: type[Single], name: str) -> None:
    found = judged(name, engine())
    assert not found.accused, [row for row in found.rows if row.verdict == "fail"]
    verdicts = {(row.gate, row.metric): row.verdict for row in found.rows}
    metrics = ("match",) if engine.declared else ("rate_at_no_step", "restarted")
    assert [verdicts["scheme", metric] for metric in metrics] == ["pass"] * len(metrics)
    assert {verdicts["trajectory", metric] for metric in ("start", "unit_length")} == {"pass"}
    # in double precision it would not
    equation = [row for row in found.rows if row.gate == "equation"]
    assert max(row.value / row.bound for row in equation if row.bound) > 2.0**-29


@pytest.mark.parametrize(
    ("name", "factors"),
    [
        ("free", {"gyroscopic": 1.001}),
        ("free", {"stretch": 1.001}),
        ("loaded", {"damping": 1.01}),
        ("loaded", {"gravity": -1.0}),
        ("pivoted", {"mass": 1.0001}),
        ("pivoted", {"stretch": 0.999}),
    ],
)
@pytest.mark.parametrize("engine", EULER)
def test_a_fault_far_above_rounding_fails(
    engine: type[Single], name: str, factors: dict[str, float]
) -> None:
    found = judged(name, with_fault(engine, **factors))
    if "stretch" in factors:  # nothing is wrong in the equation
        assert found.failed
        assert "equation" not in found.failed
        notes = " ".join(row.note for row in found.rows if row.verdict == "fail")
        assert ("diverges from it" if engine.declared else "steps are 0.1 % too") in notes
    else:
        assert "equation" in found.failed


@pytest.mark.parametrize("factor", [0.999, 1.001])
def test_a_thousandth_in_the_steps_alone_is_seen_near_rounding(factor: float) -> None:
    """An error that no step changes, where the bounds of rounding hide its order."""
    found = judged("disc", with_fault(Single, stepped_gyroscopic=factor))
    assert found.failed == {"trajectory"}
    notes = " ".join(row.note for row in found.rows if row.verdict == "fail")
    assert "at most, whatever rounding does, declared 4" in notes


@pytest.mark.parametrize("engine", [SingleEuler, StoredSingle])
def test_singles_that_are_declared_doubles_fail(engine: type[Single]) -> None:
    found = judged("free", declared_double(engine))
    assert {"model", "equation", "trajectory"} <= found.failed
    notes = {row.note for row in found.rows if row.metric == "precision"}
    kept = "attitude and omega are kept in single precision"
    assert notes == {f"{kept}, and double is declared"}


def test_samples_at_a_rounded_clock_stand_where_the_exact_ones_do() -> None:
    own, engine = prepared("free"), SingleEuler()
    found = judged("free", engine)
    sweep = own.case.sweeps[0]
    times = found.result.runs["step", sweep.timestep].result["time"]
    assert 0.0 < np.max(np.abs(times - sweep.times)) <= 2 * eps_of("float32") * sweep.times[-1]
    integrators = engine.description.integrators
    started = Engine(EngineChoice("single", ""), engine.description, integrators)
    answered = EngineCase(started, found.result, [], list(found.runs))
    case = JudgedCase(own.case, own.truth, "", [answered])
    frame = trajectories_of_run(Outcome([started], [], [case], False, []), "physics")
    stored = frame.filter((frame["engine"] == "single") & (frame["timestep"] == sweep.timestep))
    assert stored["time"].to_list() == sweep.times.tolist()
