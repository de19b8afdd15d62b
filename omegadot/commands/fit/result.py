"""What ``omegadot fit`` gives back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from omegadot.commands.fit.compared import Compared
from omegadot.commands.fit.estimates import Estimates, principal
from omegadot.commands.fit.parameters import Free
from omegadot.commands.fit.samples import Samples
from omegadot.commands.fit.scale import Scale
from omegadot.reference_impl.system import Array
from omegadot.scenarios import Scenario


@dataclass(frozen=True)
class Model:
    """A model that was fitted. terms: what it has besides a shape and a start.

    moments: (3,), the largest 1.  rms: rad/s, of a component of omega.  chosen: whether it is the
    one that is reported.
    """

    terms: tuple[str, ...]
    moments: Array
    rms: float
    chosen: bool


@dataclass(frozen=True, eq=False)
class FitResult:
    """A fit of a trace.

    estimates: the numbers, with standard errors.  sentences: what the data determine and what they
    do not.  scenario: the body and its start, as `run` takes it.  options: those with which `score`
    reads the trace as it was read here.
    """

    samples: Samples
    estimates: Estimates
    scale: Scale
    compared: Compared
    sentences: list[str]
    scenario: Scenario
    options: list[str]

    @property
    def unit(self) -> str:
        """Of moments: "kg m^2", or "" where the largest is set to 1."""
        return self.scale.unit

    @property
    def shape_determined(self) -> bool:
        """Whether omega shows any ratio of moments."""
        return self.compared.chosen.shape and self.estimates.shape_known

    @property
    def errors_hold(self) -> bool:
        """Whether the residuals are noise, which standard errors come from."""
        return not self.compared.noise.is_model_error

    @property
    def terms(self) -> tuple[str, ...]:
        """Which of bias and damping are fitted, and determined."""
        own = self.estimates
        sure = {"bias": bool(np.any(own.bias_known)), "damping": own.damping_known}
        return tuple(name for name in _terms(self.compared.chosen) if sure[name])

    @property
    def rms(self) -> Array:
        """(3,) rad/s: what is left of each component of omega."""
        return np.asarray(self.samples.size * self.compared.noise.axes)

    @property
    def rms_attitude(self) -> float | None:
        """rad, of a component; None where no attitude is given."""
        return None if self.samples.orientation is None else self.compared.noise.turn

    @cached_property
    def models(self) -> list[Model]:
        """All that were fitted, the one with the fewest terms first."""
        found = []
        for free, fit in self.compared.fits.items():
            if free.shape:
                moments = principal(fit.one.inertia)[0]
                rms = self.samples.size * self.compared.rms(free)
                own = free == self.compared.chosen
                found.append(Model(_terms(free), moments / np.max(moments), rms, own))
        return sorted(found, key=lambda model: len(model.terms))

    def as_dict(self) -> dict[str, Any]:
        """Plain tables, lists and numbers; None for what the data do not determine."""
        own, samples = self.estimates, self.samples
        shape = self.shape_determined
        whole = shape and bool(np.all(own.moments_known))
        found = {
            "trace": samples.file,
            "samples": len(samples.times),
            "from": float(samples.times[0]),
            "to": float(samples.times[-1]),
            "turned": float(samples.data(np.zeros(3)).turned[-1]),
            "unit": self.unit,
            "scale": self.scale.why,
            "shape_determined": shape,
            "moments": _plain(own.moments, own.moments_known) if shape else None,
            "moment_errors": _plain(own.moment_errors, own.moments_known) if shape else None,
            "axes": _plain(own.axes.T) if shape else None,
            "axis_errors": _plain(own.axis_errors, own.axes_known) if shape else None,
            "inertia": _plain(own.inertia) if whole else None,
            "inertia_errors": _plain(own.inertia_errors) if whole else None,
            "omega": _plain(own.omega, own.omega_known),
            "omega_errors": _plain(own.omega_errors, own.omega_known),
            "reading": _plain(own.reading),
            "reading_errors": _plain(own.reading_errors),
            "orientation": None if own.orientation is None else _plain(own.orientation),
            "orientation_errors": (
                None if own.orientation_errors is None else _plain(own.orientation_errors)
            ),
            "bias": _plain(own.bias, own.bias_known) if "bias" in self.terms else None,
            "bias_errors": _plain(own.bias_errors, own.bias_known)
            if "bias" in self.terms
            else None,
            "damping": own.damping if "damping" in self.terms else None,
            "damping_error": own.damping_error if "damping" in self.terms else None,
            "rms": _plain(self.rms),
            "rms_attitude": self.rms_attitude,
            "correlation": self.compared.noise.correlation,
            "chances": self.compared.chances,
            "models": [{**vars(model), "moments": _plain(model.moments)} for model in self.models],
            "sentences": self.sentences,
            "scenario": self.scenario.to_dict(),
        }
        no_errors = {key: None for key in found if key.endswith(("_error", "_errors"))}
        return found if self.errors_hold else {**found, **no_errors}


def _terms(free: Free) -> tuple[str, ...]:
    return tuple(name for name in ("bias", "damping") if getattr(free, name))


def _plain(values: Array, known: NDArray[np.bool_] | None = None) -> list[Any]:
    """A list; None where a number is not known."""
    if known is None:
        return list(np.asarray(values).tolist())
    pairs = zip(np.asarray(values).tolist(), known, strict=True)
    return [value if sure else None for value, sure in pairs]
