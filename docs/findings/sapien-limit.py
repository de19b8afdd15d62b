# /// finding
# engine = "sapien"
# integrator = "step"
# scenario = "docs/findings/fast-sphere.toml"
# setup = "as-shipped"
# timestep = 0.002
# metric = "trajectory/omega/error_max"
# kind = "default"
# reach = "extreme"
# title = "Omega is cut to 100 rad/s"
# what = "Of 150 rad/s a body keeps 100 rad/s, less what damping takes."
# why = "max_angular_velocity is 100 rad/s."
# mends = "set_max_angular_velocity(1e9); set_angular_damping(0)"
# link = "https://github.com/haosulab/SAPIEN"
# ///
import importlib.metadata

import sapien


def lost(mended):
    sapien.physx.set_scene_config(gravity=[0.0, 0.0, 0.0])
    world = sapien.physx.PhysxCpuSystem()
    scene = sapien.Scene([world])
    entity, body = sapien.Entity(), sapien.physx.PhysxRigidDynamicComponent()
    body.set_mass(1.0)
    body.set_inertia([0.4] * 3)
    if mended:
        body.set_max_angular_velocity(1e9)
        body.set_angular_damping(0.0)
    entity.add_component(body)
    scene.add_entity(entity)
    body.set_linear_velocity([600.0, 0.0, 0.0])
    body.set_angular_velocity([0.0, 0.0, 150.0])
    world.timestep = 0.002
    for _ in range(20):
        world.step()
    return abs(float(body.get_angular_velocity()[2]) / 150.0 - 1.0)


print("release", importlib.metadata.version("sapien"))
print("figure", lost(False))
print("mended", lost(True))
