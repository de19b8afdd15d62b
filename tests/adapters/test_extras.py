"""Which optional engines are there, found without importing them."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from omegadot.adapters.registry import is_absent


def test_an_extra_is_looked_for_without_importing_it() -> None:
    """MJX stands in MuJoCo's folder, whose import would take its time in every command."""
    code = (
        "import sys; from omegadot.adapters.registry import EXTRAS, is_absent; "
        "absent = [is_absent(name) for name in EXTRAS]; "
        "engines = {'mujoco', 'jax', 'jaxsim', 'pydrake', 'exudyn', 'Basilisk', 'opensim'}; "
        "engines |= {'pybullet', 'sapien', 'idyntree', 'rapier3d', 'biorbd'}; "
        "sys.exit(bool(engines & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("lacking", ["jax", "mujoco", "mujoco.mjx"])
def test_mjx_is_absent_without_any_of_its_modules(
    lacking: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in {"jax", "mujoco", "mujoco.mjx"} - {lacking}:
        (tmp_path / module.replace(".", "/")).mkdir(parents=True, exist_ok=True)
    if lacking == "mujoco":
        shutil.rmtree(tmp_path / "mujoco")
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    monkeypatch.setattr(sys, "path_importer_cache", {})
    for module in ("jax", "mujoco"):
        for loaded in [name for name in sys.modules if name.partition(".")[0] == module]:
            monkeypatch.delitem(sys.modules, loaded)
    assert [is_absent(name) for name in ("mjx", "mjx-float32")] == [True, True]
    (tmp_path / lacking.replace(".", "/")).mkdir(parents=True)
    (tmp_path / "mujoco/mjx").mkdir(parents=True, exist_ok=True)
    importlib.invalidate_caches()
    assert [is_absent(name) for name in ("mjx", "mjx-float32")] == [False, False]
