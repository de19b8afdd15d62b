# /// finding
# engine = "jaxsim"
# integrator = "RungeKutta4"
# scenario = "driven-body"
# setup = "physics"
# timestep = 0.01
# metric = "scheme/omega/observed_order"
# kind = "order"
# expected = 4.0
# reach = "ordinary"
# title = "RungeKutta4 is of order 1 under a torque in body axes"
# what = "Halving the step halves the error of omega, as with Euler's method."
# why = "step takes the forces on links at the start of a step and holds them in world axes during its stages. Damping is the same. Torques in world axes and gravity leave order 4."
# mends = ""
# link = "https://github.com/gbionics/jaxsim"
# ///
import importlib.metadata

import jax
import jax.numpy as jnp
import jaxsim
import jaxsim.api as js
import numpy as np
import rod  # noqa: F401  # reads the description

SDF = """<sdf version="1.7"><model name="body"><link name="body"><inertial><mass>1</mass><inertia>
<ixx>1</ixx><iyy>2</iyy><izz>2.5</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz>
</inertia></inertial></link></model></sdf>"""
TORQUE = jnp.array([0.3, -0.2, 0.5])  # N m, body axes


def omega(h):
    """After 5 s, in body axes."""
    model = js.model.JaxSimModel.build_from_model_description(
        SDF, time_step=h, integrator=js.model.IntegratorType.RungeKutta4, gravity=0.0
    )
    data = js.data.JaxSimModelData.build(
        model,
        base_angular_velocity=jnp.array([0.5, 1.0, -0.5]),
        velocity_representation=jaxsim.VelRepr.Mixed,
    )

    @jax.jit
    def step(data):
        torque = data.base_transform[:3, :3] @ TORQUE
        forces = jnp.concatenate((jnp.zeros(3), torque))[None]
        return js.model.step(model, data, link_forces=forces)

    for _ in range(round(5.0 / h)):
        data = step(data)
    return np.array(data.base_transform[:3, :3].T @ data.base_velocity[3:])


# Of three steps, each half of the one before: errors of order n leave differences by 2^n.
one, two, three = (omega(h) for h in (0.04, 0.02, 0.01))
print("release", importlib.metadata.version("jaxsim"))
print("figure", np.log2(np.linalg.norm(one - two) / np.linalg.norm(two - three)))
