"""Causes in inverse dynamics that hold on all scenarios of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.evidence import SLACK, Evidence
from omegadot.diagnosis.equations.hypotheses import hypotheses, wrong_form
from omegadot.diagnosis.equations.hypotheses.unsymmetric import of_whole
from omegadot.diagnosis.equations.wrong_torque import fitting_torques, plainest, would_show
from omegadot.diagnosis.wording.features import Features, surely_only_where
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import inverse_dynamics
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

SOLVED, MULTIPLIED = "where omega-dot is solved for", "where it multiplies omega-dot"


class WrongInverse:
    """The evidence of inverse dynamics so far, by scenario, and what fits each."""

    def __init__(self) -> None:
        self._evidence: dict[str, Evidence] = {}
        self._features: dict[str, Features] = {}
        self._fits: dict[str, list[str]] = {}
        self._forms: list[str] | None = None

    def add(self, name: str, evidence: Evidence, features: Features) -> None:
        """Of one more scenario."""
        self._evidence[name], self._features[name], self._forms = evidence, features, None

    def causes(self, name: str) -> list[str]:
        """What explains this scenario and every other that fails; what fits this one, else.

        A term of the torque, or the equation with one thing wrong, turned about.
        """
        own = self._of(name)
        failing = [other for other, one in self._evidence.items() if one.clear]
        common = [text for text in own if all(text in self._of(other) for other in failing)]
        if not common:
            if self._forms is None:
                with np.errstate(all="ignore"):
                    self._forms = _forms([one for one in self._evidence.values() if one.finite])
            common = self._forms
        found = plainest(common or own)
        against = {text: self._against(text) for text in found}
        # what no sound scenario is against comes first
        found = [text for text in found if not against[text]] or [
            self._where(text, against[text]) for text in found
        ]
        return either(found) if len(found) <= MOST_NAMED else []

    def _against(self, text: str) -> list[str]:
        """The scenarios that are right, and would show it."""
        sound = [(name, one) for name, one in self._evidence.items() if np.all(one.sound)]
        return [
            name
            for name, one in sound
            if would_show(text, one.system, one.states, one.true, one.eps)
        ]

    def _where(self, text: str, against: Sequence[str]) -> str:
        """A cause with the scenarios on which alone it is so, or how many do not show it."""
        shown = [self._features[name] for name in self._evidence if text in self._of(name)]
        found = surely_only_where(text, shown, [self._features[name] for name in against])
        others = "other" if len(against) == 1 else "others"
        return found or f"{text}, not on {len(against)} {others} that would show it"

    def _of(self, name: str) -> list[str]:
        if name not in self._fits:
            one = self._evidence[name]
            torque = inverse_dynamics(one.system, one.states, one.true)
            torque = torque + apply(moving_inertia(one.system), _off(one))
            self._fits[name] = fitting_torques(one.system, one.states, one.true, torque, one.eps)
        return self._fits[name]


def _off(evidence: Evidence) -> Array:
    """(n, 3): by how much omega-dot would be another, by the error of the torque."""
    return np.asarray(evidence.found.angular - evidence.true.angular)


def _forms(every: Sequence[Evidence]) -> list[str]:
    """The equations with one thing wrong whose torques are the engine's on all scenarios."""
    wrong = [one for one in every if one.clear]
    if not wrong:
        return []
    left: list[str] | None = None
    for one in (*wrong, *(other for other in every if not other.clear)):
        known = _wrong_forms(one.system)
        fits = [text for text, form in known.items() if np.all(is_of_torque(one, form))]
        # where a hypothesis has no meaning, or makes no difference, it is as right as the equation
        absent = [] if one.clear or left is None else [t for t in left if t not in known]
        left = [t for t in (fits if left is None else left) if t in {*fits, *absent}]
        if not left:
            return []
    kept = left or []
    alike = {of_whole(text) for text in kept if of_whole(text) != text}  # on free bodies alone
    plain = [text.removeprefix("in the dynamics, ") for text in kept if text not in alike]
    return [f"in inverse dynamics, {text.replace(SOLVED, MULTIPLIED)}" for text in plain]


def _wrong_forms(system: System) -> Mapping[str, Form]:
    right = form_of(system)
    made = {one.text.strip(): wrong_form([one], system, right) for one in hypotheses(system)}
    known = {text: form for text, form in made.items() if form is not None}
    if np.array_equal(moving_inertia(system), system.body.inertia):
        known |= {of_whole(text): form for text, form in known.items()}
    return known


def is_of_torque(evidence: Evidence, form: Form) -> NDArray[np.bool_]:
    """(n,): whether ``solve^-1 a + omega x (spin omega) - arm x weight`` is what is answered."""
    states, requested = evidence.states, evidence.true.angular
    w = states.angular_velocity
    weight = rotate_inverse(states.orientation, form.weight) + form.weight_body
    made = apply(np.linalg.inv(form.solve), requested) + cross(w, apply(form.spin, w))
    made = made - cross(form.arm, weight)
    true = inverse_dynamics(evidence.system, states, evidence.true)
    off = apply(inverse(moving_inertia(evidence.system)), made - true)
    return np.asarray(norm(_off(evidence) - off) <= SLACK * evidence.angular_bound)
