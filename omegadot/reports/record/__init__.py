"""A run's record: its schema, how it is read and how it is written."""
