# /// finding
# engine = "dart"
# integrator = "semi-implicit"
# scenario = "docs/findings/slow-sphere.toml"
# setup = "as-shipped"
# timestep = 0.005
# metric = "trajectory/attitude/error_max"
# kind = "precision limit"
# reach = "extreme"
# title = "Rotation vectors below 1 mrad are expanded to second order"
# what = "The attitude of a free body that is hardly turned is off by up to 3e-10 rad, and a slow body adds to that at each step."
# why = "math::expMapRot takes 1 + [r] + [r]^2/2 for a rotation vector r shorter than 1e-3. A turned frame of the joint keeps attitudes away from there; the turn of each step stays."
# mends = "joint.setTransformFromParentBodyNode(turned)"
# link = "https://github.com/dartsim/dart"
# ///
import math

import dartpy as dart
import numpy as np

TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def off(mended):
    """rad: how far the attitude of a sphere at 0.02 rad/s gets off in 5 s."""
    world, skeleton = dart.simulation.World(), dart.dynamics.Skeleton()
    joint, node = skeleton.createFreeJointAndBodyNodePair()
    node.setInertia(dart.dynamics.Inertia(1.0, np.zeros(3), 0.4 * np.eye(3)))
    if mended:
        frame = dart.math.Isometry3()
        frame.set_rotation(TURN)
        joint.setTransformFromParentBodyNode(frame)
    world.addSkeleton(skeleton)
    world.setGravity([0.0, 0.0, 0.0])
    world.setTimeStep(0.005)
    dart.dynamics.FreeJoint.setTransformOf(joint, dart.math.Isometry3())
    joint.setVelocities([0.0, 0.0, 0.02, 0.02, 0.0, 0.0])
    worst = 0.0
    for n in range(1, 1001):
        world.step()
        c, s = math.cos(1e-4 * n), math.sin(1e-4 * n)
        exact = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        gap = exact.T @ node.getWorldTransform().rotation()
        worst = max(worst, float(np.linalg.norm(gap - gap.T)) / math.sqrt(8.0))
    return worst


print("release", dart.__version__)
print("figure", off(False))
print("mended", off(True))
