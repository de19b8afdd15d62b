"""What failing cases have in common, and numbers that differ, as text."""
