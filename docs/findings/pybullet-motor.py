# /// finding
# engine = "pybullet"
# integrator = "multibody"
# scenario = "sleeping-top-stable"
# setup = "as-shipped"
# timestep = 0.01
# metric = "trajectory/omega/error_max"
# kind = "default"
# reach = "ordinary"
# title = "A spherical joint has a motor that stops it"
# what = "A top on a spherical joint stands still after one step."
# why = "The joint is made with a motor that holds its velocity at zero."
# mends = "setJointMotorControlMultiDof(..., positionGain=0, velocityGain=0, force=[0, 0, 0])"
# link = "https://github.com/bulletphysics/bullet3"
# ///
import importlib.metadata

import pybullet as p

SPIN, TILT = 4.49, [0.004999979166692708, 0.0, 0.0, 0.9999875000260417]


def lost(released):
    """How much of omega is lost after one step of 0.01 s."""
    p.resetSimulation()
    p.setGravity(0.0, 0.0, -9.80665)
    p.setTimeStep(0.01)
    top = p.createMultiBody(
        baseMass=0.0,
        linkMasses=[1.0],
        linkCollisionShapeIndices=[-1],
        linkVisualShapeIndices=[-1],
        linkPositions=[[0.0, 0.0, 0.0]],
        linkOrientations=[[0.0, 0.0, 0.0, 1.0]],
        linkInertialFramePositions=[[0.0, 0.0, 0.3]],
        linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_SPHERICAL],
        linkJointAxis=[[0.0, 0.0, 1.0]],
    )
    p.changeDynamics(top, 0, mass=1.0, localInertiaDiagonal=[0.3, 0.3, 0.5])
    if released:
        hold = {"targetPosition": [0.0, 0.0, 0.0, 1.0], "force": [0.0, 0.0, 0.0]}
        gains = {"positionGain": 0.0, "velocityGain": 0.0}
        p.setJointMotorControlMultiDof(top, 0, p.POSITION_CONTROL, **hold, **gains)
    p.resetJointStateMultiDof(top, 0, TILT, [0.0, 0.0, SPIN])
    p.stepSimulation()
    omega = p.getJointStateMultiDof(top, 0)[1]
    return sum((x - y) ** 2 for x, y in zip(omega, (0.0, 0.0, SPIN), strict=True)) ** 0.5 / SPIN


p.connect(p.DIRECT)
print("release", importlib.metadata.version("pybullet"))
print("figure", lost(False))
print("mended", lost(True))
