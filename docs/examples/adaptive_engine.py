"""An engine with an error-controlled integrator: a free body, by SciPy's DOP853."""

import numpy as np
from scipy.integrate import solve_ivp

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.reference_impl.system import Body, State


class AdaptiveAdapter:
    def __init__(self, setup="physics"):
        pass

    @property
    def description(self):
        rotation, translation = ("omega", "attitude"), ("position", "linear_momentum")
        channels = (*rotation, *translation, "energy", "angular_momentum")
        dop853 = Integrator("dop853", None, dict.fromkeys(channels, 8), knob="accuracy")
        features = frozenset({"free", "gravity", "full_inertia"})
        return Description("adaptive", "1.0", (dop853,), features=features)

    def load(self, system):
        load = system.load
        if (
            load.pivot is not None
            or load.damping
            or load.torque_body.any()
            or load.torque_world.any()
        ):
            raise UnsupportedError("adaptive knows free bodies without damping and torque only")
        self.body, self.gravity = system.body, load.gravity

    def model(self):
        return (Body(self.body.mass, self.body.center_of_mass, self.body.inertia),)

    def set_state(self, state):
        self.state = state

    def get_state(self):
        return self.state

    def rate(self, _, y):
        q, w, v = y[:4], y[4:7], y[10:]
        turning = 0.5 * np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))])
        torque = -np.cross(w, self.body.inertia @ w)
        return np.concatenate(
            (turning, np.linalg.solve(self.body.inertia, torque), v, self.gravity)
        )

    def run(self, initial, integrator, timestep, steps, every, accuracy=None):
        times = timestep * np.array([*range(0, steps, every), steps])
        parts = (initial.orientation, initial.angular_velocity)
        start = np.concatenate((*parts, initial.position, initial.linear_velocity))
        how = {"method": "DOP853", "t_eval": times, "rtol": accuracy, "atol": accuracy}
        y = solve_ivp(self.rate, (0.0, times[-1]), start, **how).y.T
        q = y[:, :4] / np.linalg.norm(y[:, :4], axis=1, keepdims=True)
        q[0] = initial.orientation
        return Trajectory(times, State(q, y[:, 4:7], y[:, 7:10], y[:, 10:]))
