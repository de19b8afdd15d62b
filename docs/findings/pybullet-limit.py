# /// finding
# engine = "pybullet"
# integrator = "multibody"
# scenario = "docs/findings/fast-sphere.toml"
# setup = "as-shipped"
# timestep = 0.002
# metric = "trajectory/position/error_max"
# kind = "default"
# reach = "extreme"
# title = "Velocities of a multibody are cut to 100"
# what = "Of 600 m/s and 150 rad/s a body keeps 100 m/s and 100 rad/s, from the first step on."
# why = "maxJointVelocity is 100 for each component of omega and velocity, of a free body too."
# mends = "changeDynamics(body, -1, maxJointVelocity=1e9, linearDamping=0, angularDamping=0)"
# link = "https://github.com/bulletphysics/bullet3/blob/master/src/BulletDynamics/Featherstone/btMultiBody.cpp"
# ///
import importlib.metadata

import pybullet as p


def behind(**mended):
    p.resetSimulation()
    body = p.createMultiBody(baseMass=1.0)
    p.changeDynamics(body, -1, localInertiaDiagonal=[0.4] * 3, **mended)
    p.resetBaseVelocity(body, [600.0, 0.0, 0.0], [0.0, 0.0, 150.0])
    p.setTimeStep(0.002)
    for _ in range(20):
        p.stepSimulation()
    return abs(24.0 - p.getBasePositionAndOrientation(body)[0][0])


p.connect(p.DIRECT)
print("release", importlib.metadata.version("pybullet"))
print("figure", behind())
no_damping = {"linearDamping": 0.0, "angularDamping": 0.0}
print("mended", behind(maxJointVelocity=1e9, **no_damping))
