"""Causes in how an answer was requested: alone or with others, again, after another system."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.gates.rows import Row
from omegadot.gates.runs import repeats
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness.drive import CaseResult

# What can make two answers to one request differ, and is seen in nothing else.
AGAIN = {
    "repeated": "the same steps, requested again, give other samples: something is left over from "
    "a run before, depends on how many steps are requested, or is drawn at random",
    "reloaded": "a run depends on the system that was loaded before: something of it is left over, "
    "or the first run after a load is another than those after it",
    "negated": "a run from -q, requested after that from q, gives other samples: the sign of the "
    "first quaternion changes the run, or something is left over from a run before",
}


ONE_ALONE = "one state requested by itself is answered wrongly; the same among others is right"


def again_cause(rows: Sequence[Row]) -> str:
    """Of the failed rows of a run those in which two answers to one request differ; else ""."""
    failed = {row.metric for row in rows if row.verdict == "fail"}
    return next((AGAIN[how] for how in repeats.NOTES if how in failed), "")


QUANTITIES = {
    **{"orientation": "attitude", "angular_velocity": "omega", "position": "position"},
    "linear_velocity": "linear velocity",
}


def kept_causes(states: EvaluationStates, result: CaseResult) -> list[str]:
    """What is read back of the state that was set before the last one."""
    if not result.model.ok:
        return []
    found, last, before = result.model.result["state"], vars(states.random[0]), states.random[1]
    kept = [
        text
        for name, text in QUANTITIES.items()
        if np.allclose(found[name], getattr(before, name), rtol=1e-9, atol=0.0)
        and not np.allclose(last[name], getattr(before, name), rtol=1e-9, atol=0.0)
    ]
    return [f"the {' and the '.join(kept)} read back is that of a state set before"] if kept else []


def batch_cause(failed: set[tuple[str, str]]) -> str:
    """One state by itself and the same among others; failed: the gates and metrics of the rows."""
    together = {"residual", "residual_on_path"} & {metric for _, metric in failed}
    if ("equation", "residual_alone") in failed and not together:
        return ONE_ALONE
    return ""


PLACE = "only the {} of several states that are requested together is answered wrongly"


def is_of_place(text: str) -> bool:
    """Whether a cause is `place_cause`, where nothing more is known of it."""
    return text in {PLACE.format(which) for which in ("first", "last")}


def place_cause(evidence: Evidence) -> str:
    """Where the answer depends on the place among the states that are requested together."""
    wrong, count = np.flatnonzero(~evidence.sound), len(evidence.sound)
    if len(wrong) != 1 or wrong[0] not in (0, count - 1):
        return ""
    which, beside = ("last", -2) if wrong[0] else ("first", 1)
    found = evidence.found.angular
    same = bool(np.array_equal(found[wrong[0]], found[beside]))
    text = PLACE.format(which)
    other = "before" if wrong[0] else "after"
    return f"{text}: its omega-dot is that of the one {other}" if same else text
