# /// finding
# engine = "mjx"
# integrator = "Euler"
# scenario = "docs/findings/nearly-still-sphere.toml"
# setup = "physics"
# timestep = 1000.0
# metric = "trajectory/attitude/error_max"
# kind = "precision limit"
# reach = "extreme"
# title = "Below 1e-8 rad/s a body does not turn"
# what = "At 9 nrad/s the attitude stays as it is, however long the step is."
# why = "mjx._src.math.norm takes a vector for zero where no component exceeds 1e-8, and quat_integrate then turns nothing. MuJoCo has no such threshold."
# mends = ""
# link = "https://github.com/google-deepmind/mujoco/tree/main/mjx"
# ///
import importlib.metadata
import math

import jax
import mujoco
from mujoco import mjx

jax.config.update("jax_enable_x64", True)
MODEL = """<mujoco><option timestep="1000" gravity="0 0 0"/><worldbody><body><freejoint/>
<inertial pos="0 0 0" mass="1" diaginertia="0.4 0.4 0.4"/></body></worldbody></mujoco>"""

own = mujoco.MjModel.from_xml_string(MODEL)
model = mjx.put_model(own)
data = mjx.make_data(own)
data = data.replace(qvel=data.qvel.at[5].set(0.9e-8))
step = jax.jit(mjx.step)
for _ in range(100):
    data = step(model, data)
turned = 2.0 * math.atan2(float(data.qpos[6]), float(data.qpos[3]))
print("release", importlib.metadata.version("mujoco-mjx"))
print("figure", abs(turned - 0.9e-8 * 1e5))
