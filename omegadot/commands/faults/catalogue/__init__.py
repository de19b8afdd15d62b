"""The faults, a file a kind; `every` has all of them."""
