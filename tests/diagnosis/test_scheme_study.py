"""Schemes are named from the steps alone, and orders are what they are, whatever is declared."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import ENGINES, FAULTY, omegadot

from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.schemes.print_schemes import markdown_of
from omegadot.diagnosis.scheme_study import fingerprint
from omegadot.diagnosis.scheme_study.naming import Naming, name_schemes
from omegadot.diagnosis.scheme_study.orders import Observed, Point, observe
from omegadot.diagnosis.scheme_study.probes import PROBES, in_precision
from omegadot.diagnosis.scheme_study.study import IntegratorStudy, study_probe
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import stack
from omegadot.reference_impl.system import State

PAGE = Path(__file__).parents[2] / "docs" / "schemes.md"
MISDECLARED = ENGINES / "misdeclared.py"
OLD_MUJOCO = "OMEGADOT_OLD_MUJOCO_PYTHON"

EXPLICIT, IMPLICIT = "semi-implicit-euler", "linearly-implicit-euler"
# What steps what on a free body, and on a pivot where that is another scheme.
NAMED = {
    ("mujoco", "Euler"): [EXPLICIT],
    ("mujoco", "RK4"): ["munthe-kaas-rk4"],
    ("mujoco", "implicit"): [IMPLICIT],
    ("mujoco", "implicitfast"): [IMPLICIT, "implicit-damping-euler"],
    ("mujoco", "discrete"): [IMPLICIT, "implicit-damping-euler"],
    ("dart", "semi-implicit"): ["semi-implicit-euler-short-turns"],
    ("pinocchio", "aba+semi-implicit-euler"): [EXPLICIT],
    ("pinocchio", "aba+linearly-implicit-euler"): [IMPLICIT],
    ("pinocchio", "aba+rk4-quaternion"): ["rk4-quaternion"],
    ("pinocchio", "aba+lie-rk4"): ["lie-rk4"],
    ("pinocchio", "aba+lie-rk4-naive"): ["lie-rk4-naive"],
    ("pinocchio", "aba+implicit-midpoint"): ["implicit-midpoint"],
}


def studied(folder: Path, *arguments: object, code: int = 0) -> Any:
    """The JSON of ``omegadot schemes``, which must end with this exit code."""
    result = omegadot("schemes", *arguments, "--format", "json", folder=folder)
    assert result.code == code, result.err or result.out
    return result.json


def integrators(record: Any) -> dict[tuple[str, str], Any]:
    engines = record["engines"]
    return {(e["name"], i["name"]): i for e in engines for i in e["integrators"]}


def names(integrator: Any) -> list[str | None]:
    return [naming["scheme"] for naming in integrator["schemes"]]


def verdicts(integrator: Any) -> set[str]:
    probes = integrator["probes"].values()
    return {order["verdict"] for probe in probes for order in probe["orders"].values()}


def order(integrator: Any, channel: str, kind: str = "free") -> float:
    return float(integrator["probes"][kind]["orders"][channel]["order"])


def test_the_three_engines_are_named_and_the_page_states_it(tmp_path: Path) -> None:
    record = studied(tmp_path)
    found = integrators(record)
    assert {who: names(integrator) for who, integrator in found.items()} == NAMED
    for who, integrator in found.items():
        assert verdicts(integrator) <= {"holds", "conserved"}, who
        points = {m["coordinates"] for m in integrator["probes"]["free"]["matches"]}
        assert points == {"body-spatial" if who[0] == "pinocchio" else "origin-world"}, who
        for kind, probe in integrator["probes"].items():
            assert probe["as_declared"] is True, (who, kind)
            assert {d["kind"] for d in probe["defects"].values()} <= {"settled", "floor"}, who
    assert_alike(PAGE.read_text(encoding="utf-8"), markdown_of(record))


NUMBER = r"(?:\d+\.\d+(?:e-?\d+)?|\de-\d+)"
RANGE = re.compile(rf"({NUMBER})(?:–({NUMBER}))?")


def assert_alike(page: str, made: str) -> None:
    """The same text; numbers may differ in what rounding and another machine may do to them."""
    again = "docs/schemes.md is old: omegadot schemes --format markdown > docs/schemes.md"
    assert RANGE.sub("#", page) == RANGE.sub("#", made), again
    for old, new in zip(RANGE.findall(page), RANGE.findall(made), strict=True):
        if re.fullmatch(r"\de-\d+", old[0]):  # the decade of a residual, which is rounding itself
            assert abs(np.log10(float(old[0]) / float(new[0]))) < 1.5, again
        else:
            ends = [[float(end or start) for start, end in ((n[0], n[0]), n)] for n in (old, new)]
            assert ends[0] == pytest.approx(ends[1], rel=0.05), again


# A torque held for the step errs in omega, which reaches the attitude in the steps after it alone.
OWN_DEFECT = {"frozen-torque-midpoint": 3, "body-axes-midpoint": 3}


def test_each_reference_scheme_identifies_itself_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    # Following what is left reports nothing here: it is the same computation.
    monkeypatch.setattr(fingerprint, "FOLLOWING", ((0.02, 60, 20),))
    reference = ReferenceAdapter()
    for integrator in reference.description.integrators:
        name = integrator.name
        probes = {}
        for probe in PROBES:
            reference.load(probe.system)

            def step(
                initial: State, timestep: float, steps: int, every: int, name: str = name
            ) -> State:
                return reference.run(initial, name, timestep, steps, every).state

            probes[probe.kind] = study_probe(probe, integrator, step)
        study = IntegratorStudy(name, probes)
        assert study.namings == [Naming(name, tuple(probes))]
        assert study.departures == []
        for kind, found in probes.items():
            assert found.as_declared is True
            for channel, shown in found.orders.items():
                assert shown.verdict in {"holds", "conserved"}, (name, kind, channel)
                defect = found.defects[channel].observed
                assert defect.kind in {"settled", "floor"}, (name, kind, channel)
                # What a step errs by accumulates to an order less, or feeds on other channels.
                if defect.order is not None and shown.observed.order is not None:
                    assert defect.order > shown.observed.order + 0.85, (name, kind, channel)
            attitude = found.defects["attitude"].observed.order
            own = OWN_DEFECT.get(name, SCHEMES[name].orders["attitude"] + 1)
            assert attitude == pytest.approx(own, abs=0.15)


def test_single_precision_has_its_own_rounding(monkeypatch: pytest.MonkeyPatch) -> None:
    """Caught: an engine in single precision, of which it is stated that it steps nothing known."""
    monkeypatch.setattr(fingerprint, "FOLLOWING", ((0.02, 60, 20),))
    name, reference = "semi-implicit-euler-rescaled-momentum", ReferenceAdapter()
    integrator = next(i for i in reference.description.integrators if i.name == name)
    double, single = PROBES[0], in_precision(PROBES[0], "float32")
    reference.load(double.system)

    def rounded(state: State) -> State:
        return State(*(field.astype(np.float32).astype(float) for field in vars(state).values()))

    def step(initial: State, timestep: float, steps: int, every: int) -> State:
        kept = [rounded(initial)]
        now = kept[0]
        for n in range(1, steps + 1):
            now = rounded(reference.run(now, name, timestep, 1, 1).state[-1])
            if n % every == 0 or n == steps:
                kept.append(now)
        return stack(kept)

    found = study_probe(single, integrator, step)
    assert found.as_declared is True
    assert IntegratorStudy(name, {single.kind: found}).departures == []
    assert EXPLICIT not in {match.scheme for match in found.matches}
    assert fingerprint.fingerprint(double, step) == []


def test_a_wrong_declaration_is_found_out(tmp_path: Path) -> None:
    engines = ["EulerAsRungeKutta", "NaiveAsRungeKutta", "Unheard", "AlmostEuler"]
    arguments = [
        w for e in engines for w in ("--adapter", f"{MISDECLARED}:{e}", "--engine", e.lower())
    ]
    record = studied(tmp_path, *arguments, code=1)
    euler, naive, unheard, almost = (integrators(record)[e.lower(), "step"] for e in engines)

    assert names(euler) == [EXPLICIT]
    assert order(euler, "attitude") == pytest.approx(1, abs=0.15)
    assert "free: it does not step the declared lie-rk4" in euler["departures"]
    assert any("attitude 1.0" in clause for clause in euler["departures"])

    assert names(naive) == ["lie-rk4-naive"]
    assert order(naive, "omega") == pytest.approx(4, abs=0.15)
    assert order(naive, "attitude") == pytest.approx(2, abs=0.15)
    lower = next(clause for clause in naive["departures"] if clause.startswith("free: below"))
    assert re.search(r"attitude (1.9|2.0)\d of 4", lower)
    assert "omega" not in lower.replace("angular momentum", "")

    assert unheard["schemes"] == [{"scheme": None, "kinds": ["free", "damped"], "others": []}]
    assert unheard["probes"]["pivoted"]["outcome"] == "unsupported"
    assert order(unheard, "attitude") == pytest.approx(2, abs=0.15)
    defect = unheard["probes"]["free"]["defects"]["attitude"]
    assert defect["order"] == pytest.approx(3, abs=0.15)
    assert defect["value"] > 0

    # Its orders are those of Euler's scheme, and still it is not that.
    assert names(almost) == [None]
    assert verdicts(almost) <= {"holds", "conserved"}

    page = markdown_of(record)
    assert re.search(r"unknown: order omega [12]\.\d\d", page)
    assert "NOT as declared: lie-rk4" in page
    assert "there are no joints here." in page


def test_runge_kutta_of_mujoco_changed_its_order(tmp_path: Path) -> None:
    python = os.environ.get(OLD_MUJOCO)
    if python is None:
        pytest.skip(f"{OLD_MUJOCO} names no interpreter that has MuJoCo 3.17.0, NumPy and SciPy")
    arguments = ("--engine", "mujoco:RK4")
    old = studied(tmp_path, *arguments, "--python", f"mujoco={python}")
    assert old["engines"][0]["version"] == "3.17.0"
    before = integrators(old)["mujoco", "RK4"]
    after = integrators(studied(tmp_path, *arguments))["mujoco", "RK4"]
    assert names(before) == ["lie-rk4-naive"]
    assert names(after) == ["munthe-kaas-rk4"]
    for kind in ("free", "damped", "pivoted", "pivoted-damped"):
        assert order(before, "attitude", kind) == pytest.approx(2, abs=0.15)
        assert order(after, "attitude", kind) == pytest.approx(4, abs=0.15)


def test_tables_are_printed_and_an_interpreter_is_taken(tmp_path: Path) -> None:
    arguments = ("--engine", f"reference:{EXPLICIT}", "--python", f"reference={sys.executable}")
    result = omegadot("schemes", *arguments, folder=tmp_path)
    assert result.code == 0, result.err
    assert "Schemes" in result.out
    assert re.search(rf"{EXPLICIT} +{EXPLICIT} +com-world +to 0 over 1000 steps", result.out)
    assert "1 (1.0" in result.out


def test_an_engine_that_dies_is_an_outcome(tmp_path: Path) -> None:
    arguments = ("--adapter", f"{FAULTY}:Killed", "--engine", f"killed:{EXPLICIT}")
    killed = integrators(studied(tmp_path, *arguments, code=3))["killed", EXPLICIT]
    assert {probe["outcome"] for probe in killed["probes"].values()} == {"crashed"}
    assert killed["schemes"] == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--python", "mujoco"), "NAME=PATH"),
        (("--python", "mujoko=/bin/sh"), "write mujoco"),
        (("--python", "mujoco=/no/such/python"), "no program"),
        (("--engine", "mujoco:Eulr"), "write Euler"),
        (("--engine", "mujoko"), "write mujoco"),
    ],
)
def test_wrong_usage_of_schemes_is_one_sentence(arguments: tuple[str, ...], message: str) -> None:
    result = omegadot("schemes", *arguments, folder=PAGE.parent)
    assert result.code == 2
    assert message in result.err
    assert result.err.count("\n") == 1


def points(errors: list[float], bound: float = 1e-14) -> list[Point]:
    return [Point(0.4 / 2**n, error, bound) for n, error in enumerate(errors)]


def test_an_order_is_regressed_over_the_settled_part() -> None:
    h = 0.4 / 2.0 ** np.arange(8)
    clean = observe(points(list(3 * h**2)))
    assert clean.kind == "settled"
    assert clean.order == pytest.approx(2, abs=1e-12)
    # A first order that is hidden at coarse steps: those must not weigh in.
    late = observe(points(list(0.1 * h + 5 * h**3)))
    assert late.kind == "settled"
    assert late.order == pytest.approx(1, abs=0.15)


def test_an_order_is_not_seen_where_it_cannot_be() -> None:
    h = 0.4 / 2.0 ** np.arange(6)
    assert observe(points([1e-15] * 4)) == Observed("floor")
    assert observe([]) == Observed("unresolved")
    assert observe(points(list(h**4)[:3])).kind == "unresolved"
    assert observe(points([1.0, 0.5, 0.1, 0.09, 0.01])).kind == "unresolved"
    # What is below the floor reports nothing, however regular it looks.
    sunk = observe(points([*(h**4), 1e-16, 1e-16, 1e-16]))
    assert sunk.order == pytest.approx(4, abs=1e-9)


def test_names_cover_all_probes_with_the_fewest_schemes() -> None:
    free = {"free": [EXPLICIT, "implicit-damping-euler"], "damped": ["implicit-damping-euler"]}
    nothing = dict.fromkeys(free, None)
    assert name_schemes(free, nothing) == [Naming("implicit-damping-euler", ("free", "damped"))]
    tied = {"free": [EXPLICIT, "implicit-damping-euler"]}
    assert name_schemes(tied, {"free": None}) == [
        Naming(EXPLICIT, ("free",), ("implicit-damping-euler",))
    ]
    declared = {"free": "implicit-damping-euler"}
    assert name_schemes(tied, declared)[0].scheme == "implicit-damping-euler"
    assert name_schemes({"free": [], "damped": [EXPLICIT]}, nothing) == [
        Naming(None, ("free",)),
        Naming(EXPLICIT, ("damped",)),
    ]
