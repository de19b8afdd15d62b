# /// finding
# engine = "mjx"
# integrator = "RK4"
# scenario = "docs/findings/brick.toml"
# setup = "physics"
# timestep = 0.01
# metric = "scheme/attitude/observed_order"
# kind = "order"
# expected = 4.0
# reach = "ordinary"
# title = "RK4 is of order 2 in attitude"
# what = "Halving the step divides the error of the attitude by 4 and not by 16."
# why = "A step turns by the mean of the omegas of its four stages, which is no turn of order 4. MuJoCo's own RK4 was the same up to 3.17; that of 4.0.0 is of order 4."
# mends = ""
# link = "https://github.com/google-deepmind/mujoco/tree/main/mjx"
# ///
import importlib.metadata

import jax
import mujoco
import numpy as np
from mujoco import mjx

jax.config.update("jax_enable_x64", True)
MODEL = """<mujoco><option integrator="RK4" gravity="0 0 0" timestep="{h}"/><worldbody><body>
<freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 2 2.5"/></body></worldbody></mujoco>"""


def attitude(h):
    own = mujoco.MjModel.from_xml_string(MODEL.format(h=h))
    model, data = mjx.put_model(own), mjx.make_data(own)
    data = data.replace(qvel=data.qvel.at[3:].set(np.array([1.0, 2.0, 3.0])))
    step = jax.jit(mjx.step)
    for _ in range(round(2.0 / h)):
        data = step(model, data)
    return np.array(data.qpos[3:])


# Of three steps, each half of the one before: errors of order n leave differences by 2^n.
one, two, three = (attitude(h) for h in (0.02, 0.01, 0.005))
print("release", importlib.metadata.version("mujoco-mjx"))
print("figure", np.log2(np.linalg.norm(one - two) / np.linalg.norm(two - three)))
