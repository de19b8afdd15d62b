"""The harness's end: processes, their pipes, and a pool of them."""
