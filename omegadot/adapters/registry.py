"""Which engines there are: the built-in ones, those of entry points, those named by a file."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from omegadot.adapters.node.packages import ENGINES as NODE_ENGINES
from omegadot.adapters.node.packages import missing
from omegadot.adapters.protocol import Adapter, Setup, UnsupportedError
from omegadot.reference_impl.system import System

ENTRY_POINT_GROUP = "omegadot.adapters"
# Before the command line of a program that serves an engine, in the place of module:Class.
PROGRAM = "command:"

BUILT_IN: dict[str, str] = {
    "exact": "omegadot.adapters.exact.adapter:ExactAdapter",
    "reference": "omegadot.adapters.reference.adapter:ReferenceAdapter",
    "mujoco": "omegadot.adapters.mujoco.adapter:MujocoAdapter",
    "pinocchio": "omegadot.adapters.pinocchio.adapter:PinocchioAdapter",
    "dart": "omegadot.adapters.dart.adapter:DartAdapter",
}
EXTRAS: dict[str, str] = {
    "drake": "omegadot.adapters.drake.adapter:DrakeAdapter",
    "exudyn": "omegadot.adapters.exudyn.adapter:ExudynAdapter",
    "basilisk": "omegadot.adapters.basilisk.adapter:BasiliskAdapter",
    "opensim": "omegadot.adapters.opensim.adapter:OpenSimAdapter",
    "pybullet": "omegadot.adapters.pybullet.adapter:PyBulletAdapter",
    "sapien": "omegadot.adapters.sapien.adapter:SapienAdapter",
    "mjx": "omegadot.adapters.mjx.adapter:MjxAdapter",
    "mjx-float32": "omegadot.adapters.mjx.adapter:MjxFloat32Adapter",
    "jaxsim": "omegadot.adapters.jaxsim.adapter:JaxsimAdapter",
    "jaxsim-float32": "omegadot.adapters.jaxsim.adapter:JaxsimFloat32Adapter",
    "idyntree": "omegadot.adapters.idyntree.adapter:IDynTreeAdapter",
    "rapier3d": "omegadot.adapters.rapier3d.adapter:RapierAdapter",
    "biorbd": "omegadot.adapters.biorbd.adapter:BiorbdAdapter",
}
"""Engines that an extra installs, by the name before a hyphen: ``pip install 'omegadot[mjx]'``."""
NODE: dict[str, str] = {
    name: f"omegadot.adapters.node.adapter:{name.replace('-', '_')}" for name in NODE_ENGINES
}
"""Engines that run through Node: ``omegadot engines --install node``."""
OPTIONAL = {**EXTRAS, **NODE}
OURS = {**BUILT_IN, **OPTIONAL}
# The modules of an extra's engines, by which they are known to be there.
_MODULES = {
    "drake": ("pydrake",),
    "exudyn": ("exudyn",),
    "basilisk": ("Basilisk",),
    "opensim": ("opensim",),
    "pybullet": ("pybullet",),
    "sapien": ("sapien",),
    "mjx": ("jax", "mujoco.mjx"),
    "jaxsim": ("jax", "jaxsim"),
    "idyntree": ("idyntree",),
    "rapier3d": ("rapier3d",),
    "biorbd": ("biorbd",),
}


class AdapterError(ValueError):
    """An adapter cannot be found or built; the message is one sentence for the user."""


def registered() -> dict[str, str]:
    """Every engine name with its ``module:Class`` target; entry points add to our own.

    Raises AdapterError where one of them has the name of another engine.
    """
    from importlib.metadata import entry_points  # no worker asks: it is given the target itself

    found = dict(OURS)
    for point in entry_points(group=ENTRY_POINT_GROUP):
        for name, target in found.items():
            if name.casefold() == point.name.casefold() and target != point.value:
                raise AdapterError(
                    f"entry point {point.name} = {point.value}: {name} is the name of {target} "
                    "too; uninstall the package of one, or give the entry point another name."
                )
        found[point.name] = point.value
    return found


def is_absent(name: str) -> bool:
    """Whether this is an optional engine whose package is not installed."""
    if name in NODE:
        return bool(missing(name))
    return name in EXTRAS and not all(map(_is_there, _MODULES[_extra_of(name)]))


def _extra_of(name: str) -> str:
    return name.partition("-")[0]


def _is_there(module: str) -> bool:
    """Whether a module can be found, without importing the package that it is in."""
    package, _, inner = module.partition(".")
    spec = importlib.util.find_spec(package)
    if spec is None or not inner:
        return spec is not None
    return any((Path(folder) / inner).is_dir() for folder in spec.submodule_search_locations or ())


def _import_target(module_name: str) -> ModuleType:
    if not module_name.endswith(".py"):
        return importlib.import_module(module_name)
    path = Path(module_name)
    if not path.is_file():
        raise AdapterError(f"{module_name}: no such adapter file; check the path.")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None  # as the file's name ends with .py
    assert spec.loader is not None
    sys.modules[path.stem] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class _FromFile:
    """An adapter whose systems go in through the engine's own reader of a format."""

    def __init__(self, adapter: Any, via: str) -> None:
        self._adapter, self._via = adapter, via

    def load(self, system: System) -> None:
        self._adapter.load_file(system, self._via)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._adapter, name)


