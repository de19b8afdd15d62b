"""The checks that a baseline adds, one for each run and each scenario, and what a change means."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from omegadot.commands.check.baseline import OF_A_SCENARIO, Change, changes
from omegadot.commands.check.baseline_file import Baseline, Figures, RunKey, ScenarioFigures
from omegadot.commands.check.result import PASSED, Check, Result, Subject, sweeps_of
from omegadot.gates.case import Case, knobs_of
from omegadot.reports.text.numbers import listed, short

GATE = "baseline"
MOST_LISTED = 3
UPDATE = "look at it, then accept it with --update-baseline"
# Another order of accuracy moves an error by more than this; another setting seldom does.
ANOTHER_INTEGRATOR = 10.0
TRANSLATION = {"position", "linear_momentum", "energy"}


def _of_a_scenario(found: Sequence[Change]) -> str:
    channels = {change.name.split()[1] for change in found}
    if any(change.name.startswith("equation") for change in found):
        if "omega_dot" in channels:
            return "the equation of motion changed: omega-dot differs at identical states"
        part = "inverse dynamics" if "torque" in channels else "the acceleration of the body"
        return f"the equation changed: {part} differs at identical states"
    if "model" in channels:
        return "the engine holds another mass, centre of mass or inertia than before"
    return "states that are read back changed: in their frame or reference point"


def _of_a_run(found: Sequence[Change]) -> str:
    by_channel = {change.name.split()[0]: change for change in reversed(found)}
    if set(by_channel) <= TRANSLATION:
        return (
            "the step of the translation changed (its reference point, or its rule); that of the "
            "rotation did not"
        )
    if "omega" not in by_channel:
        return "the update of the attitude changed, that of omega did not"
    factor = by_channel["omega"].factor
    if math.isnan(factor):
        return "the run diverges, or no longer does"
    if not 1.0 / ANOTHER_INTEGRATOR < factor < ANOTHER_INTEGRATOR:
        how = f"grew {short(factor)}x" if factor > 1.0 else f"shrank {short(1.0 / factor)}x"
        how = how if 0.0 < factor < math.inf else "vanished or appeared"
        return f"the integrator changed (the error of omega {how})"
    return (
        "it is stepped by another scheme of the same order, or a default changed, such as a "
        "tolerance, a damping or a limit"
    )


def meaning(was: Figures, now: Figures, found: Sequence[Change], same_version: bool) -> str:
    """The likeliest reason for some changes, in one clause."""
    if was.scheme != now.scheme and was.scheme:
        message = (
            f"the integrator changed: declared {was.scheme} then, {now.scheme or 'nothing'} now"
        )
    elif any(change.name.split()[0] in OF_A_SCENARIO for change in found):
        message = _of_a_scenario(found)
    else:
        message = _of_a_run(found)
    if same_version:
        return f"{message}; the version is the same, so look at the build or the adapter"
    return message


def baseline_checks(
    subject: Subject, cases: Sequence[Case], stored: Baseline | None
) -> Iterator[Check]:
    """A check for every run there is and for every one that the baseline remembers."""
    stepped = subject.integrators if subject.name != "exact" else ()
    whole = set(subject.declared) <= set(subject.integrators)
    for case in cases:
        keys = [RunKey()]
        for name in stepped:
            finest = min(sweeps_of(subject, name, case), key=lambda sweep: sweep.knob)
            keys.append(RunKey(name, **knobs_of(finest)))
        if stored is not None and case.name in stored:
            # An integrator that is gone belongs to what is checked, unless some are left out.
            known = stored[case.name].runs
            keys += [k for k in known if whole or k.integrator in ("", *subject.integrators)]
        for key in dict.fromkeys(keys):
            own = {"timestep": key.timestep, "accuracy": key.accuracy}
            yield Check(subject.name, case.name, GATE, key.integrator or None, **own)


def _advice(failing: Sequence[str]) -> str:
    if not failing:
        return UPDATE
    fails = "gate fails" if len(failing) == 1 else "gates fail"
    return f"the {listed(failing)} {fails} here too, so mend that first; do not store these values"


def compare(
    check: Check,
    stored: Baseline | None,
    now: ScenarioFigures | None,
    version: str,
    failing: Sequence[str] = (),
) -> Result:
    """Compare the figures of one run or one scenario with those that are stored.

    failing: the gates that this run or scenario fails. Its new figures are not to be stored then,
    and what the change means is not guessed.
    """
    key = RunKey(check.integrator or "", check.timestep, check.accuracy)
    own = now.runs.get(key) if now else None
    was = stored.get(check.scenario) if stored is not None else None
    known = was.runs.get(key) if was is not None else None
    if known is None or was is None:
        if own is None:
            return Result("skip", "no values, and none are stored")
        return Result("fail", "no values are stored for this; write them with --update-baseline.")
    versions = f"{check.engine} {was.version} -> {version}"
    advice = _advice(failing)
    if own is None:
        gone = f"values are stored of {check.engine} {was.version}, and {version} gives none"
        return Result("fail", f"{gone}: {advice}.")
    found = changes(known, own)
    if not found:
        return PASSED
    shown = "; ".join(change.sentence for change in found[:MOST_LISTED])
    more = f"; and {len(found) - MOST_LISTED} more" if len(found) > MOST_LISTED else ""
    # A gate that fails has a cause of its own, and needs no guess besides.
    why = "" if failing else f" Probably {meaning(known, own, found, was.version == version)}."
    return Result("fail", f"{versions}: {shown}{more}.{why} {advice[0].upper()}{advice[1:]}.")
