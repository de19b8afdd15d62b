"""A toy engine and its adapter: a free or hung body, stepped by explicit Euler in 3x3 matrices."""

import numpy as np

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.reference_impl.system import Acceleration, Body, State


class ToyAdapter:
    def __init__(self, setup="physics"):
        pass  # a real adapter imports its engine here, not before

    @property
    def description(self):
        first_order = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum")
        orders = dict.fromkeys((*first_order, "position"), 1)
        features = frozenset({"free", "gravity", "full_inertia", "forward_dynamics"})
        scheme = Integrator("euler", "semi-implicit-euler", orders)
        return Description("toy", "1.0", (scheme,), features=features)

    def load(self, system):
        load = system.load
        if load.pivot is not None or load.damping or load.torque_body.any():
            raise UnsupportedError("toy knows free bodies without damping and torque only")
        if load.torque_world.any():
            raise UnsupportedError("toy knows free bodies without damping and torque only")
        self.mass, self.center = float(system.body.mass), system.body.center_of_mass
        self.inertia, self.gravity = system.body.inertia, load.gravity

    def model(self):
        return (Body(np.array(self.mass), self.center, self.inertia),)

    def set_state(self, state):
        self.state = state

    def get_state(self):
        return self.state

    def forward_dynamics(self, states):
        momentum = states.angular_velocity @ self.inertia
        torque = -np.cross(states.angular_velocity, momentum)
        linear = np.broadcast_to(self.gravity, torque.shape)
        return Acceleration(np.linalg.solve(self.inertia, torque[..., None])[..., 0], linear)

    def inverse_dynamics(self, states, acceleration):
        raise UnsupportedError("toy has no inverse dynamics")

    def run(self, initial, integrator, timestep, steps, every):
        q, w = initial.orientation, initial.angular_velocity
        p, v = initial.position, initial.linear_velocity
        kept = [step for step in range(steps + 1) if step % every == 0 or step == steps]
        rows = {0: (q, w, p, v)}
        for step in range(1, steps + 1):
            here = State(q, w, p, v)
            w = w + timestep * self.forward_dynamics(here).angular
            v = v + timestep * self.gravity
            p = p + timestep * v
            q = turned(q, timestep * w)
            rows[step] = (q, w, p, v)
        logged = State(*(np.array(column) for column in zip(*(rows[n] for n in kept), strict=True)))
        return Trajectory(np.array(kept) * timestep, logged)


def turned(q, vector):
    """The quaternion q (w, x, y, z) turned by a rotation vector in body axes."""
    angle = np.linalg.norm(vector)
    axis = vector / angle if angle else vector
    a, b = np.cos(angle / 2), np.sin(angle / 2) * axis
    scalar = q[0] * a - q[1:] @ b
    return np.concatenate([[scalar], q[0] * b + a * q[1:] + np.cross(q[1:], b)])
