"""A choice as plain tables, lists and numbers: what is printed, drawn and stored."""

from __future__ import annotations

from omegadot.commands.choose.case_document import CaseDocument
from omegadot.commands.choose.chooser import Choice
from omegadot.commands.choose.eligible import python_note
from omegadot.commands.choose.ranking import ranked, total
from omegadot.commands.choose.requirements import ACCURACY
from omegadot.commands.choose.trial import Row

SCHEMA = 1


def engine_rows(choice: Choice) -> list[Row]:
    """Every engine: what it is, or why it did not start."""
    rows: list[Row] = []
    for engine in choice.engines.started:
        own = engine.description
        rows.append(
            {"name": engine.name, "installed": True, "version": own.version}
            | {"licence": own.licence, "precision": own.precision, "reason": ""}
            | {"integrators": [vars(integrator) for integrator in own.integrators]}
            | {"refused": choice.refused.get(engine.name, [])}
            | {"note": python_note(engine.name, choice.requirements.python)}
            | {"memory": choice.memory.get(engine.name)}
        )
    for missing, answer in choice.engines.missing:
        rows.append(
            {"name": missing.name, "installed": False, "version": "", "integrators": []}
            | {"outcome": answer.outcome, "reason": answer.reason, "refused": [], "note": ""}
        )
    return rows


def document(choice: Choice) -> Row:
    """The whole choice: requirements, engines, cases, and what qualifies in every case."""
    cases = [CaseDocument(choice, found) for found in choice.cases]
    wanted = choice.requirements
    accuracy = [  # limits in SI, next to their text as given and the unit of that
        {"requirement": key, "limit": limit, "unit": ACCURACY[key][1]}
        | {"requested": wanted.requested[key], "shown": wanted.shown(key)}
        for key, limit in wanted.limits.items()
    ]
    others = {k: v for k, v in vars(wanted).items() if k not in ("limits", "requested")}
    return {
        "schema": SCHEMA,
        "kind": "choice",
        "requirements": {"accuracy": accuracy, **others},
        "engines": engine_rows(choice),
        "scenarios": [case.row() for case in cases],
        "everywhere": _everywhere(cases),
        "worker_deaths": [{"engine": name, "how": how} for name, how in choice.engines.deaths()],
    }


def _everywhere(cases: list[CaseDocument]) -> list[Row]:
    """Of several cases: the candidates that qualify in all, by the time they take for all."""
    if len(cases) < 2:
        return []
    costs = [case.qualified() for case in cases]
    names = [name for name in costs[0] if all(name in own for own in costs)]
    totals = {name: total([own[name] for own in costs]) for name in names}
    return [
        {**vars(place), "seconds": totals[place.candidate].row()}
        | {
            f"{name}s": [case.knobs(place.candidate)[knob] for case in cases]
            for name, knob in (("timestep", "timestep"), ("accuracie", "accuracy"))
        }
        for place in ranked(totals)
    ]
