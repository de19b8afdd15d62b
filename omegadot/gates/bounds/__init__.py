"""How far a sound engine may be off: sizes of terms, round-off, and its growth along a motion."""
