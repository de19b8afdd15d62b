"""The module mujoco, imported when it is needed."""

from __future__ import annotations

import importlib
from typing import Any


def import_mujoco() -> Any:
    """MuJoCo, writing no MUJOCO_LOG.TXT into the current folder. Raises ImportError.

    Its own handler of warnings prints them and appends them to that file. Where no other is set,
    they are dropped: what they warn of is seen in the states.
    """
    mujoco = importlib.import_module("mujoco")
    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(lambda _: None)
    return mujoco
