"""What acts in each step: the part of each term that makes a scheme come to the next sample.

A run is stepped on from every sample by a known scheme. Where that misses the next sample, one term
of the equation is given a factor of its own in each interval, the share ``alpha_k``, by which it
does not. A term that one mistake changes explains all intervals of all runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.operators.operands import gyroscopic
from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import damping_torque, gravity_torque
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

# By name the parts of the equation that it consists of, and the channel in which it shows first.
TERMS: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "the applied torque in body axes": (("body",), ("omega",)),
    "the applied torque in world axes": (("world",), ("omega",)),
    "the applied torque": (("body", "world"), ("omega",)),
    "the damping": (("damping",), ("omega",)),
    "the gyroscopic term": (("gyroscopic",), ("omega",)),
    "the torque of gravity": (("moment",), ("omega",)),
    "gravity": (("moment", "force"), ("omega", "velocity")),
    "every load": (("body", "world", "damping", "moment", "force"), ("omega", "velocity")),
    "omega-dot": (("body", "world", "damping", "moment", "gyroscopic"), ("omega",)),
    "the attitude's turn": (("turn",), ("attitude",)),
    "the position's move": (("move",), ("position",)),
}
PARTS = ("body", "world", "damping", "moment", "gyroscopic", "force", "turn", "move")
LEFT = 0.03  # of a defect, at most: within an interval a share may vary
DELTA = 1e-3
TRIES = 4
SETTLED = 1e-5
TINY = 1e-300
UNCLEAR, MOST_UNCLEAR = 0.2, 3  # of single steps, in which a share may change
LARGE = 0.2  # of omega: a defect is no longer in proportion
FAINT = 10.0 * SLACK  # what may be rounding of more than one interval
KNOWN = 0.1  # how well a share must be known to count


@dataclass(frozen=True)
class Shares:
    """The factor of one term in each interval of a run: share (m,), known to within open (m,).

    explained: (m,), where that leaves nothing; elsewhere the share may change within the interval.
    beyond: (m,), where it leaves something of a defect as large as the motion, which is no mean.
    """

    run: KeptRun
    share: Array
    open: Array
    explained: NDArray[np.bool_]
    beyond: NDArray[np.bool_]

    @property
    def used(self) -> NDArray[np.bool_]:
        """(m,): where the term moves enough for its share to be known, or explains nothing."""
        known = self.open < KNOWN * np.maximum(1.0, np.abs(self.share))
        return np.asarray((known | ~self.explained) & ~self.beyond)


def shares_of(run: KeptRun, by: SchemeOf) -> dict[str, Shares]:
    """The terms of which each explains the intervals of a run, with their shares.

    Empty where none does. A run without a defect has shares of one.
    """
    with np.errstate(all="ignore"):
        return _shares(run, by)


def _shares(run: KeptRun, by: SchemeOf) -> dict[str, Shares]:
    own = SchemeOf(by.scheme, canonical(run.system, by.coordinates))
    if own.coordinates not in own.scheme.coordinates:
        return {}
    names, count, m = list(TERMS), len(TERMS), len(run.lengths)
    holds = np.array([[part in TERMS[n][0] for part in PARTS] for n in names], dtype=float)
    shows = np.array([[c in TERMS[n][1] for c in CHANNELS] for n in names], dtype=float)

    def off(alpha: Array) -> tuple[dict[str, Array], Array]:
        """By how far the samples are missed, and that in parts of the bounds where it shows."""
        factors = 1.0 + holds[:, None, :] * (alpha[..., None] - 1.0)
        by_part = dict(zip(PARTS, np.moveaxis(factors, -1, 0)[..., None], strict=True))
        motion = with_factors(run.system, own, by_part)
        apart = run.apart(run.ends(own, motion, count))
        lines = [
            shows[:, k, None, None] * apart[c] / np.maximum(run.bounds[c], TINY)[:, None]
            for k, c in enumerate(CHANNELS)
        ]
        return apart, np.concatenate(lines, axis=-1)

    alpha = np.ones((count, m))
    first, start = off(alpha)
    apart, here, defect = first, start, norm(start)
    size: Array = np.zeros((count, m))
    for _ in range(TRIES):
        slope = (off(alpha + DELTA)[1] - here) / DELTA
        size = norm(slope)
        acts = np.maximum(size, defect) > SLACK / KNOWN
        moved = -np.sum(slope * here, axis=-1) / size**2
        moved = np.where(np.isfinite(moved) & acts, moved, 0.0)
        alpha = alpha + moved
        apart, here = off(alpha)
        if np.max(np.abs(moved)) < SETTLED:
            break
    left = norm(here)
    explained = left <= np.maximum(SLACK, LEFT * defect)
    explained |= defect <= FAINT
    explained &= _others_follow(run, names, first, apart)
    clear = defect > FAINT
    opened = np.where(size > 0.0, (SLACK + left) / size, np.inf)
    beyond = ~explained & (_large(run, first) | ~np.isfinite(left))
    unclear = ~explained & ~beyond
    most = max(MOST_UNCLEAR, int(UNCLEAR * m)) if run.sweep.every == 1 else m
    return {
        name: Shares(run, alpha[k], opened[k], explained[k], beyond[k])
        for k, name in enumerate(names)
        if np.all(explained[k] | (size[k] > FAINT))
        and (np.any(clear[k] & ~beyond[k]) or not np.any(clear[k]))
        and np.count_nonzero(unclear[k]) <= most
    }


def _large(run: KeptRun, first: dict[str, Array]) -> NDArray[np.bool_]:
    """(terms, m): whether an interval misses its sample by as much as the body turns there."""
    w = norm(run.state.angular_velocity)
    least = LARGE * np.maximum(w[:-1], w[1:])
    turn = LARGE * np.minimum(1.0, least * run.lengths)
    return np.asarray((norm(first["omega"]) > least) | (norm(first["attitude"]) > turn))


def _others_follow(
    run: KeptRun, names: Sequence[str], first: dict[str, Array], apart: dict[str, Array]
) -> NDArray[np.bool_]:
    """(terms, m): whether what is left in other channels may come of a share that varies.

    A share that goes from nothing to its double within an interval has the right mean, and moves
    what follows by as much as an interval's length times the defect.
    """
    length, pivoted = run.lengths, run.system.load.pivot is not None
    w = run.state.angular_velocity
    brisk = float(np.max(norm(w))) + float(np.max(norm(np.diff(w, axis=0))))
    arm = float(norm(run.system.body.center_of_mass))
    rows = list[NDArray[np.bool_]]()
    for k, name in enumerate(names):
        shown = TERMS[name][1]
        omega, turn, velocity, _ = (norm(first[c][k]) for c in CHANNELS)
        spun, turned, pushed = ("omega" in shown, "attitude" in shown, "velocity" in shown)
        allowed = {
            "omega": brisk * turn * turned,
            "attitude": length * omega * spun,
            "velocity": arm * omega * spun,
            "position": length * velocity * pushed + arm * length * omega * spun,
        }
        row = np.ones(len(length), dtype=bool)
        for c in CHANNELS[: 2 if pivoted else 4]:
            if c not in shown:
                row &= norm(apart[c][k]) <= np.maximum(SLACK * run.bounds[c], allowed[c])
        rows.append(row)
    return np.stack(rows)


def with_factors(system: System, by: SchemeOf, factors: Mapping[str, Array]) -> Motion:
    """A body's motion with a factor (lanes, m, 1) on each part of its equation."""
    back, load = inverse(moving_inertia(system)), system.load

    def acceleration(state: State) -> Acceleration:
        torque = factors["gyroscopic"] * gyroscopic(system, state)
        if np.any(load.torque_body):
            torque = torque + factors["body"] * load.torque_body
        if np.any(load.torque_world):
            torque = torque + factors["world"] * rotate_inverse(
                state.orientation, load.torque_world
            )
        if np.any(load.damping):
            torque = torque + factors["damping"] * damping_torque(system, state)
        if load.pivot is not None and np.any(load.gravity):
            torque = torque + factors["moment"] * gravity_torque(system, state)
        linear = factors["force"] * load.gravity + 0.0 * state.angular_velocity
        return Acceleration(apply(back, torque), linear)

    def moved(vector: Array) -> Array:
        scaled = np.array(vector)
        scaled[..., -3:] *= factors["turn"]
        scaled[..., :-3] *= factors["move"]
        return scaled

    motion = motion_over(system, by.coordinates, acceleration)
    return replace(
        motion,
        retract=lambda q, u: motion.retract(q, moved(u)),
        coordinate_rate=lambda q, v: motion.coordinate_rate(q, moved(v)),
    )
