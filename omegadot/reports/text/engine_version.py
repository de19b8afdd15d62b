"""An engine with its version: a version of one number alone would be read as an index."""

from __future__ import annotations


def version_text(version: str) -> str:
    """4.0.0 as it is, and 1 as "version 1"."""
    return f"version {version}" if version.isdigit() else version


def with_version(name: str, version: str) -> str:
    """As mujoco 4.0.0 or mine (version 1); the name alone where there is no version."""
    return " ".join(
        filter(None, (name, f"({version_text(version)})" if version.isdigit() else version))
    )
