"""What is declared of MuJoCo's integrators, version by version, without those versions."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from omegadot.adapters.mujoco.integrators import (
    Case,
    declared_integrators,
    integrator_flag,
    version_of,
)
from omegadot.adapters.protocol import Integrator
from omegadot.reference_impl.schemes import SCHEMES

OLD = SimpleNamespace(
    mjtIntegrator=SimpleNamespace(
        mjINT_EULER=0, mjINT_RK4=1, mjINT_IMPLICIT=2, mjINT_IMPLICITFAST=3
    )
)
NEW = SimpleNamespace(mjtIntegrator=SimpleNamespace(**vars(OLD.mjtIntegrator), mjINT_DISCRETE=4))

EXPLICIT, DAMPED = "semi-implicit-euler", "implicit-damping-euler"
IMPLICIT = "linearly-implicit-euler"
MIDPOINT, OFF_ORIGIN = "frozen-torque-midpoint", "body-axes-midpoint"


def declared(case: Case, engine: SimpleNamespace = NEW) -> dict[str, Integrator]:
    return {integrator.name: integrator for integrator in declared_integrators(engine, case)}


def test_version_of() -> None:
    assert version_of("3.8.1") == (3, 8, 1)
    assert version_of("4.0.0.dev12") == (4, 0, 0)
    assert version_of("3.7.0") < (3, 8, 1) < version_of("3.10.0")


def test_integrators_are_taken_by_name() -> None:
    assert integrator_flag(NEW, "discrete") == 4
    assert integrator_flag(OLD, "discrete") is None
    assert integrator_flag(OLD, "no such") is None
    assert list(declared(Case((3, 6, 0)), OLD)) == ["Euler", "RK4", "implicit", "implicitfast"]


@pytest.mark.parametrize(
    ("version", "implicit", "fast"),
    [
        ((3, 6, 0), IMPLICIT, EXPLICIT),
        ((3, 7, 0), MIDPOINT, MIDPOINT),
        ((3, 8, 0), MIDPOINT, MIDPOINT),
        ((3, 8, 1), IMPLICIT, MIDPOINT),
        ((3, 10, 0), IMPLICIT, MIDPOINT),
        ((3, 11, 0), IMPLICIT, IMPLICIT),
        ((4, 0, 0), IMPLICIT, IMPLICIT),
    ],
)
def test_free_bodies_by_version(version: tuple[int, ...], implicit: str, fast: str) -> None:
    found = declared(Case(version))
    assert (found["implicit"].scheme, found["implicitfast"].scheme) == (implicit, fast)
    off = declared(Case(version, offset=True))
    for name, scheme in (("implicit", implicit), ("implicitfast", fast)):
        assert off[name].scheme == (OFF_ORIGIN if scheme == MIDPOINT else scheme)
    if fast == MIDPOINT:
        assert found["implicitfast"].orders["omega"] == 2
        assert declared(Case(version, damped=True))["implicitfast"].orders["omega"] == 1
        assert declared(Case(version, turns_torque=True))["implicitfast"].orders["attitude"] == 1
        assert "ω_m" in found["implicitfast"].note


@pytest.mark.parametrize("version", [(3, 6, 0), (3, 7, 0), (3, 17, 0), (4, 0, 0)])
def test_pivoted_bodies_have_explicit_gyroscopic_terms_but_under_implicit(
    version: tuple[int, ...],
) -> None:
    bare, damped = declared(Case(version, pivoted=True)), declared(Case(version, True, damped=True))
    for name in ("implicitfast", "discrete"):
        assert (bare[name].scheme, damped[name].scheme) == (EXPLICIT, DAMPED)
    assert bare["implicit"].scheme == damped["implicit"].scheme == IMPLICIT


def test_damping_of_euler_depends_on_the_setup() -> None:
    version = (4, 0, 0)
    assert declared(Case(version, damped=True))["Euler"].scheme == EXPLICIT
    assert declared(Case(version, damped=True, euler_damps=True))["Euler"].scheme == DAMPED
    assert declared(Case(version, euler_damps=True))["Euler"].scheme == EXPLICIT


def test_rk4_by_version() -> None:
    new = declared(Case((4, 0, 0)))["RK4"]
    assert (new.scheme, set(new.orders.values())) == ("munthe-kaas-rk4", {4})
    old = declared(Case((3, 17, 0)))["RK4"]
    assert old.scheme == "lie-rk4-naive"
    assert (old.orders["omega"], old.orders["energy"], old.orders["attitude"]) == (4, 4, 2)
    assert declared(Case((3, 17, 0), offset=True))["RK4"].orders["energy"] == 2
    assert declared(Case((3, 17, 0), turns_torque=True))["RK4"].orders["omega"] == 2


def test_declared_schemes_exist() -> None:
    for version in ((3, 6), (3, 7), (3, 17), (4, 0)):
        for damped in (False, True):
            for integrator in declared(Case(version, damped=damped, euler_damps=True)).values():
                assert integrator.scheme is None or integrator.scheme in SCHEMES
                assert set(integrator.orders) == set(SCHEMES[EXPLICIT].orders)
