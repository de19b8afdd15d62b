"""The terms of the report, defined once: for the page's own glossary and for docs/glossary.md."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass

from markupsafe import Markup, escape

INTRODUCTION = (
    "The report's headings link to these terms. Omega is the angular velocity and omega-dot the "
    "angular acceleration. `h` is the time step, `n` the number of steps, `eps` is 2⁻⁵²."
)


@dataclass(frozen=True)
class Term:
    """name: as headings use it.  text: two sentences.  formula: or unit, of the quantity.

    also: other forms by which a heading refers to it.
    """

    name: str
    text: str
    formula: str
    also: tuple[str, ...] = ()

    @property
    def anchor(self) -> str:
        """Its address, in the document and behind ``term-`` in the page."""
        return self.name.lower().replace(" ", "-")


# Of each term its name, with other forms of it in parentheses; then its text; then, behind =, its
# formula or unit.
_TEXT = """
as shipped
The table of this name puts engines with all their defaults beside the same in the setup physics, on
the T-handle where that is run, at the middle step or accuracy. What mends most is the setting, in
the engine's own words, that leaves the smallest mean attitude error where it alone is mended.
= Formula: mean attitude error with the setting / that without; none where no ratio is below 0.995

cluster (clusters, identical trajectories)
Runs of one scenario and step whose omega and attitude are the same within the round-off bound,
whatever scheme they declare. Their agreement is not independent evidence that they are right.
= Formula: |difference| ≤ round-off bound, in omega and in attitude

companion
The run of the reference with the scheme that an engine declares, from the same start and with the
same steps. What is left between the engine and its companion is not explained by the scheme.
= Unit: that of the state

consistent
An error is consistent where it shrinks with the step at the declared order or faster, and the
difference from the companion does too. It is then a discretisation error and passes.
= Formula: observed order ≥ declared order − 0.15

declared exception (declared exceptions)
A failure that is known and listed in a file, with its reason and a link. It is counted apart from
passes and failures.
= Value: the verdict `declared`

defect (defects)
The error of a single step from an exact state (local truncation error). Its order is one more than
that of the error that accumulates over a run.
= Formula: |x₁ − x(h)| ∝ hᵖ⁺¹, for a scheme of order p

divergence (diverges)
A run diverges at the first sample whose attitude is more than 1° from the exact one. The outcome
diverged is different: the state is no longer finite.
= Unit: s

exact solution (exact solutions)
The motion that every run is compared with: a closed form where one is known, otherwise a Taylor
series of the same equations in extended precision. It never comes from another engine.
= Values: closed-form, series

explained (source of error)
An error is explained where the engine and its companion reach the same states within the round-off
bound. The error is then the truncation error of the declared scheme, and passes.
= Formula: |engine − companion| ≤ round-off bound

flip (flips, flip time)
The body turns over: omega along the axis of middle inertia changes its sign. The error of a flip is
the difference of its time from the exact one.
= Unit: s

flips in time (flips late, flips early, never flips)
Where no torque acts, a flip counts that leads H from within 45° of the axis of middle inertia to
within 45° of its opposite, so that a wobble is none. The middles between the exact flips part the
time, and a run flips in time where each part has one flip of its own, late or early by the first
that has not, and without any it never flips.
= Values: never, late, early or yes, one a run

floor
How far a perfect answer in double precision may be from the exact solution (in single precision
2²⁹ times as far), because the inputs are rounded and the motion magnifies that. An error below the
floor is not judged.
= Unit: that of the error, so rad, rad/s, m, or relative

gate (gates)
One of the six questions asked of an engine: model, equation, scheme, invariants, trajectory and
cost. Five are judged, by bounds that follow from physics and floating point; the cost of a step is
measured and not judged.
= Formula: value ≤ bound

growth
The largest factor by which the motion magnifies a small deviation before time t. It is about 1 for
simple motions and very large near a separatrix.
= Formula: growth(t) = max over s ≤ t of |M(t) M(s)⁻¹|, with M the state-transition
  matrix of the linearised motion

invariants (drift)
Energy, angular momentum and linear momentum. Where a load acts they change, and their exact values
over time are what a run must follow; the difference is the drift.
= Unit: none, relative to the largest value of the exact motion

order (orders, convergence)
The power of the step with which the error of a scheme shrinks. The observed order is the slope of
log error over log step between the finest steps.
= Formula: error ∝ hᵖ

outcome (what ran)
How a run ended: ok, unsupported, not-installed, diverged, raised, crashed, timeout or interrupted.
Every outcome except ok has its reason and is never counted as a pass.
= Values: those named above, one a run

