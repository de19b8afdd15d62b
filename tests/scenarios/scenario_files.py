"""Scenario files to bend: one sound file, and ways to write others from it."""

from __future__ import annotations

from pathlib import Path

SOUND = """\
schema = 1
name = "a-body"
title = "A body"

[body]
mass = 1.0
inertia = [1.0, 2.0, 2.5]

[initial]
angular_velocity = [0.1, 2.0, 0.1]

[run]
duration = 1.0
timesteps = [0.02, 0.01]
sample = 0.02
"""

PARTS = SOUND.replace("mass = 1.0\ninertia = [1.0, 2.0, 2.5]\n", "").replace(
    "[body]\n", "{parts}\n"
)


def with_line(old: str, new: str) -> str:
    """The sound file with one of its lines replaced."""
    assert f"{old}\n" in SOUND
    return SOUND.replace(f"{old}\n", f"{new}\n")


def with_parts(*parts: str) -> str:
    """The sound file with its body put together from parts."""
    return PARTS.replace("{parts}", "\n".join(f"[[body.part]]\n{part}" for part in parts))


def write(folder: Path, text: str | bytes, name: str = "case.toml") -> Path:
    """A file of this content."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path
