"""Engines that are wrong on a condition."""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Description
from omegadot.adapters.reference import ReferenceAdapter
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State


class EarlyReturn(ReferenceAdapter):
    """Forward dynamics are zero where no torque acts, and so without the gyroscopic term."""

    @property
    def description(self) -> Description:
        whole = super().description
        kept = tuple(i for i in whole.integrators if i.name == "lie-rk4")
        return Description("earlyreturn", "1.0", kept, features=whole.features)

    def forward_dynamics(self, states: State) -> Acceleration:
        sound, w = super().forward_dynamics(states), states.angular_velocity
        tensor = moving_inertia(self.system)
        none = ~np.any(torque(self.system, states), axis=-1, keepdims=True)
        lost = apply(inverse(tensor), cross(w, apply(tensor, w)))
        return Acceleration(sound.angular + np.where(none, lost, 0.0), sound.linear)


class InverseAlone(ReferenceAdapter):
    """Without forward dynamics; inverse dynamics leave the gyroscopic term out."""

    @property
    def description(self) -> Description:
        whole = super().description
        kept = tuple(i for i in whole.integrators if i.name == "lie-rk4")
        features = whole.features - {"forward_dynamics"}
        return Description("inversealone", "1.0", kept, features=features)

    def inverse_dynamics(self, states: State, accelerations: Acceleration) -> Array:
        w, tensor = states.angular_velocity, moving_inertia(self.system)
        whole = super().inverse_dynamics(states, accelerations)
        return whole - cross(w, apply(tensor, w))


class Unsteady(ReferenceAdapter):
    """Omega-dot is off by a thousandth in every other request."""

    requests = 0

    @property
    def description(self) -> Description:
        whole = super().description
        kept = tuple(i for i in whole.integrators if i.name == "lie-rk4")
        return Description("unsteady", "1.0", kept, features=whole.features)

    def forward_dynamics(self, states: State) -> Acceleration:
        self.requests += 1
        sound = super().forward_dynamics(states)
        return Acceleration((1.0 + 1e-3 * (self.requests % 2)) * sound.angular, sound.linear)
