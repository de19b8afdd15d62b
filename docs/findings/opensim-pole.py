# /// finding
# engine = "opensim"
# integrator = "RungeKuttaMerson-fixed"
# scenario = "docs/findings/past-the-pole.toml"
# setup = "as-shipped"
# timestep = 0.01
# metric = "trajectory/attitude/error_max"
# kind = "frame"
# reach = "ordinary"
# title = "Free and ball joints keep three angles, which have a pole"
# what = "A sphere at 1 rad/s is off by milliradians once its z-axis has passed close to the world's x-axis."
# why = "FreeJoint and BallJoint keep angles x, y, z; at y = 90 degrees they are singular, and OpenSim has no call that selects Simbody's quaternions. A joint whose frame in the ground is turned has its pole elsewhere; no one frame suits every motion."
# mends = "FreeJoint(..., orientationInParent, ...)"
# link = "https://github.com/opensim-org/opensim-core"
# ///
import importlib.metadata

import numpy as np
import opensim
from scipy.spatial.transform import Rotation

LEAN = 2.0 * np.arctan(0.0005)  # rad, of the z-axis, about x
OMEGA = np.array([0.0, 1.0, -0.001])  # rad/s, in the body's axes: it keeps its direction


def off(turn):
    """rad: how far the attitude gets off. turn: of the joint's frame in the ground, about z."""
    opensim.Logger.setLevelString("Off")
    model, body = opensim.Model(), opensim.Body("body", 1.0, opensim.Vec3(0), opensim.Inertia(0.4))
    model.addBody(body)
    none, frame = opensim.Vec3(0), opensim.Vec3(0, 0, turn)
    joint = opensim.FreeJoint("joint", model.getGround(), none, frame, body, none, none)
    model.addJoint(joint)
    model.setGravity(none)
    state = model.initSystem()
    ground_of_frame = Rotation.from_euler("z", turn)
    first = Rotation.from_euler("x", LEAN)
    angles = (ground_of_frame.inv() * first).as_euler("XYZ")
    spin = ground_of_frame.inv().apply(first.apply(OMEGA))
    for n, coordinate in enumerate(joint.get_coordinates(n) for n in range(3)):
        coordinate.setValue(state, float(angles[n]))
        coordinate.setSpeedValue(state, float(spin[n]))
    manager = opensim.Manager(model)
    manager.setIntegratorMethod(opensim.Manager.IntegratorMethod_RungeKuttaMerson)
    manager.setIntegratorFixedStepSize(0.01)
    manager.initialize(state)
    worst = 0.0
    for n in range(1, 201):
        now = manager.integrate(0.01 * n)
        model.realizePosition(now)
        angles = [joint.get_coordinates(i).getValue(now) for i in range(3)]
        found = ground_of_frame * Rotation.from_euler("XYZ", angles)
        exact = first * Rotation.from_rotvec(OMEGA * 0.01 * n)
        worst = max(worst, (exact.inv() * found).magnitude())
    return worst


print("release", importlib.metadata.version("opensim"))
print("figure", off(0.0))
print("mended", off(0.5 * np.pi))
