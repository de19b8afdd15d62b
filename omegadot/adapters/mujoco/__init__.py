"""MuJoCo behind the protocol."""

from omegadot.adapters.mujoco.adapter import MujocoAdapter

__all__ = ["MujocoAdapter"]
