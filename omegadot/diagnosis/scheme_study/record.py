"""A study as plain data: what is printed as JSON, and what the tables are made of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from omegadot.diagnosis.scheme_study.one_step import NAMED
from omegadot.diagnosis.scheme_study.orders import Observed
from omegadot.diagnosis.scheme_study.probes import PROBES
from omegadot.diagnosis.scheme_study.study import EngineStudy, IntegratorStudy, ProbeStudy

SCHEMA = 1
Record = dict[str, Any]


def record_of(studies: Sequence[EngineStudy]) -> Record:
    """The whole study. defect_angle: rad, the step whose defect is reported."""
    return {
        "schema": SCHEMA,
        "defect_angle": NAMED,
        "probes": [{"kind": probe.kind, "shows": probe.shows} for probe in PROBES],
        "engines": [_engine(study) for study in studies],
    }


def _engine(study: EngineStudy) -> Record:
    return {
        "name": study.name,
        "version": study.version,
        "outcome": study.answer.outcome,
        "reason": study.answer.reason,
        "integrators": [_integrator(integrator) for integrator in study.integrators],
    }


def _integrator(study: IntegratorStudy) -> Record:
    return {
        "name": study.name,
        "schemes": [vars(naming) for naming in study.namings],
        "departures": study.departures,
        "probes": {kind: _probe(probe) for kind, probe in study.probes.items()},
    }


def _probe(study: ProbeStudy) -> Record:
    return {
        "outcome": study.answer.outcome,
        "reason": study.answer.reason,
        "declared": study.declared,
        "as_declared": study.as_declared,
        "matches": [vars(match) for match in study.matches],
        "orders": {
            channel: {"declared": o.declared, "verdict": o.verdict, **_observed(o.observed)}
            for channel, o in study.orders.items()
        },
        "defects": {
            channel: {"value": defect.value, **_observed(defect.observed)}
            for channel, defect in study.defects.items()
        },
    }


def _observed(observed: Observed) -> Record:
    return {"kind": observed.kind, "order": observed.order}
