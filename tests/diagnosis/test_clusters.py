"""Identical trajectories are found by what the runs did, not by what they declare."""

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import omegadot, quick_scenario
from in_process import builtin, declared, engine_case, truth_of

from omegadot.diagnosis.clusters import clusters_of_run
from omegadot.harness.outcome import JudgedCase

EULER, IMPLICIT, RK4 = "semi-implicit-euler", "linearly-implicit-euler", "lie-rk4"


@pytest.fixture(scope="module")
def case():
    return builtin("full-tensor", 0.02, 0.01)


@pytest.fixture(scope="module")
def truth(case):
    return truth_of(case, (EULER, IMPLICIT, RK4))


def clusters_of(case, truth, engines):
    return clusters_of_run([JudgedCase(case, truth, "", engines)])


def members(found, step):
    return {cluster.members: cluster.scheme for cluster in found if cluster.timestep == step}


def test_one_scheme_in_three_engines_is_one_cluster(case, truth):
    engines = [
        engine_case(case, truth, "one", (declared("Euler", EULER), EULER)),
        engine_case(
            case, truth, "two", (declared("RK", RK4), RK4), (declared("own", EULER), EULER)
        ),
        engine_case(case, truth, "three", (declared("step", EULER), EULER)),
    ]
    found = clusters_of(case, truth, engines)
    assert {cluster.scenario for cluster in found} == {"full-tensor"}
    for step in (0.02, 0.01):
        assert members(found, step) == {
            ("one:Euler", "two:own", "three:step"): EULER,
            ("two:RK",): RK4,
        }


def test_what_is_declared_is_not_used(case, truth):
    engines = [
        engine_case(case, truth, "honest", (declared("Euler", EULER), EULER)),
        engine_case(case, truth, "boaster", (declared("Euler", EULER), IMPLICIT)),
        engine_case(case, truth, "silent", (declared("step", None, 1), EULER)),
    ]
    assert members(clusters_of(case, truth, engines), 0.01) == {
        ("honest:Euler", "silent:step"): EULER,
        ("boaster:Euler",): IMPLICIT,
    }


def test_a_run_that_equals_none_is_alone_and_unnamed(case, truth):
    engines = [engine_case(case, truth, "odd", (declared("own", None, 2), "implicit-midpoint"))]
    assert members(clusters_of(case, truth, engines), 0.01) == {("odd:own",): None}


def test_the_yardsticks_do_not_count(case, truth):
    engines = [
        engine_case(case, truth, "reference", (declared(EULER, EULER), EULER)),
        engine_case(case, truth, "one", (declared("Euler", EULER), EULER)),
    ]
    assert members(clusters_of(case, truth, engines), 0.01) == {("one:Euler",): EULER}


def test_a_motion_that_distinguishes_nothing_lists_which_it_may_be():
    sphere = builtin("sphere", 0.02)
    truth = truth_of(sphere, (EULER, RK4))
    mine = [
        (declared(name, scheme), scheme)
        for name, scheme in zip("abc", (RK4, RK4, EULER), strict=True)
    ]
    (found,) = clusters_of(sphere, truth, [engine_case(sphere, truth, "one", *mine)])
    assert found.members == ("one:a", "one:b", "one:c")
    assert (found.scheme, found.also) == (RK4, (EULER,))
    assert found.exact


def test_errors_of_a_scheme_are_no_exact_solution(case, truth):
    mine = engine_case(case, truth, "one", (declared("a", EULER), EULER))
    assert not any(cluster.exact for cluster in clusters_of(case, truth, [mine]))


def test_a_difference_beyond_rounding_parts_two_runs(case, truth):
    one = engine_case(case, truth, "one", (declared("Euler", EULER), EULER))
    two = engine_case(case, truth, "two", (declared("Euler", EULER), EULER))
    for answer in two.result.runs.values():
        answer.result["state"]["angular_velocity"][-1] *= 1.0 + 1e-9
    found = members(clusters_of(case, truth, [one, two]), 0.01)
    assert found == {("one:Euler",): EULER, ("two:Euler",): None}


def test_a_run_that_failed_is_in_no_cluster(case, truth):
    one = engine_case(case, truth, "one", (declared("Euler", EULER), EULER))
    for judged in one.runs:
        object.__setattr__(judged, "outcome", "diverged")
    assert clusters_of(case, truth, [one]) == []


def test_a_run_records_its_clusters(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    engines = ("mujoco:Euler", "mujoco:RK4", "pinocchio:aba+semi-implicit-euler", "dart")
    arguments = [term for engine in engines for term in ("--engine", engine)]
    result = omegadot("run", "quick.toml", *arguments, "--out", "out", folder=tmp_path)
    assert result.code == 0, result.err
    run = json.loads((tmp_path / "out" / "run.json").read_text())
    (finest,) = [c for c in run["clusters"] if c["timestep"] == 0.005 and len(c["members"]) > 1]
    assert finest["scheme"] == EULER
    assert finest["members"] == [
        *("mujoco:Euler", "pinocchio:aba+semi-implicit-euler", "dart:semi-implicit")
    ]
    assert "produce identical trajectories (all step semi-implicit-euler" in result.out
    assert np.unique([c["timestep"] for c in run["clusters"]]).tolist() == [0.005, 0.01, 0.02]
