"""Bodies of MJCF files as omegadot reads them against the models that MuJoCo compiles.

Every named body of every file below the folders: mass, centre of mass, and moments about twenty
random axes, the largest difference over the largest entry. Files that MuJoCo does not compile are
counted apart, with the bodies that were read of them all the same.

    pip install . && pip install --no-deps dm_control
    python benchmarks/bodies.py "$(pip show dm_control | sed -n 's/Location: //p')/dm_control"
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from omegadot.adapters.mujoco.body_file import compiled

BOUND = 1e-12


def difference(body: dict[str, Any], model: Any, index: int) -> float:
    """The largest of the relative differences of a body's mass, centre and inertia."""
    turned = np.empty(9)
    mujoco.mju_quat2Mat(turned, model.body_iquat[index])
    axes = np.random.default_rng(index).normal(size=(20, 3))
    theirs = ((axes @ turned.reshape(3, 3)) ** 2) @ model.body_inertia[index]
    ours = np.einsum("ni,ij,nj->n", axes, np.array(body["inertia"]), axes)
    pairs = [
        (body["mass"], model.body_mass[index]),
        (body["center_of_mass"], model.body_ipos[index]),
        (ours, theirs),
    ]
    return max(float(np.abs(np.subtract(a, b)).max() / (np.abs(b).max() or 1.0)) for a, b in pairs)


def main() -> int:
    """Compare, print the counts and the worst difference; 1 where it exceeds 1e-12."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path)
    warnings.simplefilter("ignore")
    counts = dict.fromkeys(("files", "bodies", "equal", "read without files", "refused"), 0)
    worst = 0.0
    for path in sorted(p for f in parser.parse_args().folders for p in f.rglob("*.xml")):
        answer = compiled(str(path))
        counts["files"] += 1
        counts["refused"] += "refused" in answer
        if answer.get("lacking") or "refused" in answer:
            found = answer.get("bodies", {}).values()
            counts["read without files"] += sum(body is not None for body in found)
            continue
        model = mujoco.MjModel.from_xml_path(str(path))
        for index in range(1, model.nbody):
            if name := model.body(index).name:
                found = difference(answer["bodies"][name], model, index)
                counts["bodies"] += 1
                counts["equal"] += found <= BOUND
                worst = max(worst, found)
    print(", ".join(f"{name} {count}" for name, count in counts.items()))
    print(f"largest difference {worst:.1e}, MuJoCo {mujoco.__version__}")
    return int(counts["equal"] < counts["bodies"])


if __name__ == "__main__":
    sys.exit(main())
