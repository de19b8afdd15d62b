"""What is kept of a run until all scenarios of an engine have been looked at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT, scheme_named
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.case import Sweep
from omegadot.gates.truth import Truth
from omegadot.reference_impl.coordinates import Coordinates, distinct
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import normalize, rotation_between
from omegadot.reference_impl.schemes import COMMON, SCHEMES, Motion, Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

MOST_SAMPLES, FEW_SAMPLES = 256, 48  # that are kept, and that are looked at closely
MOST_STEPS = 64  # between two samples
SLACK = 4.0  # the start of an interval is rounded as its end is, and each of a sound run's as well
LEAST = 3  # intervals that show a scheme
MOST_LOOKED_AT = 4  # runs, sound and wrong, in which the scheme of an engine is looked for
MOST_OTHERS = 16  # where these show none
BEGINS = 0.5  # of a run, that its first interval is sound counts as much
HALF_OF_DIGITS = 2.0**-26
CHANNELS = ("omega", "attitude", "velocity", "position")


@dataclass(frozen=True)
class SchemeOf:
    """A scheme, and the coordinates in which it is stepped."""

    scheme: Scheme
    coordinates: Coordinates


@dataclass(frozen=True)
class KeptRun:
    """The first samples of one run: times (n,) s and states (n, ...), and whether it fails.

    bounds: (n - 1,) per channel in rad/s, rad, m/s and m, what rounding may do in an interval.
    """

    name: str
    system: System
    sweep: Sweep
    times: Array
    state: State
    bounds: dict[str, Array]
    fails: bool

    @property
    def first_steps(self) -> NDArray[np.intp]:
        """(n - 1,): the number of the first step of each interval, from 1 on."""
        return self.sweep.sample_steps[: len(self.times) - 1] + 1

    @property
    def lengths(self) -> Array:
        """(n - 1,) s."""
        return np.diff(self.times)

    @property
    def timestep(self) -> float:
        """s, of its steps."""
        return self.sweep.timestep

    @property
    def moves(self) -> bool:
        """Whether every single step after the first changes the state."""
        changes = [np.any(np.diff(f[1:], axis=0), axis=-1) for f in vars(self.state).values()]
        return self.sweep.every == 1 and bool(np.all(np.any(changes, axis=0)))

    @property
    def short(self) -> KeptRun:
        """Its first samples alone."""
        count = FEW_SAMPLES + 1
        bounds = {channel: values[:FEW_SAMPLES] for channel, values in self.bounds.items()}
        return replace(self, times=self.times[:count], state=self.state[:count], bounds=bounds)

    def ends(self, by: SchemeOf, motion: Motion | None = None, lanes: int = 0) -> State:
        """Where a scheme leads from each sample to the next: (n - 1, ...), or lanes in front."""
        every, start = self.sweep.every, self.state[:-1]
        fields = {**vars(start), "orientation": normalize(start.orientation)}
        if lanes:
            fields = {k: np.broadcast_to(f, (lanes, *f.shape)).copy() for k, f in fields.items()}
        unit = State(**fields)
        plan = (self.sweep.timestep, every, every, by.coordinates)
        own = motion or body_motion(self.system, by.coordinates)
        with np.errstate(all="ignore"):
            return step_body(by.scheme, self.system, unit, *plan, own)[1][-1]

    def apart(self, ends: State, count: int | None = None) -> dict[str, Array]:
        """(..., n - 1, 3) per channel: from these ends to the samples, or the first of them."""
        came = self.state[1:][:count]
        with np.errstate(all="ignore"):
            return {
                "omega": came.angular_velocity - ends.angular_velocity,
                "attitude": rotation_between(ends.orientation, came.orientation),
                "velocity": came.linear_velocity - ends.linear_velocity,
                "position": came.position - ends.position,
            }

    def reached(
        self, ends: State, count: int | None = None, slack: float = SLACK
    ) -> NDArray[np.bool_]:
        """(..., n - 1): whether these ends are the samples to rounding, or the first of them."""
        apart = self.apart(ends, count)
        with np.errstate(all="ignore"):
            good = [norm(apart[c]) <= slack * self.bounds[c][:count] for c in CHANNELS]
        return np.asarray(np.all(good, axis=0))

    def made(self, by: SchemeOf, count: int) -> NDArray[np.bool_]:
        """(n - 1,): whether so many steps lead from each sample to the next.

        No number is below none.
        """
        if count < 0:
            return np.zeros(len(self.times) - 1, dtype=bool)
        own = replace(self, sweep=replace(self.sweep, every=count))
        return self.reached(own.ends(by) if count else self.state[:-1])

    def goes_on(self, by: SchemeOf) -> bool:
        """Whether a scheme's steps, and not none, lead on from the first sample after the start."""
        return bool(np.any(self.sound(by)[1:] & ~self.made(by, 0)[1:]))

    def sound(self, by: SchemeOf, slack: float = SLACK) -> NDArray[np.bool_]:
        """(n - 1,): whether the scheme leads from each sample to the next."""
        return self.reached(self.ends(by), slack=slack)

    def sound_but_for_rounding(self, by: SchemeOf, slack: float = SLACK) -> NDArray[np.bool_]:
        """(n - 1,): as `sound`, where what the scheme makes of the start's own rounding is allowed.

        The bounds are those of the true motion, which a wrong scheme may leave at a greater rate:
        it is seen from starts that are apart by half of the digits.
        """
        w = self.state.angular_velocity * (1.0 + HALF_OF_DIGITS)
        other = replace(self, state=replace(self.state, angular_velocity=w))
        here, beside = self.apart(self.ends(by)), self.apart(other.ends(by))
        part = slack * self.sweep.every * EPS / HALF_OF_DIGITS
        with np.errstate(all="ignore"):
            good = [
                norm(here[c]) <= slack * self.bounds[c] + part * norm(beside[c] - here[c])
                for c in CHANNELS
            ]
        return np.asarray(np.all(good, axis=0))


