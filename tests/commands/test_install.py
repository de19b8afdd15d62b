"""Engines that npm installs: what is said where they are missing, and how they come into the cache.

npm is a script of this test's own: nothing is fetched.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from command_line import omegadot, quick_scenario

import omegadot as api
from omegadot.adapters.node import adapter
from omegadot.adapters.node.packages import ENGINES, FOLDER, MANIFEST, cache, missing, pinned
from omegadot.adapters.registry import NODE, build_adapter, is_absent
from omegadot.commands.engines.engines import entry_of
from omegadot.commands.engines.install import install
from omegadot.harness.arguments import engine_choices
from omegadot.harness.plan import EngineChoice

pytestmark = pytest.mark.skipif(os.name == "nt", reason="programs are shell scripts here")
# What stands in for npm: it leaves one package, or fails as npm does.
MAKES = """\
mkdir -p node_modules/cannon-es
cp package.json node_modules/cannon-es
echo "$@" > line"""
FAILS = """\
mkdir node_modules
echo 'npm error code E404' >&2
echo 'npm error no such package' >&2
exit 1"""


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache, and programs of this test's own: node, and no npm."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    program(tmp_path, "node", "exit 1")
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}{os.pathsep}/usr/bin{os.pathsep}/bin")
    return tmp_path


def program(folder: Path, name: str, text: str) -> None:
    file = folder / "bin" / name
    file.parent.mkdir(exist_ok=True)
    file.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    file.chmod(0o755)


def test_every_engine_is_pinned_and_has_its_places() -> None:
    manifest = json.loads(MANIFEST.read_text(encoding="utf-8"))
    assert set(manifest["dependencies"]) == set(ENGINES.values())
    assert all(version.replace(".", "").isdigit() for version in manifest["dependencies"].values())
    assert "//" not in MANIFEST.read_text(encoding="utf-8")  # no address of a registry
    for name, target in NODE.items():
        assert (FOLDER / f"{name}.js").is_file()
        assert callable(getattr(adapter, target.rpartition(":")[2]))


def test_a_missing_engine_is_one_sentence_with_what_installs_it(place: Path) -> None:
    how = "is not installed; install it with omegadot engines --install node"
    for name in ENGINES:
        assert missing(name) == f"{name} {pinned(name)} {how}"
        assert is_absent(name)
        with pytest.raises(ImportError, match=f"^{missing(name)}$"):
            build_adapter(NODE[name])
    assert not {choice.name for choice in engine_choices([])} & set(ENGINES)
    entry = entry_of(EngineChoice("cannon-es", NODE["cannon-es"]))
    assert (entry.installed, entry.reason) == (False, missing("cannon-es"))


def test_a_run_shows_it_as_not_installed(place: Path) -> None:
    quick_scenario(place)
    done = omegadot("run", "quick.toml", "--engine", "cannon-es", "--out", "out", folder=place)
    assert done.code == 3
    assert f"cannon-es: not-installed, 1 run on quick: {missing('cannon-es')}" in done.out


def test_another_release_is_not_taken_for_the_one_that_was_tried(place: Path) -> None:
    folder = cache() / "node_modules" / "cannon-es"
    folder.mkdir(parents=True)
    for text, said in (('{"version": "0.6.2"}', ", 0.6.2 is;"), ("{", ";"), ("[]", ";")):
        (folder / "package.json").write_text(text, encoding="utf-8")
        assert missing("cannon-es").startswith(
            f"cannon-es {pinned('cannon-es')} is not installed{said}"
        )
    (folder / "package.json").write_text(json.dumps({"version": pinned("cannon-es")}))
    assert missing("cannon-es") == ""


def test_without_node_that_is_what_is_said(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(place))
    assert "there is no program node; install Node 18 or later" in missing("cannon-es")
    with pytest.raises(api.UsageError, match="needs the programs node and npm"):
        install("node")


def test_npm_fills_the_cache_and_a_failure_leaves_it_as_it_was(place: Path) -> None:
    program(place, "npm", MAKES)
    assert install("node") == cache()
    assert (cache() / "node_modules" / "cannon-es").is_dir()
    line = (cache() / "line").read_text(encoding="utf-8")
    assert "--ignore-scripts" in line
    (cache() / "mark").touch()
    program(place, "npm", FAILS)
    with pytest.raises(api.UsageError, match="exit code 1: code E404; no such package"):
        install("node")
    assert (cache() / "mark").exists()
    program(place, "npm", MAKES)
    install("node")
    assert not (cache() / "mark").exists()
    assert [folder.name for folder in cache().parent.iterdir()] == ["node"]


def test_what_cannot_be_written_or_is_unknown_is_one_sentence(place: Path) -> None:
    program(place, "npm", MAKES)
    (place / "cache").write_text("a file")
    done = omegadot("engines", "--install", "node", folder=place)
    assert (done.code, done.out) == (2, "")
    assert "set XDG_CACHE_HOME to a folder that can be written." in " ".join(done.err.split())
    with pytest.raises(api.UsageError, match=r"there is no such group; write node\."):
        install("python")


def test_a_relative_cache_counts_as_none(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "here")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert cache() == tmp_path / ".cache" / "omegadot" / "node"
