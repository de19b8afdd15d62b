# /// finding
# engine = "exudyn"
# integrator = "VelocityVerlet"
# scenario = "docs/findings/brick.toml"
# setup = "physics"
# timestep = 0.01
# metric = "scheme/omega/observed_order"
# kind = "order"
# expected = 2.0
# reach = "ordinary"
# title = "VelocityVerlet is of order 1"
# what = "Halving the step halves the error of omega of a body that tumbles."
# why = "It takes forces at the velocity of half a step before; the gyroscopic torque and damping depend on velocities."
# mends = ""
# link = "https://github.com/jgerstmayr/EXUDYN"
# ///
import importlib.metadata

import exudyn
import numpy as np
from exudyn.itemInterface import NodeRigidBodyRotVecLG, ObjectRigidBody


def omega(h):
    """After 2 s, in body axes."""
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    start = {"referenceCoordinates": [0.0] * 6, "initialVelocities": [0.0, 0.0, 0.0, 1.0, 2.0, 3.0]}
    node = mbs.AddNode(NodeRigidBodyRotVecLG(**start))
    mbs.AddObject(ObjectRigidBody(mass=1.0, inertia=[1.0, 2.0, 2.5, 0, 0, 0], nodeNumber=node))
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    own = settings.timeIntegration
    own.numberOfSteps, own.endTime = round(2.0 / h), 2.0
    mbs.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.VelocityVerlet)
    return np.array(mbs.GetNodeOutput(node, exudyn.OutputVariableType.AngularVelocityLocal))


# Of three steps, each half of the one before: errors of order n leave differences by 2^n.
one, two, three = (omega(h) for h in (0.02, 0.01, 0.005))
print("release", importlib.metadata.version("exudyn"))
print("figure", np.log2(np.linalg.norm(one - two) / np.linalg.norm(two - three)))
