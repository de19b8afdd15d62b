"""A system as an `mjx.Model`: MuJoCo's own model of it, put on the processor.

XLA compiles a program for each structure of a model and takes its numbers as arguments. MuJoCo's
compiler marks a body whose centre of mass is its origin, so that its structure is another; it is
given a stand-in that is not so, and the body's numbers are written over it. Then all free bodies
have one structure, all pivoted ones have one, and each program is compiled once.
"""

from __future__ import annotations

import contextlib
import importlib
import io
from collections.abc import Iterator
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Literal

import numpy as np

from omegadot.adapters.mujoco.model import (
    BODY,
    DISABLED,
    apply_setup,
    body_of,
    build_model,
    check_body,
    import_mujoco,
    write_body,
)
from omegadot.adapters.protocol import Setup
from omegadot.reference_impl.system import Body, System

# Any body whose centre of mass is off its origin and whose axes are turned.
STAND_IN = Body(np.array(1.0), np.ones(3), 4.0 * np.eye(3) - np.ones((3, 3)) / 3.0)

# Precisions of the programs in this process.
_TRACED: set[str] = set()


@dataclass(frozen=True)
class Engine:
    """MuJoCo, MJX and JAX as they are installed, and the precision that JAX computes in."""

    mujoco: Any
    mjx: Any
    jax: Any
    precision: Literal["float64", "float32"]

    @property
    def processor(self) -> Any:
        """The device that computes."""
        return self.jax.devices("cpu")[0]

    def begin_program(self) -> None:
        """Before a program is traced: JAX lets go of constants of the other precision.

        It keeps MJX's tables for RK4 as it has lowered them once, and then fails in the other one.
        Programs that are compiled stay.
        """
        _TRACED.add(self.precision)
        if len(_TRACED) > 1:
            self.jax.clear_caches()

    @contextlib.contextmanager
    def active(self) -> Iterator[None]:
        """Where all calls of MJX are made: JAX in this precision, on the processor.

        As a context, since JAX's own setting is one for the whole process.
        """
        wide = self.precision == "float64"
        with self.jax.enable_x64(wide), self.jax.default_device(self.processor):
            yield


def import_engine(precision: Literal["float64", "float32"]) -> Engine:
    """MJX. Raises ImportError where it is not installed.

    It prints that the package warp is missing, which it needs on graphics processors alone.
    """
    mujoco, jax = import_mujoco(), importlib.import_module("jax")
    with contextlib.redirect_stdout(io.StringIO()):
        mjx = importlib.import_module("mujoco.mjx")
    return Engine(mujoco, mjx, jax, precision)


def switched_off(engine: Engine) -> tuple[str, ...]:
    """What the ``physics`` setup turns off of that which MJX has, one clause each."""
    known = engine.mjx.DisableBit.__members__
    return tuple(what for name, what in DISABLED.items() if name.removeprefix("mjDSBL_") in known)


def put_system(engine: Engine, system: System, setup: Setup) -> Any:
    """The `mjx.Model` of a system. Raises UnsupportedError as MuJoCo's `check_body` does."""
    check_body(engine.mujoco, system)
    model = build_model(engine.mujoco, System((STAND_IN,), system.load))
    write_body(engine.mujoco, model, system.body)
    model.body_sameframe[BODY] = 0  # a shortcut of MuJoCo's own, by which structures would differ
    apply_setup(engine.mujoco, model, setup)
    with engine.active():
        return engine.mjx.put_model(model, device=engine.processor)


def read_back(model: Any) -> Body:
    """Mass, centre of mass and inertia, as an `mjx.Model` holds them."""
    names = ("body_mass", "body_ipos", "body_iquat", "body_inertia")
    return body_of(SimpleNamespace(**{n: np.array(getattr(model, n), float) for n in names}))
