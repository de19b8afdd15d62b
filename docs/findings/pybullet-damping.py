# /// finding
# engine = "pybullet"
# integrator = "multibody"
# scenario = "sphere"
# setup = "as-shipped"
# timestep = 0.01
# metric = "invariants/energy/drift_full"
# kind = "default"
# reach = "ordinary"
# title = "Every multibody is damped"
# what = "A sphere that nothing touches loses half of its energy in 5 s."
# why = "linearDamping and angularDamping are 0.04, and what is taken of omega grows with |omega|."
# mends = "changeDynamics(body, -1, linearDamping=0, angularDamping=0)"
# link = "https://github.com/bulletphysics/bullet3/blob/master/src/BulletDynamics/Featherstone/btMultiBody.cpp"
# ///
import importlib.metadata
import math

import pybullet as p

MASS = 1000.0 * 4.0 / 3.0 * math.pi * 0.1**3
MOMENT = 0.4 * MASS * 0.1**2


def energy(body):
    v, omega = p.getBaseVelocity(body)
    return 0.5 * MASS * sum(x * x for x in v) + 0.5 * MOMENT * sum(x * x for x in omega)


def lost(**mended):
    p.resetSimulation()
    body = p.createMultiBody(baseMass=MASS)
    p.changeDynamics(body, -1, localInertiaDiagonal=[MOMENT] * 3, **mended)
    p.resetBaseVelocity(body, [0.5, -0.25, 0.125], [1.0, 2.0, 3.0])
    p.setTimeStep(0.01)
    before = energy(body)
    for _ in range(500):
        p.stepSimulation()
    return abs(energy(body) / before - 1.0)


p.connect(p.DIRECT)
print("release", importlib.metadata.version("pybullet"))
print("figure", lost())
print("mended", lost(linearDamping=0.0, angularDamping=0.0))
