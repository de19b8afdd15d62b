"""Bodies out of other people's files: a link of a URDF, MJCF or SDF, or a TOML file's body."""

from omegadot.scenarios.links.body_file import NamedBody, body_of_argument

__all__ = ["NamedBody", "body_of_argument"]
