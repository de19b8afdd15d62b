"""Numbers by which an attitude is stepped as a part of one vector, one kind a file."""
