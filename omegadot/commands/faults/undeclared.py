"""An engine whose integrators declare their orders and no scheme."""

from __future__ import annotations

from dataclasses import replace

from omegadot.adapters.protocol import Adapter, Description, Integrator
from omegadot.commands.faults.detect import chosen_integrators
from omegadot.commands.faults.fault import Spoiled


class Nameless(Spoiled):
    """Sound as far as the engine inside is; what it steps is left to be found out."""

    @property
    def description(self) -> Description:
        """The engine's, without its schemes."""
        found = self.inner.description
        return replace(found, integrators=tuple(map(without_scheme, found.integrators)))


def without_scheme(integrator: Integrator) -> Integrator:
    """The integrator with its orders alone."""
    return replace(integrator, scheme=None)


def nameless_integrators(engine: Adapter) -> tuple[Integrator, ...]:
    """Those by which an engine with declared schemes is judged, without them."""
    return tuple(map(without_scheme, chosen_integrators(engine.description.integrators)))
