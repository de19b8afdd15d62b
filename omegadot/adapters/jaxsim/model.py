"""JaxSim as it is installed, and its model of one floating link.

A description of the link is SDF text. XLA compiles a program for each structure of a model and
takes its numbers as arguments, so one description serves all bodies: their numbers go in as
JaxSim's `LinkParameters`.
"""

from __future__ import annotations

import contextlib
import importlib
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from omegadot.adapters.protocol import UnsupportedError
from omegadot.reference_impl.system import Body, System

SDF = """<sdf version="1.7"><model name="body"><link name="body"><inertial><mass>1</mass><inertia>
<ixx>1</ixx><iyy>1</iyy><izz>1</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz>
</inertia></inertial></link></model></sdf>"""


@dataclass(frozen=True)
class Engine:
    """JAX, `jaxsim` and its `jaxsim.api`, and the precision that JAX computes in."""

    jax: Any
    jaxsim: Any
    api: Any
    precision: Literal["float64", "float32"]

    @contextlib.contextmanager
    def active(self) -> Iterator[None]:
        """Where all calls of JaxSim are made: JAX in this precision, on the processor.

        As a context, since JAX's own setting is one for the whole process.
        """
        wide, processor = self.precision == "float64", self.jax.devices("cpu")[0]
        with self.jax.enable_x64(wide), self.jax.default_device(processor):
            yield

    @property
    def mixed(self) -> Any:
        """The representation of velocities and forces: of the origin, in world axes."""
        return self.jaxsim.VelRepr.Mixed


def import_engine(precision: Literal["float64", "float32"]) -> Engine:
    """JaxSim. Raises ImportError where it is not installed.

    Its import sets the precision of JAX, how NumPy prints and how Python warns. Those are set back.
    """
    jax = importlib.import_module("jax")
    wide = jax.config.jax_enable_x64
    with np.printoptions(), warnings.catch_warnings():
        jaxsim, api = (importlib.import_module(name) for name in ("jaxsim", "jaxsim.api"))
        importlib.import_module("jaxsim.parsers.rod")
    jax.config.update("jax_enable_x64", wide)
    return Engine(jax, jaxsim, api, precision)


def described_model(engine: Engine) -> Any:
    """JaxSim's model of any floating link."""
    with engine.active(), warnings.catch_warnings():
        return engine.api.model.JaxSimModel.build_from_model_description(SDF, is_urdf=False)


class Argument:
    """A number that a program takes, where JaxSim has one that is fixed in the program: gravity.

    JAX takes it for the array that it holds, and tells programs apart by which one it is.
    """

    def __init__(self, value: Any) -> None:
        self._value = value

    def __jax_array__(self) -> Any:
        """What JAX asks for."""
        return self._value


def model_with(model: Any, parameters: Any, gravity: Any, timestep: Any, integrator: Any) -> Any:
    """The model, with these numbers: gravity is along z, negative downwards."""
    with model.editable(validate=False) as changed:
        changed.kin_dyn_parameters = model.kin_dyn_parameters.replace(
            link_parameters=parameters, validate=False
        )
        changed.gravity, changed.time_step = Argument(gravity), timestep
        changed.integrator = integrator
    return changed


def link_parameters(engine: Engine, system: System) -> Any:
    """JaxSim's parameters of one link. Raises UnsupportedError for what JaxSim has not.

    They go in by themselves: out of a description, JaxSim takes the inertia about the centre of
    mass from that about the origin, which loses digits where the centre of mass is far from it.
    """
    if len(system.bodies) != 1:
        raise UnsupportedError(f"jaxsim takes one body here, not {len(system.bodies)}.")
    if system.load.pivot is not None:
        raise UnsupportedError(
            "jaxsim has no ball joint: its joints turn about one axis, and a model's base is free "
            "or does not move at all."
        )
    body, made = system.body, engine.api.kin_dyn_parameters.LinkParameters
    with engine.active():
        numbers = (np.asarray(value, float) for value in (body.mass, body.inertia))
        mass, inertia = map(engine.jax.numpy.asarray, numbers)
        center = engine.jax.numpy.asarray(np.asarray(body.center_of_mass, float))
        one = made.build_from_inertial_parameters(index=0, m=mass, I=inertia, c=center)
        return engine.jax.tree.map(lambda values: values[None], one)


def read_back(engine: Engine, parameters: Any) -> Body:
    """Mass, centre of mass and inertia, as JaxSim's parameters hold them."""
    with engine.active():
        one = engine.jax.tree.map(lambda values: values[0], parameters)
        inertia = engine.api.kin_dyn_parameters.LinkParameters.inertia_tensor(one)
        return Body(
            np.array(one.mass, float),
            np.array(one.center_of_mass, float),
            np.array(inertia, float),
        )