def through_file(adapter: Adapter, via: str) -> Adapter:
    """The adapter, loading every system by a file of this format.

    Raises UnsupportedError where the engine has no reader of it.
    """
    own = adapter.description
    if via not in own.importers:
        known = " and ".join(own.importers) or "no such files"
        raise UnsupportedError(f"{own.name} {own.version} has no reader of {via}; it reads {known}")
    return cast(Adapter, _FromFile(adapter, via))


def factory_of(target: str) -> Callable[..., Adapter | str] | str:
    """The class that ``module:Class`` or ``FILE.py:Class`` names, or a program's command line.

    The latter is given by ``command:PROGRAM ...``, or by a text in the place of the class, or by
    what a function there returns. Raises AdapterError where there is none, and whatever importing
    the module raises.
    """
    if target.startswith(PROGRAM):
        return target.removeprefix(PROGRAM)
    module_name, separator, class_name = target.rpartition(":")
    if not separator or not class_name:
        raise AdapterError(f"{target}: not an adapter; give module:Class or FILE.py:Class.")
    module = _import_target(module_name)
    factory: Callable[..., Adapter | str] | str | None = getattr(module, class_name, None)
    if not (callable(factory) or isinstance(factory, str)):
        raise AdapterError(f"{target}: {module_name} has no class {class_name}; check its name.")
    return factory


def build_adapter(
    target: str,
    setup: Setup = "physics",
    via: str = "",
    served: Callable[[str, Setup], Adapter] | None = None,
) -> Adapter:
    """Build the adapter that a target names, see `factory_of`.

    via: the format of the files by which systems are loaded; "" for the engine's API.  served: what
    builds the adapter of a program.
    Raises AdapterError when the target is malformed, UnsupportedError as `through_file` does, and
    whatever the engine's import raises (ImportError when it is not installed).
    """
    factory = factory_of(target)
    made = factory if isinstance(factory, str) else _made(factory, target, setup)
    if not isinstance(made, str):
        adapter = made
    elif served is None:
        raise AdapterError(f"{target}: a program serves engines in a process of its own only.")
    else:
        adapter = served(made, setup)
    return through_file(adapter, via) if via else adapter


def _made(factory: Callable[..., Adapter | str], target: str, setup: Setup) -> Adapter | str:
    """What a class or a function makes; where a module is missing, with what installs it."""
    try:
        return factory(setup=setup)
    except ModuleNotFoundError as error:
        extra = next((name for name, own in EXTRAS.items() if own == target), "")
        advice = f"; install it with pip install 'omegadot[{_extra_of(extra)}]'" if extra else ""
        raise ImportError(f"{error}{advice}") from error
