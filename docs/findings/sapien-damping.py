# /// finding
# engine = "sapien"
# integrator = "step"
# scenario = "sphere"
# setup = "as-shipped"
# timestep = 0.01
# metric = "trajectory/omega/error_max"
# kind = "default"
# reach = "ordinary"
# title = "Omega is damped"
# what = "A sphere that nothing touches loses a fifth of its omega in 5 s."
# why = "angular_damping is 0.05: omega is multiplied by 1 - 0.05 h at each step."
# mends = "set_angular_damping(0)"
# link = "https://github.com/haosulab/SAPIEN"
# ///
import importlib.metadata
import math

import sapien

MASS = 1000.0 * 4.0 / 3.0 * math.pi * 0.1**3


def lost(damping=None):
    sapien.physx.set_scene_config(gravity=[0.0, 0.0, 0.0])
    world = sapien.physx.PhysxCpuSystem()
    scene = sapien.Scene([world])
    entity, body = sapien.Entity(), sapien.physx.PhysxRigidDynamicComponent()
    body.set_mass(MASS)
    body.set_inertia([0.4 * MASS * 0.1**2] * 3)
    if damping is not None:
        body.set_angular_damping(damping)
    entity.add_component(body)
    scene.add_entity(entity)
    body.set_angular_velocity([1.0, 2.0, 3.0])
    body.set_linear_velocity([0.5, -0.25, 0.125])
    world.timestep = 0.01
    for _ in range(500):
        world.step()
    gap = [float(x) - y for x, y in zip(body.get_angular_velocity(), (1.0, 2.0, 3.0), strict=True)]
    return math.hypot(*gap) / math.hypot(1.0, 2.0, 3.0)


print("release", importlib.metadata.version("sapien"))
print("figure", lost())
print("mended", lost(0.0))
