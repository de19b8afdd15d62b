"""The gates: what they judge (`case`, `truth`), how (`bounds`, `errors`), and one file a gate."""
