"""The bodies of an MJCF, as MuJoCo's own compiler finds them.

The compiler runs in a process of its own, as a file from anybody can hold it up or end it. Where it
fails for want of meshes, textures or height fields, balls of 1 m and of 2 m stand for them: what
comes out the same with both does not depend on them, whatever the file's settings; the rest is
refused.
"""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from omegadot.adapters.mujoco.model import import_mujoco
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.scenarios.errors import ScenarioError, printable
from omegadot.scenarios.links.link import Link
from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.xml_file import decoded
from omegadot.written import written

SECONDS = 60.0  # a humanoid takes a tenth of a second
RADII = (1.0, 2.0)  # m, of the balls


def bodies_of_mjcf(path: Path, file: str) -> list[Link]:
    """The bodies of a file in the frames of the compiled model. file: its name in errors.

    Raises ScenarioError where MuJoCo is not installed or refuses the file.
    """
    command = [sys.executable, "-P", "-m", __name__, str(path)]
    try:
        ended = subprocess.run(
            command, capture_output=True, stdin=subprocess.DEVNULL, timeout=SECONDS, check=False
        )
        answer: dict[str, Any] = json.loads(ended.stdout.rpartition(b"\n")[2])
    except subprocess.TimeoutExpired:
        found = f"an MJCF that MuJoCo did not compile within {written(SECONDS)} s"
        raise ScenarioError(file, None, found, "make it smaller") from None
    except ValueError:
        found = f"an MJCF at which MuJoCo ended its process (exit code {ended.returncode})"
        raise ScenarioError(file, None, found, "correct it there") from None
    return links_of(answer, file)


def links_of(answer: dict[str, Any], file: str) -> list[Link]:
    """The bodies in what `compiled` gives. Raises ScenarioError where it is a refusal."""
    if "refused" in answer:
        found, advice = answer["refused"]
        raise ScenarioError(file, None, found, advice)
    return [
        Link(name, body is None or body["mass"] > 0.0, partial(_body, body, answer["lacking"]))
        for name, body in answer["bodies"].items()
    ]


def _body(body: dict[str, Any] | None, lacking: str, place: Place) -> dict[str, Any]:
    if body is None:
        advice = "give MuJoCo the files, or the body an <inertial>"
        place.refuse(f"dependent on files that MuJoCo cannot read ({lacking})", advice)
    if not body["mass"] > 0.0:
        place.refuse("without mass", "give it geoms or an <inertial>, or choose another body")
    return body


def compiled(path: str) -> dict[str, Any]:
    """What MuJoCo's compiler makes of a file, in this process.

    bodies: by name, None where they are not certain.  lacking: the files that it did not find.
    refused: instead of the two, what the file is and what to do.
    """
    try:
        mujoco = import_mujoco()
    except ImportError:
        advice = "install it: pip install 'omegadot[mujoco]'"
        return {"refused": ("an MJCF, which takes MuJoCo to read", advice)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        # the compiler raises ValueError, and RuntimeError where memory runs out
        try:
            return {"bodies": _bodies(mujoco.MjSpec.from_file(path).compile()), "lacking": ""}
        except Exception as error:
            reason = _reason(error)
        try:
            first, second = (
                _bodies(_without_files(mujoco, path, radius).compile()) for radius in RADII
            )
        except Exception as error:
            found = f"an MJCF that MuJoCo does not compile ({_reason(error) or reason})"
            return {"refused": (found, "correct it there")}
    certain = {name: body if body == second[name] else None for name, body in first.items()}
    return {"bodies": certain, "lacking": reason}


def _reason(error: Exception) -> str:
    """In one line, and empty where there is none."""
    lines = str(error).split("\n")
    return printable("; ".join(line for line in lines if line)) if any(lines) else ""


def _without_files(mujoco: Any, path: str, radius: float) -> Any:
    """The model with balls for its meshes and height fields, and without textures and skins.

    Raises ValueError where no file is lacking: none is named.
    """
    spec, kinds = mujoco.MjSpec.from_file(path), mujoco.mjtGeom
    assets = [*spec.meshes, *spec.hfields, *spec.skins, *spec.textures]
    if not any(asset.file or any(getattr(asset, "cubefiles", ())) for asset in assets):
        raise ValueError
    for geom in spec.geoms:
        needs_file = (kinds.mjGEOM_MESH, kinds.mjGEOM_SDF, kinds.mjGEOM_HFIELD)
        if geom.type in needs_file or geom.meshname or geom.hfieldname:
            geom.type, geom.size = kinds.mjGEOM_SPHERE, [radius] * 3
            geom.fromto = np.full(6, np.nan)
            geom.meshname = geom.hfieldname = ""
            geom.plugin.active = False
    for material in spec.materials:
        for role in range(len(material.textures)):
            material.textures[role] = ""
    for asset in assets:
        spec.delete(asset)
    return spec


def _bodies(model: Any) -> dict[str, dict[str, Any]]:
    """Every named body's mass, centre of mass and inertia, in the axes of its frame."""
    found = {}
    for index in range(1, model.nbody):
        start = model.name_bodyadr[index]
        name = decoded(model.names[start : model.names.index(b"\0", start)])
        axes = rotation_matrix(model.body_iquat[index])
        tensor = (axes * model.body_inertia[index]) @ axes.T
        found[name] = {
            "mass": float(model.body_mass[index]),
            "center_of_mass": model.body_ipos[index].tolist(),
            "inertia": (0.5 * (tensor + tensor.T)).tolist(),
        }
    return {name: body for name, body in found.items() if name}


if __name__ == "__main__":
    sys.stdout.write("\n" + json.dumps(compiled(sys.argv[1])))
