# /// finding
# engine = "pybullet"
# integrator = "multibody"
# scenario = "docs/findings/very-slow-sphere.toml"
# setup = "physics"
# timestep = 400.0
# metric = "trajectory/attitude/error_max"
# kind = "precision limit"
# reach = "extreme"
# title = "Below 1 mrad/s a multibody turns by a series"
# what = "At 0.9 mrad/s a body turns too far in steps of minutes."
# why = "Below 0.001 rad/s the sine of half the turn x of a step is expanded to third order, whatever the step is: it is x^5/1920 too far."
# mends = ""
# link = "https://github.com/bulletphysics/bullet3/blob/master/src/BulletDynamics/Featherstone/btMultiBody.cpp"
# ///
import importlib.metadata
import math

import pybullet as p

OMEGA, STEP = 0.0009, 400.0

p.connect(p.DIRECT)
body = p.createMultiBody(baseMass=1.0)
p.changeDynamics(body, -1, localInertiaDiagonal=[0.4] * 3, linearDamping=0.0, angularDamping=0.0)
p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING)
p.resetBaseVelocity(body, [0.0] * 3, [0.0, 0.0, OMEGA])
p.setTimeStep(STEP)
worst = 0.0
for n in range(1, 11):
    p.stepSimulation()
    x, y, z, w = p.getBasePositionAndOrientation(body)[1]
    worst = max(
        worst, abs(math.remainder(2.0 * math.atan2(z, w) - OMEGA * STEP * n, 2.0 * math.pi))
    )
print("release", importlib.metadata.version("pybullet"))
print("figure", worst)
