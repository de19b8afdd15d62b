"""On which scenarios a step ends wrongly, has a slip in it, or is of another scheme.

On which alone, where others would show it; and whether what is named on others makes the runs of
one on which nothing is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT, scheme_named
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, scheme_of
from omegadot.diagnosis.stepping.loads.whole_substeps import scheme_of_substeps
from omegadot.diagnosis.stepping.slips.other_schemes import ENDS
from omegadot.diagnosis.stepping.slips.slips import slipped
from omegadot.diagnosis.stepping.step_ends import kept_ends, with_end
from omegadot.diagnosis.wording.features import Features, in_common
from omegadot.diagnosis.wording.kinds import AT_STEPS, EITHER, OR
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.system import System

OF_SLIP = re.compile("it is stepped by (.+?), but (.+)")
OF_OTHER = re.compile(r"it is stepped by ([^,]+?), (?:though .+ is declared|which is of order .+)")
OF_NUMBERS = re.compile(r" \(.+; other numbers on \d+ more\)$")

FINEST = "lie-rk4"  # beside which a scheme of a lower order shows


def where_stepped(
    text: str,
    integrator: Integrator,
    runs: Sequence[KeptRun],
    features: Mapping[str, Features],
) -> str:
    """A cause in every step, with where it acts; as it is where it acts wherever it would show.

    runs: of all scenarios, sound and failing.  A sound run would show it, where steps with it do
    not lead from its samples to the next, and steps without it do.
    """
    plain, mark, tail = text.partition(AT_STEPS)
    failing = {run.name for run in runs if run.fails}
    by, against = scheme_of(integrator, runs), list[str]()
    for name in dict.fromkeys(run.name for run in runs if run.name not in failing):
        longest = max((r for r in runs if r.name == name), key=lambda run: run.sweep.timestep)
        pair = _with_and_without(plain, by, longest.system)
        way = by.coordinates if by is not None else integrator.coordinates
        if pair is None or way not in pair[0].coordinates:
            return text
        with_it, without = (longest.short.sound(SchemeOf(one, way)) for one in pair)
        if not np.all(with_it) and np.all(without):
            against.append(name)
    if not against:
        return text
    shown, others = ([features[n] for n in names if n in features] for names in (failing, against))
    common = in_common(shown, others)
    count = f"{len(against)} other{'s' * (len(against) > 1)}"
    where = f", but only where {' or where '.join(common)}" if 0 < len(common) < 3 else ""
    return f"{plain}{where or f', not on {count} that would show it'}{mark}{tail}"


def makes_runs(text: str, integrator: Integrator, runs: Sequence[KeptRun], name: str) -> bool:
    """Whether steps with what a text names lead from each sample to the next, and others do not.

    runs: of all scenarios, sound and failing.  name: of the one whose runs these are.  Of several
    causes that explain the same, each must.
    """
    by, plain = scheme_of(integrator, runs), OF_NUMBERS.sub("", text.partition(AT_STEPS)[0])
    every = plain.removeprefix(EITHER).split(OR) if plain.startswith(EITHER) else [plain]
    own = [run for run in runs if run.name == name]
    return all(_makes(one, by, integrator, own) for one in every)


def _makes(text: str, by: SchemeOf | None, integrator: Integrator, runs: Sequence[KeptRun]) -> bool:
    shown = False
    for run in runs:
        way = canonical(run.system, by.coordinates if by else integrator.coordinates)
        pair = _with_and_without(text, by, run.system) or _other(text, by)
        if pair is None or way not in pair[0].coordinates:
            return False
        if not np.all(run.sound(SchemeOf(pair[0], way))):
            return False
        shown |= run.fails and not np.all(run.sound(SchemeOf(pair[1], way)))
    return shown


def _other(text: str, by: SchemeOf | None) -> tuple[Scheme, Scheme] | None:
    """Another scheme than is declared or due, or its substeps, beside what it is not."""
    found = OF_OTHER.fullmatch(text)
    if found is None or found[1] not in {**SCHEMES, **EXPLICIT}:
        return scheme_of_substeps(text)
    due = by.scheme if by is not None and by.scheme.name != found[1] else None
    return scheme_named(found[1]), due or scheme_named(FINEST)


def _with_and_without(
    text: str, by: SchemeOf | None, system: System
) -> tuple[Scheme, Scheme] | None:
    """The scheme with what the text names in every step, and as it is; None of another cause."""
    slip = OF_SLIP.fullmatch(text)
    if slip is not None:
        known = slipped(slip[1]).get(slip[2])
        return None if known is None else (known, scheme_named(slip[1]))
    end = (ENDS | kept_ends(system)).get(text)
    if end is None or by is None:
        return None
    return with_end(by.scheme, end), by.scheme
