# /// finding
# engine = "pybullet"
# integrator = "maximal"
# scenario = "docs/findings/tiny-brick.toml"
# setup = "physics"
# timestep = 0.01
# metric = "invariants/angular_momentum/drift_full"
# kind = "missing term"
# reach = "extreme"
# title = "Small bodies in maximal coordinates have no gyroscopic term"
# what = "The angular momentum of a free body of 5 g turns with it."
# why = "The term is solved for by a 3x3 solver that divides by its determinant only above 2.2e-16, whatever the unit is; that of moments of 1e-7 kg m^2 is below."
# mends = ""
# link = "https://github.com/bulletphysics/bullet3/blob/master/src/LinearMath/btMatrix3x3.h"
# ///
import importlib.metadata

import pybullet as p

MOMENTS = (1e-7, 2e-7, 2.5e-7)


def momentum(body):
    _, turn = p.getBasePositionAndOrientation(body)
    omega = p.getBaseVelocity(body)[1]
    r = p.getMatrixFromQuaternion(turn)
    own = [sum(r[3 * i + j] * omega[i] for i in range(3)) for j in range(3)]
    return [sum(r[3 * i + j] * MOMENTS[j] * own[j] for j in range(3)) for i in range(3)]


p.connect(p.DIRECT)
body = p.createMultiBody(baseMass=0.005, useMaximalCoordinates=1)
p.changeDynamics(body, -1, mass=0.005, localInertiaDiagonal=MOMENTS)
p.resetBaseVelocity(body, [0.0] * 3, [1.0, 2.0, 3.0])
p.setTimeStep(0.01)
first = momentum(body)
size, worst = sum(x * x for x in first) ** 0.5, 0.0
for _ in range(100):
    p.stepSimulation()
    p.stepSimulation()
    gap = [x - y for x, y in zip(momentum(body), first, strict=True)]
    worst = max(worst, sum(x * x for x in gap) ** 0.5 / size)
print("release", importlib.metadata.version("pybullet"))
print("figure", worst)
