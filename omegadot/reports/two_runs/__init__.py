"""Two records compared: what got better, worse, appeared and vanished."""
