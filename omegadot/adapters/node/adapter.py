"""The engines that run through Node, each as the program that serves it.

An engine is a file of JavaScript in this folder, and a line in package.json, in ``ENGINES`` and
here. Each function gives the program's command line, and raises ImportError where the engine's
package is not installed.
"""

from __future__ import annotations

from omegadot.adapters.node.packages import command_of
from omegadot.adapters.protocol import Setup


def cannon_es(setup: Setup) -> str:
    """cannon-es, in double precision. setup: the program receives it later, by the protocol."""
    return command_of("cannon-es")


def rapier3d_compat(setup: Setup) -> str:
    """Rapier in WebAssembly, in single precision."""
    return command_of("rapier3d-compat")


def jolt_physics(setup: Setup) -> str:
    """Jolt in WebAssembly, in single precision."""
    return command_of("jolt-physics")


def physx_js_webidl(setup: Setup) -> str:
    """PhysX in WebAssembly, in single precision."""
    return command_of("physx-js-webidl")


def havok(setup: Setup) -> str:
    """Havok in WebAssembly, in single precision."""
    return command_of("havok")


def ammo(setup: Setup) -> str:
    """Bullet in JavaScript, in single precision."""
    return command_of("ammo")
