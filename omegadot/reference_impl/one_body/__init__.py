"""One rigid body as a motion that schemes step."""