Pareto front
The runs that no other run beats in both cost and error. A user who wants a given accuracy at the
lowest cost picks one of them.
= Units: s of wall time per simulated second, and rad

reference
The project's own code of the Newton–Euler equations and of every scheme. It also runs as the engine
`reference`; the engine `exact` is the exact solution.
= Formula: ω̇ = I⁻¹ (τ − ω × I ω)

residual
The difference between the engine's omega-dot and that of the Newton–Euler equations at one
identical state. No time stepping is involved, so a sound engine stays within a few roundings, also
after another system was loaded, or a similar one, which differs in one number.
= Formula: J |ω̇ − ω̇_ref| / S ≤ 64 eps J / λ; S: sizes of the terms of equation (8), J and λ: largest
  and smallest inertia

round-off bound
How far rounding alone can take a run away from what its scheme gives in exact arithmetic. It counts
the roundings of each step and multiplies them by the growth.
= Formula: 16 eps (n + 1) (1 + h A / rate) growth(t), with A the largest |ω̇| and rate the largest
  |ω|; rad in attitude, relative to the rate in omega; eps is 2⁻⁵², in single precision 2⁻²³

scheme (schemes)
The formula by which an integrator computes the next state from the present one. The reference has
each scheme in plain code, and the scheme gate compares an engine with it step by step.
= Formula: for example ω ← ω + h ω̇, then q ← q exp(h ω)

separatrix
The motions that tend to a spin about the axis of middle inertia, or to an upright top. Close to
them a small deviation grows exponentially, and so do rounding errors.
= Formula: growth ≫ 1

setup (settings, switched off)
How an engine is configured for a run. In physics, defaults that disturb the motion (sleeping,
contacts, implicit damping) are switched off; as-shipped leaves all defaults.
= Values: physics, as-shipped

verdict (verdicts)
The result of a gate: pass, fail, declared (a declared exception) or info (measured and not judged).
The verdict of a scenario is the worst one of its runs.
= Values: those named above, one a gate and run

whole inertia
The inertia that the equation of rotation has: of a pivoted body about the pivot, which is its own
about the centre of mass and what the parallel-axis theorem adds. Of a free body it is the inertia
about the centre of mass.
= Formula: I + m (|c|² 1 − c cᵀ), with c from the pivot to the centre of mass; kg m²
"""


def _terms() -> Iterator[Term]:
    for entry in _TEXT.strip().split("\n\n"):
        head, rest = entry.split("\n", 1)
        name, _, also = head.rstrip(")").partition(" (")
        text, formula = (" ".join(part.split()) for part in rest.split("\n= "))
        yield Term(name, text, formula, tuple(filter(None, also.split(", "))))


TERMS = tuple(_terms())


def terms_in(heading: str) -> list[Term]:
    """The terms that a heading uses, in their order there, not as parts of longer terms."""
    found = {}
    for term in TERMS:
        names = "|".join(re.escape(name) for name in (term.name, *term.also))
        place = re.search(rf"(?<![\w-])(?:{names})(?![\w-])", heading, re.IGNORECASE)
        if place:
            found[place.span()] = term
    longest = [a for a in found if not any(b[0] <= a[0] < a[1] <= b[1] for b in found if b != a)]
    return [found[span] for span in sorted(longest)]


def linked(heading: str) -> Markup:
    """A heading of the page, followed by a link to the glossary for each term in it."""
    links = [
        Markup('<a class="term" href="#term-{0}" aria-label="Glossary: {1}">?</a>').format(
            term.anchor, term.name
        )
        for term in terms_in(heading)
    ]
    return Markup(" ").join([escape(heading), *links])


def glossary_markdown() -> str:
    """docs/glossary.md: the same terms, texts and anchors as in the page."""
    head = (
        "# Glossary\n\n"
        "<!-- Made by a command. Do not edit; run it again:\n"
        "python -m omegadot.reports.page.glossary > docs/glossary.md -->\n\n"
        f"{_wrapped(INTRODUCTION)}\n"
    )
    entries = [
        f"\n## {term.name}\n\n{_wrapped(term.text)}\n\n{_wrapped(f'*{term.formula}*')}\n"
        for term in TERMS
    ]
    return head + "".join(entries)


def _wrapped(text: str) -> str:
    return textwrap.fill(text, 100, break_long_words=False, break_on_hyphens=False)


if __name__ == "__main__":
    print(glossary_markdown(), end="")