def plain_names(names: Sequence[str]) -> list[str]:
    """Of schemes that are one here, those of which no other is a variant at longer turns alone."""
    return [one for one in names if not any(one.startswith(f"{other}-") for other in names)]


def kept_run(
    name: str,
    truth: Truth,
    sweep: Sweep,
    state: State,
    growth: Array,
    fails: bool,
    least: int = 3,
) -> KeptRun | None:
    """The first samples, up to the first that is not finite or is no whole interval later.

    least: samples, of which fewer are none.
    """
    numbers = sweep.sample_steps
    count = min(len(numbers), len(state.position), MOST_SAMPLES + 1)
    whole = np.diff(numbers[:count]) == sweep.every
    finite = np.all([np.isfinite(f[:count]).all(-1) for f in vars(state).values()], axis=0)
    good = finite & np.concatenate(([True], whole))
    count = count if good.all() else int(np.argmin(good))
    if count < least or sweep.every > MOST_STEPS or sweep.accuracy is not None:
        return None
    bounds = bounds_of_samples(truth, sweep, growth, slice(1, count))
    kept = State(*(np.array(f[:count]) for f in vars(state).values()))
    return KeptRun(name, truth.yardstick.system, sweep, sweep.times[:count], kept, bounds, fails)


def bounds_of_samples(
    truth: Truth, sweep: Sweep, growth: Array, samples: slice
) -> dict[str, Array]:
    """Per channel in rad/s, rad, m/s and m: what rounding may do up to each of these samples.

    growth: (n,), of all samples or of the first.
    """
    yardstick = truth.yardstick
    open_ = yardstick.round_off(sweep.timestep, sweep.sample_steps[: len(growth)], growth)
    momentum = open_["linear_momentum"][samples] * yardstick.sizes["linear_momentum"]
    return {
        "omega": open_["omega"][samples] * yardstick.rate,
        "attitude": open_["attitude"][samples],
        "velocity": momentum / yardstick.scale.mass,
        "position": open_["position"][samples],
    }


def scheme_of(integrator: Integrator, runs: Sequence[KeptRun]) -> SchemeOf | None:
    """The scheme that is declared, or else the one by which most intervals of the runs are sound.

    A sound run says most, and one that is wrong by how it begins. The most likely is taken, and
    what it does not explain is not named.
    """
    if integrator.scheme in SCHEMES:
        return SchemeOf(SCHEMES[integrator.scheme], integrator.coordinates)
    if integrator.scheme is not None or integrator.knob != "timestep":
        return None
    return likeliest(runs)


def likeliest(runs: Sequence[KeptRun], least: int = LEAST) -> SchemeOf | None:
    """The scheme by which most intervals of the runs are sound, of all that are known.

    Where none is seen in the runs that show most, it is looked for in others: what is wrong may act
    on every step of the ones, and on no step of others.
    """
    rich = sorted((run.short for run in runs), key=_richness, reverse=True)
    sound, failing = ([run for run in rich if run.fails is fails] for fails in (False, True))
    best = _likeliest_by([*sound[:MOST_LOOKED_AT], *failing[:MOST_LOOKED_AT]], least)
    if best is None and len(failing) > MOST_LOOKED_AT:
        rest = failing[MOST_LOOKED_AT:]
        best = _likeliest_by(rest[:: -(-len(rest) // MOST_OTHERS)], least)
    return best


def _likeliest_by(shown: Sequence[KeptRun], least: int) -> SchemeOf | None:
    best, most = None, 0.0
    for one in _schemes(shown):
        good = [_sound_where_known(run, one) for run in shown]
        # of a run that is led astray by something else its beginning is the scheme's
        score = sum(float(np.mean(each)) + BEGINS * bool(each[0]) for each in good)
        if score > most and sum(map(np.count_nonzero, good)) >= least:
            best, most = one, score
    return best


def _sound_where_known(run: KeptRun, one: SchemeOf) -> NDArray[np.bool_]:
    known = one.coordinates == "com-world" or one.coordinates in distinct(run.system)
    own = one if known else SchemeOf(one.scheme, "com-world")
    return run.sound(own)


def _richness(run: KeptRun) -> tuple[int, float]:
    """Few steps between samples, and how much the body tumbles there, on which schemes differ."""
    w = run.state.angular_velocity
    with np.errstate(all="ignore"):
        tumbles = float(np.max(norm(np.diff(w, axis=0))))
    return -run.sweep.every, min(1.0, tumbles * float(run.lengths[0]))


def _schemes(runs: Sequence[KeptRun]) -> list[SchemeOf]:
    ways = dict.fromkeys(way for run in runs for way in distinct(run.system))
    known = {**COMMON, **EXPLICIT}
    return [
        SchemeOf(scheme_named(name), way)
        for way in sorted(ways, key=lambda way: way != "com-world")
        for name in known
        if way in known[name].coordinates and (way == "com-world" or name in COMMON)
    ]
