"""The harness's end: processes and their pipes."""
