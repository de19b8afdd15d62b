"""Bodies out of other people's files: a link of a URDF, MJCF or SDF, or a TOML file's body."""
